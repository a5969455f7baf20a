"""What the wheel and the sdist hold, and under which names."""

import shutil
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
    if shutil.which("git") is None:
        pytest.skip("git is not installed")
    command = ["git", "ls-files", *ROOMS]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return [name for name in listed.stdout.splitlines() if (ROOT / name).exists()]


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """The folder with a wheel and an sdist of this checkout."""
    pytest.importorskip("build.env", reason="build is not installed")
    folder = tmp_path_factory.mktemp("built")
    command = [sys.executable, "-m", "build", "--no-isolation", "--outdir", folder, ROOT]
    subprocess.run(command, check=True, capture_output=True)
    return folder


def test_the_wheel_holds_each_file_of_the_three_rooms_and_nothing_else(built):
    (wheel,) = built.glob("*.whl")
    names = ZipFile(wheel).namelist()
    ours = {name for name in names if not name.startswith(f"{DIST_INFO}/")}
    assert ours == {f"pendu_tui/{name}" for name in tracked()}
    kinds = {Path(name).suffix for name in ours}
    assert {".tcss", ".mcap", ".toml"} <= kinds, "styles, golden recordings, the tour"


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


def test_pendu_tui_is_a_namespace_without_a_folder_of_its_own():
    assert getattr(pendu_tui, "__file__", None) is None
