from tests.tui.harness import lab


async def test_s_saves_a_picture_among_the_recordings_or_reports_why_not(tmp_path, monkeypatch):
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path / "new"))
    async with lab(size=(80, 24)) as theatre:
        await theatre.press("s")
        (picture,) = (tmp_path / "new").iterdir()
        assert ">scene</text>" in picture.read_text(encoding="utf-8")
        monkeypatch.setenv("PENDU_RECORDINGS", str(picture / "below"))
        await theatre.press("s")
        assert "Screenshot not saved" in theatre.notices[-1]
