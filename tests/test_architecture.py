"""Rules of the architecture, each executable."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

from pendu_tui.engine.models import MODELS
from pendu_tui.tui.cli.commands import COMMANDS

ROOT = Path(__file__).parent.parent
MODULES = [path for room in ("engine", "recordings", "tui") for path in (ROOT / room).rglob("*.py")]

ALL_HELP = f"""
from pendu_tui.tui.cli.dispatch import main
for command in {["", *COMMANDS]}:
    assert main([*command.split(), "--help"]) == main(["--version"]) == 0
"""
FIRST_PAINT = "import pendu_tui.tui.commands.lab, pendu_tui.tui.views.lab"
FEW_STEPS = """
import pendu_tui.engine.studies.accuracy
from pendu_tui.engine.run.loops import TieredLoops, available
from pendu_tui.engine.scenes import DEFAULT_SCENE as scene
available()
TieredLoops(scene.cast[0], scene.equations).propagate((1.0, 0.0), 0.05, 10_000)
"""


@pytest.mark.parametrize(
    ("work", "later"),
    [
        (ALL_HELP, "textual numpy rich.console plotext mcap numba distributed matplotlib"),
        (FIRST_PAINT, "numpy plotext mcap numba"),
        (FEW_STEPS, "numba"),
        ("import pendu_tui.engine", "pendu_tui.engine. numpy"),
        ("import pendu_tui.recordings", "pendu_tui.recordings. pendu_tui.engine mcap"),
    ],
)
def test_what_takes_long_to_load_is_loaded_when_it_is_needed(work, later):
    code = f"{work}\nimport sys; print(*sys.modules, file=sys.stderr)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True)
    loaded = done.stderr.decode().split()
    assert [name for name in loaded if name.startswith(tuple(later.split()))] == []


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


MODEL_CLASSES = {"Model", *(model.__name__ for model in MODELS.values())}
MODEL_MODULES = {model.__module__ for model in MODELS.values()}


def asks_which_model(node):
    match node:
        case ast.Compare(left, _, others):
            constants = [part for side in (left, *others) for part in ast.walk(side)]
            return any(getattr(constant, "value", None) in MODELS for constant in constants)
        case ast.Call(ast.Name("isinstance"), [_, kinds]):
            return any(getattr(part, "id", "") in MODEL_CLASSES for part in ast.walk(kinds))
        case ast.ImportFrom(module):
            return module in MODEL_MODULES
    return False


@pytest.mark.parametrize(
    ("asks", "allowed"),
    [
        (asks_which_system, ["recordings/system.py"]),
        (asks_which_model, ["engine/models/", "engine/methods/", "engine/scenes/"]),
    ],
)
def test_few_ask_which_system_or_which_model_it_is(asks, allowed):
    places = [
        f"{path.relative_to(ROOT).as_posix()}:{node.lineno}"
        for path in MODULES
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if asks(node)
    ]
    assert places
    assert [place for place in places if not place.startswith(tuple(allowed))] == []
