"""The lab's lines, as pictures made of text."""

import math
from itertools import product
from types import SimpleNamespace

import pytest

from pendu_tui.engine.methods import USUAL_CAST
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import DEFAULT_SCENE, SCENES
from pendu_tui.recordings.recording import Recording
from pendu_tui.tui.drawing.picture import TEXT, WARN, Picture
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.replay import Replay
from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.playback.source import Playhead, RecordingStatus
from pendu_tui.tui.screens.lines import (
    BADGE,
    InsightLine,
    facts,
    limit_warning,
    status_row,
    text_rows,
    without_folder,
)
from tests.tui.drawn import look
from tests.tui.harness import eventful, lab


def text(row) -> str:
    return "".join(words for words, _ in row).rstrip()


class Taped(Live):
    """A lab with a recording that is only said to be there."""

    recording_status = RecordingStatus("2026-11-20T10-14-03.mcap", 72.4)


def taped(**changes) -> Taped:
    live = Taped(DEFAULT_SCENE, clock=lambda: 0.0)
    for name, value in changes.items():
        setattr(live, name, value)
    return live


def near_limit(h: float) -> Taped:
    live = taped()
    live.start(SCENES["verlet-limit"].altered(h=h))
    return live


def test_a_method_is_stable_at_its_limit_itself():
    verlet = USUAL_CAST[2]
    assert limit_warning({verlet: 2.0}) == ""
    assert limit_warning({verlet: math.nextafter(2.0, 3.0)}) == "unstable: v (z > 2)"


TAPE = Taped.recording_status
LIVES = [
    *(taped(pace=pace) for pace in (0.009, 0.011, 0.62, 0.98, 0.995)),
    taped(pace=0.5, playhead=Playhead(speed=2.0**18)),
    *(taped(recording_status=TAPE._replace(seconds=each)) for each in (59.9, 7300.0)),
    taped(recording_status=TAPE._replace(failed="full.")),
    taped(recording_status=None),  # before the first frame
    taped(recording_status=None, playhead=Playhead(seen=0.0)),
    taped(playhead=Playhead(paused=True)),
    taped(failure="mine fails."),
    *map(near_limit, (1.99, 2.01, 2.82, 2.84)),
    taped(kind="REPLAY"),
]


def test_the_status_line_leaves_out_the_least_important_parts_and_never_runs_over(snapshot):
    pictures = []
    turned = taped()
    turned.change(Stepping(-2.6, equal_cost=True))
    turned.set_speed(0.25)
    for live, width in product([*LIVES, turned], (60, 80, 100, 160)):
        row = status_row(live, Shown(), width)
        assert len(text(row)) <= width
        pictures.append(
            look(Picture([[(each, TEXT if ink == BADGE else ink) for each, ink in row]]))
        )
    row = status_row(taped(), Shown(held=1.0), 100)
    pictures.append(f"{text(row)}\n{text(status_row(taped(), Shown(), 100, True))}\n")
    snapshot("status.txt", "".join(pictures))


def test_the_bar_shows_position_length_run_step_and_event(tmp_path):
    path = eventful(tmp_path / "eventful.mcap")
    replay = Replay(Recording.open(path), clock=lambda: 0.0)
    replay.seek(6.0)
    here = " 6.00 s of 12.00 s"
    assert facts(replay, 80) == f"{here}  run 2/3  step  50/200"
    full = facts(replay, 80)
    assert [facts(replay, len(full) - less) == full for less in (0, 1)] == [True, False]
    replay.looping = True
    assert facts(replay, 40) == f"{here}  loop  run 2/3"
    assert facts(replay, 0) == here
    replay.seek(12.0)
    assert len(facts(replay, 40)) == len(f"{here}  loop  run 2/3")  # the bar stays where it is
    replay.close()
    for length, told in ((3.0, " 3.00 s of 3.00 s"), (4000.0, "    3.00 s of 1 h 07 min")):
        played = SimpleNamespace(playhead=Playhead(3.0), length=length, counts={}, looping=False)
        assert facts(played, 0) == told


def test_no_line_of_a_sentence_ends_within_a_name_or_after_an_answers_number():
    cast = DEFAULT_SCENE.cast

    def lines(words: str, height: int | None = None) -> list[str]:
        return [text(row) for row in text_rows(words, TEXT, cast, 16, height)]

    wrapped = [" Watch", " Explicit Euler.", " 1: It gains.", " 2: It"]
    assert lines("Watch Explicit Euler. 1: It gains. 2: It") == wrapped
    assert lines("RK4 loses what Verlet keeps", 1) == [" RK4 loses …"]


def test_what_to_watch_fits_a_line_of_a_terminal_of_80_columns():
    for scene in SCENES.values():
        (row,) = text_rows(scene.watch, TEXT, scene.cast, 80)
        assert text(row) == f" {scene.watch}"


def test_why_something_failed_is_told_without_a_folder():
    for folder in ("", "/home/me/a b/", "C:\\Users\\me\\", "own/"):
        for told in ("e.py, line 7: `a / b` raises Error: x.", "run.mcap.part: 1 of 2/3 is full."):
            assert without_folder(folder + told) == told
    assert without_folder(told := "omega = 1e10 rad/s is too fast.") == told


@pytest.mark.parametrize("size", [(60, 16), (120, 40)])
async def test_the_insight_line_tells_a_failure_before_all_else_and_has_one_row_or_two(
    size, monkeypatch
):
    failed = TAPE._replace(failed="/tmp/run.mcap.part: full.")
    monkeypatch.setattr(Live, "recording_status", failed)
    async with lab(size=size) as theatre:
        line = theatre.pane(InsightLine)
        for failure, told in (
            (None, "Not recording: run.mcap.part: full."),
            (f"own/e.py: {40 * 'no '}", "e.py: no no"),
        ):
            theatre.source.failure = failure
            await theatre.run(0)
            rows = line._picture.rows
            assert len(rows) == line.size.height
            assert text(rows[-1]).startswith(f" {told}")
            assert rows[-1][-1][1] == WARN
