"""The theoretical portrait: where its curves lie, what is named, what the axes say."""

import math

import pytest

from pendu_tui.engine.scenes import SCENES, Scene
from pendu_tui.tui.drawing.picture import FRAME, QUIET
from pendu_tui.tui.views.portrait import Portrait
from pendu_tui.tui.views.viewport import Viewport
from tests.tui.drawn import inks

DRIFT = SCENES["drift"]
MODEL = DRIFT.equations


@pytest.mark.parametrize("span", [math.tau, 0.1, 1e-6])
def test_the_separatrix_is_where_libration_and_rotation_meet_at_every_zoom(span):
    viewport = Viewport.portrait(47, 17, DRIFT)._replace(theta=math.pi)
    viewport = viewport.zoomed(span / viewport.theta_span, 47, 34)
    portrait = Portrait.of(viewport, MODEL)
    assert inks(portrait.ground.picture()) <= {FRAME, QUIET}
    drawn = {*zip(*portrait.separatrix, strict=True)}
    assert drawn
    for x, y in drawn:
        assert not {(x + 1, y), (x, y + 1), (x + 1, y + 1)} <= drawn  # one dot thick
        around = [(x + i + 0.5, y + j + 0.5) for i in (-1, 0, 1) for j in (-1, 0, 1)]
        values = [MODEL.level(viewport.theta_at(i), viewport.omega_at(j)) for i, j in around]
        assert min(values) <= 0 <= max(values)


@pytest.mark.parametrize(
    ("theta", "omega"), [(1.0, 0.0), (0.3, -2.0), (3.1, 0.0), (0.0, 8.0), (2.0, -9.0), (3.1, 0.5)]
)
def test_the_orbit_through_a_state_is_where_the_exact_swing_goes(theta, omega):
    scene = Scene(theta=theta, omega=omega)
    viewport = Viewport.portrait(80, 30, scene)
    x, y = Portrait.of(viewport, scene.equations).orbit(theta, omega)
    orbit = set(zip(x.tolist(), y.tolist(), strict=True))
    exact = scene.exact()
    passed = set()
    for k in range(2000):
        state = exact.at(k * exact.period / 2000)
        i, j = math.floor(viewport.x(state.theta)), math.floor(viewport.y(state.omega))
        near = {(i + a, j + b) for a in (-1, 0, 1) for b in (-1, 0, 1)} & orbit
        # the outermost dots have no neighbour to differ from
        assert near or not (1 <= i < viewport.columns * 2 - 1 and 1 <= j < viewport.rows * 4 - 1)
        passed |= near
    assert passed == orbit  # and nowhere else
