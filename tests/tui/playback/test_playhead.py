import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tui.playback.playhead import SPEED_LIMITS, Pace, Playhead, doubled

FRAMES = st.lists(st.floats(0, 5), min_size=1, max_size=50)  # s between looks at the clock


@given(FRAMES, st.floats(0.01, 100))
def test_the_position_depends_on_the_time_that_passed_and_not_on_how_often_one_looked(
    frames, speed
):
    playhead, now = Playhead(speed=speed).at(10.0), 10.0
    for elapsed in frames:
        now += elapsed
        playhead = playhead.at(now)
    # 50 additions and the clock's own rounding, each half a unit in the last place of at most 260 s
    assert playhead.position == pytest.approx((now - 10.0) * speed, abs=260 * speed * 100 * 2**-53)


@given(FRAMES)
def test_while_paused_nothing_moves_and_going_on_does_not_catch_up(frames):
    playhead, now = Playhead(paused=True).at(0.0), 0.0
    for elapsed in frames:
        now += elapsed
        playhead = playhead.at(now)
    assert playhead.position == 0.0
    assert playhead.at(now).position == 0.0


def test_the_first_look_at_the_clock_moves_nothing():
    assert Playhead().at(123.0).position == 0.0


def test_a_clock_that_jumps_back_moves_nothing():
    assert Playhead().at(5.0).at(3.0).position == 0.0
    assert Playhead().at(5.0).at(3.0).at(4.0).position == 1.0


def test_a_pace_is_the_share_of_what_was_due_that_was_done():
    pace = Pace()
    for _ in range(300):
        pace = pace.after(1 / 30, due=1 / 30, done=1 / 60)
    assert pace.share == pytest.approx(0.5)
    assert Pace().share == 1.0


def test_a_pace_forgets_within_seconds():
    pace = Pace(due=1.0, done=0.0)
    for _ in range(5 * 30):
        pace = pace.after(1 / 30, due=1 / 30, done=1 / 30)
    assert pace.share == pytest.approx(
        1.0, abs=math.exp(-5)
    )  # the bad second, five time constants old


@given(st.integers(-40, 40))
def test_speeds_stay_within_their_limits_and_double_exactly_within_them(times):
    low, high = SPEED_LIMITS
    assert doubled(1.0, times) == -doubled(-1.0, times) == min(max(2.0**times, low), high)
