"""Where the screen is saved."""

import pytest

from recordings import library
from tests.tui.conftest import text_of
from tests.tui.harness import lab


async def test_s_saves_a_picture_among_the_recordings(tmp_path, monkeypatch):
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path / "new"))
    async with lab(size=(80, 24)) as theatre:
        await theatre.press("s")
    (picture,) = (tmp_path / "new").iterdir()
    assert "t 0.00 s" in text_of(picture.read_text(encoding="utf-8"))
    assert library.listing(tmp_path / "new") == []  # a picture is no recording


@pytest.mark.skipif("not hasattr(__import__('os'), 'geteuid')")
async def test_a_screenshot_that_cannot_be_saved_is_reported(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path / "file" / "below"))
    async with lab(size=(80, 24)) as theatre:
        await theatre.press("s")
        (told,) = theatre.app._notifications
        assert "Screenshot failed" in told.message
