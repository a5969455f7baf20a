"""What is installed, and under which names."""

import shutil
import subprocess
import sys
from pathlib import Path
from zipfile import ZipFile

import pytest

ROOT = Path(__file__).parent.parent


@pytest.mark.slow
def test_a_wheel_of_the_sdist_holds_each_file_of_the_three_rooms_and_the_licence(tmp_path):
    if shutil.which("git") is None:
        pytest.skip("git is not installed")
    rooms = ("engine", "recordings", "tui")
    listed = subprocess.run(["git", "ls-files", *rooms], cwd=ROOT, capture_output=True, check=True)
    tracked = [name for name in listed.stdout.decode().splitlines() if (ROOT / name).exists()]
    assert {Path(name).suffix for name in tracked} >= {".tcss", ".mcap", ".toml"}

    command = [sys.executable, "-m", "build", "--no-isolation", "--outdir", tmp_path, ROOT]
    subprocess.run(command, check=True, capture_output=True)
    (file,) = tmp_path.glob("*.whl")
    wheel = ZipFile(file)
    ours = {name for name in wheel.namelist() if ".dist-info/" not in name}
    assert ours == {f"pendu_tui/{name}" for name in tracked}
    (metadata,) = (name for name in wheel.namelist() if name.endswith("/METADATA"))
    assert "License-Expression: MIT" in wheel.read(metadata).decode()
    licence = metadata.replace("METADATA", "licenses/.github/LICENSE.txt")
    assert b"WITHOUT WARRANTY" in wheel.read(licence)
