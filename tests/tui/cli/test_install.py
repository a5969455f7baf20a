import sys

import pytest

from pendu_tui.tui.cli.install import install_advice


@pytest.mark.parametrize(
    ("marker", "command"),
    [
        ("uv-receipt.toml", "uv tool install --with numba pendu-tui"),
        ("pipx_metadata.json", "pipx inject pendu-tui numba"),
        ("pyvenv.cfg", "pip install 'pendu-tui[fast]'"),
    ],
)
def test_the_advice_is_for_the_tool_that_installed_the_program(
    marker, command, tmp_path, monkeypatch
):
    (tmp_path / marker).touch()
    monkeypatch.setattr(sys, "prefix", str(tmp_path))
    assert install_advice("numba", "fast") == command
