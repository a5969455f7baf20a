"""From cells and dots to phase space and back, and how far the pendulums in a picture swing."""

import math

import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from pendu_tui.engine.models.model import State
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES, Scene
from pendu_tui.tui.views.viewport import Viewport, amplitude, reach
from tests.tui.harness import Lab

DRIFT = SCENES["drift"]
sizes = st.tuples(st.integers(2, 200), st.integers(2, 60))


@given(sizes, st.floats(-3, 3), st.floats(-20, 20), st.floats(1e-7, 1), st.data())
def test_every_cell_leads_to_what_is_drawn_in_its_middle(size, theta, omega, factor, data):
    viewport = Viewport.portrait(*size, DRIFT)._replace(theta=theta, wrap=data.draw(st.booleans()))
    if not viewport.wrap:
        viewport = viewport._replace(omega=omega).zoomed(factor, size[0], 2 * size[1])
    column, row = data.draw(st.integers(0, size[0] - 1)), data.draw(st.integers(0, size[1] - 1))
    theta, omega = viewport.at_cell(column, row)
    assert abs(theta) <= math.pi or not viewport.wrap
    # half a dot of rounding; at the deepest zoom a dot is 1e-9 of the angle: ten thousand doubles
    assert viewport.x(theta) == pytest.approx(2 * column + 1, abs=0.5 + 1e-4)
    assert viewport.y(omega) == pytest.approx(4 * row + 2, abs=0.5 + 1e-4)


@pytest.mark.parametrize("edge", [0, -1])
def test_both_edges_of_a_portrait_lead_to_what_is_drawn_there(edge):
    for columns in range(2, 201):
        viewport = Viewport.portrait(columns, 2, DRIFT)
        column = edge % columns
        theta, _ = viewport.at_cell(column, 0)
        assert viewport.x(theta) == pytest.approx(2 * column + 1, abs=0.5 + 1e-4)  # as above


@given(sizes, st.floats(-math.pi, math.pi))
@example((3, 2), math.pi)
def test_every_angle_of_a_turn_is_on_the_portrait_and_every_turn_shows_the_same(size, theta):
    viewport = Viewport.portrait(*size, DRIFT)
    assert 0 <= viewport.x(theta) < 2 * size[0]
    assume(abs(theta) < math.pi - 1e-6)  # there, rounding decides between the two edges
    # a turn of 6.28 rad, taken off again, leaves a few roundings of 1e-15
    assert viewport.x(theta + 3 * math.tau) == pytest.approx(viewport.x(theta), abs=1e-9)


@pytest.mark.parametrize("scene", [DRIFT, SCENES["spin"], Scene(omega=50.0)])
def test_all_three_regimes_fit_whatever_the_start(scene):
    viewport = Viewport.portrait(40, 12, scene)
    assert 0 <= viewport.y(2 * scene.w0) < viewport.y(0.0) < viewport.y(-2 * scene.w0) < 48
    assert 0 <= viewport.y(scene.omega) < 48


@given(st.floats(0.01, 100), st.floats(0, 80), st.floats(0, 48))
def test_zoom_keeps_what_is_under_the_pointer(factor, x, y):
    before = Viewport.portrait(40, 12, DRIFT)
    after = before.zoomed(factor, x, y)
    # some roundings at the size of the numbers
    assert after.theta_at(x) == pytest.approx(before.theta_at(x), abs=1e-11)
    assert after.omega_at(y) == pytest.approx(before.omega_at(y), abs=1e-11)
    assert before.zoomed(1e-9, x, y).theta_span == pytest.approx(1e-3)
    assert before.zoomed(1e9, x, y).theta_span == pytest.approx(200 * math.pi)
    assert before.stepped(State(0.0, before.omega_at(60.0)), 0.0, 0.0) == (0.0, 0.0)
    assert before._replace(wrap=False).stepped(State(9.0, 0.0), 0.0, 0.0) == (0.0, 0.0)
    near = [before.at(before.middle[0] + dots, 0.0).theta for dots in (0.45, 0.55)]
    assert [theta == 0 for theta in near] == [True, False]
    lowest = before.stepped(State(0.0, before.omega_at(47.0)), 0.0, -9.0)
    assert before.y(lowest.omega) == pytest.approx(47, abs=0.5)
    rightmost = before.stepped(State(before.theta_at(79.0), 0.0), 9.0, 0.0)
    assert before.x(rightmost.theta) == pytest.approx(79, abs=0.5)


@pytest.mark.parametrize(
    ("name", "low", "high"), [("drift", 1.0, 1.25), ("gentle", 0.1, 0.125), ("large-swing", 2.5, 3)]
)
def test_the_swing_decides_and_explicit_euler_leaves_it_until_it_needs_the_whole_circle(
    name, low, high
):
    scene = SCENES[name]
    lab = Lab(scene)
    widest = []
    for _ in range(20):
        sample = lab.run(1)
        found = reach(scene, lab.live.stepping, sample, range(4))
        assert low <= found.frame <= high
        assert max(abs(reading.theta) for reading in sample.readings[1:]) <= found.frame
        widest.append(found.widest)
    assert widest == sorted(widest)  # so the picture never jumps back
    for start in ((scene.theta, 0.0), (0.0, 2 * scene.w0 * math.sin(scene.theta / 2))):
        assert amplitude(scene.equations, *start) == pytest.approx(scene.theta, abs=1e-9)
    assert low <= widest[0] <= widest[-1] == math.pi
    lab = Lab(nearly := scene.altered(theta=2.7))
    assert reach(nearly, lab.live.stepping, lab.live.sample, range(4)).frame == math.pi


def test_the_frame_leaves_out_a_method_beyond_its_limit():
    lab = Lab(SCENES["gentle"])
    lab.live.change(Stepping(-0.7))  # z = 2.2
    lab.run(20)
    found = reach(SCENES["gentle"], lab.live.stepping, lab.live.sample, (2,))
    assert found.frame < 0.12 < found.widest
    lab.live.start(SCENES["gentle"])
    lab.live.change(Stepping(2.4, equal_cost=True))  # its own z is 1.9
    lab.run(20)
    found = reach(SCENES["gentle"], lab.live.stepping, lab.live.sample, (2,))
    assert 0.12 < found.frame == found.widest
