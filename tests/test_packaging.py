"""What the wheel and the sdist hold, and under which names."""

import ast
import subprocess
import sys
import tarfile
import tomllib
from pathlib import Path
from zipfile import ZipFile

import pytest

import pendu_tui

ROOT = Path(__file__).parent.parent
PYPROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
PROJECT = PYPROJECT["project"]
ROOMS = ("engine", "recordings", "tui")
DIST_INFO = f"pendu_tui-{PROJECT['version']}.dist-info"


def tracked() -> list[str]:
    command = ["git", "ls-files", *ROOMS]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return [name for name in listed.stdout.splitlines() if (ROOT / name).exists()]


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """The folder with a wheel and an sdist of this checkout."""
    folder = tmp_path_factory.mktemp("built")
    command = [sys.executable, "-m", "build", "--no-isolation", "--outdir", folder, ROOT]
    subprocess.run(command, check=True, capture_output=True)
    return folder


def test_every_folder_with_code_is_in_the_list_of_packages():
    folders = {str(Path(name).parent) for name in tracked() if name.endswith("/__init__.py")}
    assert set(PYPROJECT["tool"]["setuptools"]["packages"]) == {
        f"pendu_tui.{folder.replace('/', '.')}" for folder in folders
    }


def test_the_wheel_holds_each_file_of_the_three_rooms_and_nothing_else(built):
    (wheel,) = built.glob("*.whl")
    names = ZipFile(wheel).namelist()
    ours = {name for name in names if not name.startswith(f"{DIST_INFO}/")}
    assert ours == {f"pendu_tui/{name}" for name in tracked()}
    kinds = {Path(name).suffix for name in ours}
    assert {".tcss", ".mcap", ".json"} <= kinds, "styles, golden recordings and the Foxglove layout"


def test_a_wheel_of_the_sdist_would_hold_the_same_files(built):
    (sdist,) = built.glob("*.tar.gz")
    with tarfile.open(sdist) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    assert {*tracked(), "pyproject.toml", "README.md"} <= names


def test_the_licence_is_in_the_metadata_and_its_text_in_the_wheel(built):
    (wheel,) = built.glob("*.whl")
    archive = ZipFile(wheel)
    assert "License-Expression: MIT" in archive.read(f"{DIST_INFO}/METADATA").decode()
    assert b"WITHOUT WARRANTY" in archive.read(f"{DIST_INFO}/licenses/.github/LICENSE.txt")


def test_users_get_ranges_and_the_snapshots_get_exact_versions():
    assert not [requirement for requirement in PROJECT["dependencies"] if "==" in requirement]
    exact = {r.split("==")[0] for r in PROJECT["optional-dependencies"]["test"] if "==" in r}
    assert exact == {"textual", "rich", "plotext"}


def test_the_rooms_are_imported_by_their_installed_names_alone():
    """`import engine` in the checkout would load a second copy with registries of its own."""
    tests = [path.relative_to(ROOT) for path in (ROOT / "tests").rglob("*.py")]
    for name in (*tracked(), *map(str, tests)):
        if not name.endswith(".py"):
            continue
        for node in ast.walk(ast.parse((ROOT / name).read_text(encoding="utf-8"))):
            modules = [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            modules += [each.name for each in node.names] if isinstance(node, ast.Import) else []
            assert not {module.split(".")[0] for module in modules} & set(ROOMS), name


def test_pendu_tui_is_a_namespace_without_a_folder_of_its_own():
    assert getattr(pendu_tui, "__file__", None) is None
