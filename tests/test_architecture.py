"""Rules of the architecture, each executable."""

import ast
import pkgutil
import shutil
import subprocess
import sys
from ast import literal_eval
from importlib import import_module
from pathlib import Path

import pytest

import pendu_tui.tui.commands
from pendu_tui.engine.models import MODELS
from pendu_tui.tui.cli.commands import COMMANDS

ROOT = Path(__file__).parent.parent
MODULES = [
    path for package in ("engine", "recordings", "tui") for path in (ROOT / package).rglob("*.py")
]
HEAVY = (
    "textual",
    "numpy",
    "rich.console",
    "plotext",
    "mcap",
    "numba",
    "distributed",
    "matplotlib",
)


def loaded_after(work: str, *prefixes: str) -> list[str]:
    """Return the modules with these prefixes that some code loads in a new Python."""
    code = f"{work}\nimport sys; print([*sys.modules], file=sys.__stderr__)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return [
        name for name in literal_eval(done.stderr.splitlines()[-1]) if name.startswith(prefixes)
    ]


@pytest.mark.parametrize(
    "arguments", [["--version"], ["--help"], *([name, "--help"] for name in COMMANDS)], ids=" ".join
)
def test_help_and_version_load_nothing_heavy(arguments):
    work = f"from pendu_tui.tui.cli.dispatch import main\nassert main({arguments}) == 0"
    assert loaded_after(work, *HEAVY) == []


def test_the_first_paint_of_the_lab_does_not_wait_for_numpy_and_the_recorder():
    work = "import pendu_tui.tui.commands.lab, pendu_tui.tui.views.lab"
    assert loaded_after(work, "numpy", "mcap", "plotext", "numba") == []


def test_every_command_in_the_table_has_a_function_and_every_module_is_in_the_table():
    pytest.importorskip("textual_serve", reason="the extra web is not installed")
    room = pendu_tui.tui.commands
    places = {(each.place or f"{name}:run").partition(":")[::2] for name, each in COMMANDS.items()}
    modules = {module.name for module in pkgutil.iter_modules(room.__path__) if not module.ispkg}
    assert modules - {"options", "report"} == {module for module, _ in places}
    for module, function in places:
        assert callable(getattr(import_module(f"{room.__name__}.{module}"), function))


def test_the_import_contracts_hold():
    lint = shutil.which("lint-imports", path=Path(sys.executable).parent)
    if lint is None:
        pytest.skip("import-linter is not installed")
    done = subprocess.run(
        [lint, "--no-cache"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout
    assert "0 broken" in done.stdout


@pytest.mark.slow
@pytest.mark.parametrize("system", ["win32", "darwin"])
def test_windows_and_macos_lack_no_name_that_is_used(system, tmp_path):
    types = [ROOT / ".ci" / "types", "--platform", system, "--cache-dir", tmp_path]
    done = subprocess.run(types, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout


def asks_which_system(node):
    match node:
        case ast.Attribute(ast.Name("sys"), "platform") | ast.Attribute(ast.Name("os"), "name"):
            return True
        case ast.Import([ast.alias(name)]) | ast.ImportFrom(name):
            return name in ("fcntl", "msvcrt", "pty", "resource", "termios", "tty")
    return False


def test_one_module_alone_asks_which_system_it_runs_on():
    asking = {
        str(path.relative_to(ROOT))
        for path in MODULES
        if any(map(asks_which_system, ast.walk(ast.parse(path.read_text("utf-8")))))
    }
    assert asking == {str(Path("recordings/system.py"))}


INSIDE = tuple(str(ROOT / "engine" / room) for room in ("models", "methods", "scenes"))
OUTSIDE = [path for path in MODULES if not str(path).startswith(INSIDE)]
MODEL_CLASSES = {"Model", *(model.__name__ for model in MODELS.values())}
MODEL_MODULES = {model.__module__ for model in MODELS.values()}


def asks_which_model(node):
    """Whether a syntax node compares a model's key, tests its type or imports its module."""
    match node:
        case ast.Compare(left, _, others):
            constants = [part for side in (left, *others) for part in ast.walk(side)]
            return any(getattr(constant, "value", None) in MODELS for constant in constants)
        case ast.Call(ast.Name("isinstance"), [_, kinds]):
            return any(getattr(part, "id", "") in MODEL_CLASSES for part in ast.walk(kinds))
        case ast.ImportFrom(module):
            return module in MODEL_MODULES
    return False


def test_nobody_outside_asks_which_model_it_is():
    places = [
        f"{path.relative_to(ROOT)}:{node.lineno}"
        for path in OUTSIDE
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if asks_which_model(node)
    ]
    assert not places


def test_a_folder_has_at_most_eighteen_files():
    folders = {path.parent for path in MODULES}
    counts = {folder: sum(path.is_file() for path in folder.iterdir()) for folder in folders}
    assert {folder: count for folder, count in counts.items() if count > 18} == {}
