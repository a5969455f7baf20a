"""The lab's lines, as pictures made of text."""

import pytest

from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import DEFAULT_SCENE, SCENES
from pendu_tui.recordings.recording import Recording
from pendu_tui.tui.drawing.picture import TEXT
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.replay import Replay
from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.playback.source import Playhead, RecordingStatus, Source
from pendu_tui.tui.screens.lines import bar, facts, status_row, text_rows, without_folder
from tests.tui.harness import after, eventful


def text(row) -> str:
    return "".join(words for words, _ in row).rstrip()


def status(source: Source, width: int) -> str:
    return text(status_row(source, Shown(), width))


class Taped(Live):
    """A lab with a recording that is only said to be there."""

    recording_status = RecordingStatus("2026-11-20T10-14-03.mcap", 72.4)


def taped(**changes) -> Taped:
    live = Taped(DEFAULT_SCENE, clock=lambda: 0.0)
    for name, value in changes.items():
        setattr(live, name, value)
    return live


def test_the_status_line_leaves_out_the_least_important_parts_and_never_runs_over():
    live = taped()
    assert status(live, 120) == (
        " LIVE  running  1×  t 0.00 s  h 0.05 s  z 0.157  scene drift  57.3° 0 rad/s  REC 72 s"
        "  2026-11-20T10-14-03.mcap"
    )
    assert "  z 0.157  scene drift  REC 72 s" in status(live, 80)
    words = ("LIVE", "running", "1×", "t 0.00 s", "h 0.05 s", "z 0.157")
    for width in range(60, 125):
        line = status(live, width)
        assert len(line) <= width
        assert all(word in line for word in words)
    live.change(Stepping(-0.2, equal_cost=True))
    live.set_speed(0.25)
    live.history.sample = live.sample._replace(t=725.0)
    assert status(live, 80) == (
        " LIVE  backwards  1/4×  t 12 min 05 s  h -0.2 s equal cost  z 0.626  REC 72 s"
    )
    live = taped()
    live.start(DEFAULT_SCENE.altered(theta=3.0))
    assert "171.9° 0 rad/s" in status(live, 80)
    assert "custom" not in status(live, 80)


@pytest.mark.parametrize(
    ("changes", "words", "is_shown"),
    [
        ({"pace": 0.62}, "only 62 % of 1×", True),
        ({"pace": 0.011, "playhead": Playhead(speed=2.0**18)}, "only 1.1 % of 262144×", True),
        ({"pace": 0.995}, "only", False),
        ({"pace": 0.009}, "only", False),
        ({"recording_status": Taped.recording_status._replace(failed="full.")}, "NOT REC", True),
        ({"recording_status": None, "playhead": Playhead(seen=0.0)}, "not recorded", True),
        ({"recording_status": None}, "record", False),  # before the first frame
    ],
)
def test_the_status_line_shows_a_low_pace_and_a_failed_recording(changes, words, is_shown):
    assert (words in status(taped(**changes), 100)) == is_shown


def test_where_steps_are_slow_the_status_line_says_when_the_next_one_is_due():
    live = after(SCENES["verlet-limit"], 2.5)
    assert live.next_step == pytest.approx(2 * 1.98 - 2.5)
    assert "next step in 2 s" in status(live, 120)
    live.playhead.position = 3.95
    assert "next step in 1 s" in status(live, 120)
    live.pause(True)
    assert "next step" not in status(live, 120)
    assert "next step" not in status(after(DEFAULT_SCENE, 1.0), 120)


def test_the_bar_shows_what_was_played_and_what_was_done():
    assert text(bar(5.0, 10.0, [0.0, 2.5, 7.5], 20)) == "┿━━━━┿━━━━█────┼────"
    assert text(bar(10.0, 10.0, [], 10)) == "━━━━━━━━━█"
    assert text(bar(0.0, 0.0, [], 4)) == "█───"


def test_the_bar_shows_position_length_run_step_and_event(tmp_path):
    path = eventful(tmp_path / "eventful.mcap")
    replay = Replay(Recording.open(path), clock=lambda: 0.0)
    replay.seek(6.0)
    here = " 6.00 s of 12.00 s"
    assert facts(replay, 80) == f"{here}  run 2/3  step  50/200"
    replay.looping = True
    assert facts(replay, 40) == f"{here}  loop  run 2/3"
    assert facts(replay, 0) == here
    replay.seek(12.0)
    assert len(facts(replay, 40)) == len(f"{here}  loop  run 2/3")  # the bar stays where it is
    replay.close()


def test_no_line_of_a_sentence_ends_within_a_name_or_after_an_answers_number():
    cast = DEFAULT_SCENE.cast

    def lines(words: str, height: int | None = None) -> list[str]:
        return [text(row) for row in text_rows(words, TEXT, cast, 17, height)]

    wrapped = [" Watch", " Explicit Euler.", " 1: It gains.", " 2: It"]
    assert lines("Watch Explicit Euler. 1: It gains. 2: It") == wrapped
    assert lines("RK4 loses what Verlet keeps", 1) == [" RK4 loses …"]


def test_why_something_failed_is_told_without_a_folder():
    for folder in ("", "/home/me/a b/", "C:\\Users\\me\\", "own/"):
        for told in ("e.py, line 7: `a / b` raises Error: x.", "run.mcap.part: 1 of 2/3 is full."):
            assert without_folder(folder + told) == told
    assert without_folder(told := "omega = 1e10 rad/s is too fast.") == told
