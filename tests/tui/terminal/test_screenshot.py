"""Where the screen is saved."""

import pytest

from recordings import library
from tests.tui.conftest import text_of
from tests.tui.harness import lab
from tui.screens.lines import KeyLine, StatusLine
from tui.views.lab.error_table import ErrorTable


async def test_the_text_of_a_picture_is_what_is_on_the_screen():
    async with lab(size=(80, 24)) as theatre:
        await theatre.run(12)
        await theatre.settled()
        lines = text_of(theatre.app.export_screenshot()).splitlines()
        assert len(lines) == 24
        assert lines[0] == theatre.text(StatusLine)
        assert lines[-1] == theatre.text(KeyLine)
        table = theatre.stage.query_one(ErrorTable)
        assert lines[table.region.y : table.region.bottom] == table.text.splitlines()
        assert max(map(len, lines)) == 80


async def test_s_saves_a_picture_among_the_recordings(tmp_path, monkeypatch):
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path / "new"))
    async with lab(size=(80, 24)) as theatre:
        await theatre.run(1)
        await theatre.press("s")
    (picture,) = (tmp_path / "new").iterdir()
    assert "t 1.00 s" in text_of(picture.read_text(encoding="utf-8"))
    assert library.listing(tmp_path / "new") == []  # a picture is no recording


@pytest.mark.skipif("not hasattr(__import__('os'), 'geteuid')")
async def test_a_screenshot_that_cannot_be_saved_is_reported(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path / "file" / "below"))
    async with lab(size=(80, 24)) as theatre:
        await theatre.press("s")
        (told,) = theatre.app._notifications
        assert "Screenshot failed" in told.message
