"""Where marks are kept."""

from dataclasses import replace
from pathlib import Path

from recordings.library import GOLDEN
from tui.cli.options import resolve
from tui.playback.marks import Mark, Marks

MARK = Mark(1.0, 1, 20, "here")


def test_those_of_a_recording_that_came_with_the_program_are_kept_apart_from_the_library_s(
    tmp_path: Path, monkeypatch
):
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path / "library"))
    Marks(resolve("drift")).add(MARK)
    assert list(Marks(resolve("drift"))) == [MARK]
    Marks(tmp_path / "library" / "drift.mcap").add(replace(MARK, text="of another"))
    assert list(Marks(resolve("drift"))) == [MARK]
    assert not list(GOLDEN.glob("*.json"))
