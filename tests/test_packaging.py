"""The contents of the wheel."""

import tomllib
from pathlib import Path
from zipfile import ZipFile

import pytest
from hatchling.builders.wheel import WheelBuilder

ROOT = Path(__file__).parent.parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
PACKAGES = ("engine", "recordings", "tui")
DIST_INFO = f"pendu_tui-{PROJECT['version']}.dist-info"


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    folder = str(tmp_path_factory.mktemp("wheel"))
    (path,) = WheelBuilder(str(ROOT)).build(directory=folder, versions=["standard"])
    return ZipFile(path)


def test_the_wheel_holds_the_three_packages_and_nothing_else(wheel):
    tops = {name.split("/")[0] for name in wheel.namelist()}
    assert tops == {*PACKAGES, DIST_INFO}


def test_everything_that_lies_beside_the_code_is_in_the_wheel(wheel):
    files = [p for package in PACKAGES for p in (ROOT / package).rglob("*") if p.is_file()]
    beside = {str(p.relative_to(ROOT)) for p in files if p.suffix not in {".pyc", ".py"}}
    assert beside <= set(wheel.namelist())
    kinds = {Path(name).suffix for name in beside}
    assert {".tcss", ".mcap", ".json"} <= kinds, "styles, golden recordings and the Foxglove layout"


def test_the_licence_is_in_the_metadata_and_its_text_in_the_wheel(wheel):
    metadata = wheel.read(f"{DIST_INFO}/METADATA").decode()
    assert "License-Expression: MIT" in metadata
    assert "License-File: .github/LICENSE.txt" in metadata
    assert b"WITHOUT WARRANTY" in wheel.read(f"{DIST_INFO}/licenses/.github/LICENSE.txt")


def test_users_get_ranges_and_the_snapshots_get_exact_versions():
    assert not [requirement for requirement in PROJECT["dependencies"] if "==" in requirement]
    exact = {r.split("==")[0] for r in PROJECT["optional-dependencies"]["test"] if "==" in r}
    assert exact == {"textual", "rich", "plotext"}
