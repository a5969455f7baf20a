"""Where marks are kept."""

from pathlib import Path

from recordings.library import GOLDEN, resolve
from tui.playback.marks import Mark, Marks

MARK = Mark(1.0, 1, 20, "here")


def test_those_of_a_recording_that_came_with_the_program_are_kept_in_the_library(
    tmp_path: Path, monkeypatch
):
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path / "library"))
    Marks(resolve("drift")).add(MARK)
    assert list(Marks(resolve("drift"))) == [MARK]
    assert [path.name for path in (tmp_path / "library").iterdir()] == ["drift.mcap.marks.json"]
    assert not list(GOLDEN.glob("*.json"))
