"""The lab's lines, as pictures made of text."""

import pytest

from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import DEFAULT_SCENE, SCENES
from pendu_tui.recordings.recording import Recording
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.replay import Replay
from pendu_tui.tui.playback.source import Playhead, RecordingStatus
from pendu_tui.tui.screens.lines import bar, facts, status_row, wrapped
from tests.tui.harness import after, eventful


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


def test_the_status_line_leaves_out_the_least_important_parts_and_never_runs_over():
    live = taped()
    assert text(status_row(live, 120)) == (
        " LIVE   running  1×  t 0.00 s  h 0.05 s  z 0.157  scene drift  57.3° 0 rad/s  REC 72 s"
        "  2026-11-20T10-14-03.mcap"
    )
    words = ("LIVE", "running", "1×", "t 0.00 s", "h 0.05 s", "z 0.157")
    for width in range(60, 125):
        line = text(status_row(live, width))
        assert len(line) <= width
        assert all(word in line for word in words)


def test_at_80_columns_it_says_which_run_it_is_at_which_step_and_whether_that_is_recorded():
    live = taped()
    assert "  z 0.157  scene drift  REC 72 s" in text(status_row(live, 80))
    live.change(Stepping(-0.2, equal_cost=True))
    live.set_speed(0.25)
    live.playhead.position = 0.0
    live.history.sample = live.sample._replace(t=725.0)
    assert text(status_row(live, 80)) == (
        " LIVE   backwards  1/4×  t 12 min 05 s  h -0.2 s equal cost  z 0.626  REC 72 s"
    )
    live = taped()
    live.start(DEFAULT_SCENE.altered(theta=3.0))
    assert "171.9° 0 rad/s" in text(status_row(live, 80))
    assert "custom" not in text(status_row(live, 80))


@pytest.mark.parametrize(
    ("changes", "words", "shown"),
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
def test_the_status_line_shows_a_low_pace_and_a_failed_recording(changes, words, shown):
    assert (words in text(status_row(taped(**changes), 100))) == shown


def test_the_limit_of_each_method_is_compared_with_its_own_step():
    live = taped()
    live.change(Stepping(1.0, equal_cost=True))
    assert "unstable: e, r (z > 2.83)" in text(status_row(live, 120))
    live.change(Stepping(1.0))
    assert "unstable: e, s v (z > 2), r (z > 2.83)" in text(status_row(live, 120))


def test_where_steps_are_slow_the_status_line_says_when_the_next_one_is_due():
    live = after(SCENES["verlet-limit"], 2.5)
    assert live.next_step == pytest.approx(2 * 1.98 - 2.5)
    assert "next step in 1 s" in text(status_row(live, 120))
    live.pause(True)
    assert "next step" not in text(status_row(live, 120))
    assert "next step" not in text(status_row(after(DEFAULT_SCENE, 1.0), 120))


def test_the_bar_shows_what_was_played_and_what_was_done():
    assert text(bar(5.0, 10.0, [0.0, 2.5, 7.5], 20)) == "┿━━━━┿━━━━█────┼────"
    assert text(bar(10.0, 10.0, [], 10)) == "━━━━━━━━━█"
    assert text(bar(0.0, 0.0, [], 4)) == "█───"


def test_the_bar_shows_position_length_run_step_and_event(tmp_path):
    path = eventful(tmp_path / "eventful.mcap")
    replay = Replay(Recording.open(path), clock=lambda: 0.0)
    replay.seek(6.0)
    here = " 6.00 s of 12.00 s"
    assert facts(replay, 80) == f"{here}  run 2/3  step  50/200  event 4/{len(replay.ticks)}"
    replay.looping = True
    assert facts(replay, 80) == f"{here}  loop  run 2/3  step  50/200  event 4/{len(replay.ticks)}"
    assert facts(replay, 40) == f"{here}  loop  run 2/3"
    assert facts(replay, 0) == here
    assert " t 1.00 s  " in text(status_row(replay, 80))
    replay.looping, widths = False, set()
    for clock in range(13):
        replay.seek(float(clock))
        widths.add(len(facts(replay, 30)))
    assert len(widths) == 1  # so that the bar stays where it is
    replay.close()


def test_no_line_of_a_sentence_ends_within_a_name_or_after_an_answers_number():
    cast = DEFAULT_SCENE.cast
    assert wrapped("Watch Explicit Euler. 1: It gains. 2: It", 15, cast) == [
        *("Watch", "Explicit Euler.", "1: It gains.", "2: It")
    ]
    assert wrapped("RK4 loses what Verlet keeps", 15, cast, 1) == ["RK4 loses …"]
