"""Phase space under mouse and keyboard, in the lab and over the whole screen; its ring and map."""

import math
import re
from contextlib import asynccontextmanager
from unittest.mock import Mock

import pytest
from textual import events

from pendu_tui.engine.methods.own import OwnMethodError
from pendu_tui.engine.models.model import State
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES, Line, Scene
from pendu_tui.engine.studies.ring import Neighbourhood
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.views.phase import PhasePane, SectionPane, area_text
from pendu_tui.tui.views.portrait import ring_text
from pendu_tui.tui.views.viewport import LEFT
from tests.tui.harness import lab, until

DRIFT = SCENES["drift"]
RESONANT = Scene(theta=1.25, h=0.348011)  # at the 1:6 resonance of velocity Verlet


@asynccontextmanager
async def phase_view(scene=DRIFT, keys="o", size=(120, 40)):
    """The view of a lab that stands still, with all angles, and its pane."""
    async with lab(scene, size) as theatre:
        await theatre.press("f3", *keys)
        await theatre.run(0.1)
        yield theatre, shown(theatre)


def shown(theatre) -> PhasePane:
    (pane,) = (pane for pane in theatre.stage.query(PhasePane) if pane.drawable)
    return pane


def plot(pane) -> list[str]:
    return pane.text.splitlines()[:-1]


def state(theatre):
    return theatre.scene.theta, theatre.scene.omega


async def test_a_click_in_the_lab_starts_all_there_with_the_step_in_force_and_u_takes_it_back():
    async with lab() as theatre:
        await theatre.run(1)
        await theatre.press("plus", "n")  # at equal cost: of the cheapest
        expected = shown(theatre).viewport.at_cell(40, 3)
        await theatre.pilot.click(shown(theatre), offset=(41 + LEFT, 4))
        assert (*state(theatre), theatre.scene.h) == (*expected, 0.1)
        assert all((r.theta, r.omega) == tuple(expected) for r in theatre.sample.readings)
        await theatre.press("u")
        assert theatre.scene == DRIFT.altered(h=0.05)
        assert theatre.stage.view == "lab"
        await theatre.click(shown(theatre), 5, 0)  # the title
        assert theatre.stage.view == "phase"


async def test_the_pointer_is_described_with_its_orbit_and_letting_go_inside_starts_there():
    async with phase_view() as (theatre, pane):
        plain = plot(pane)
        assert "exact period 2.13914 s" in pane.text
        columns, rows = pane._cells
        await theatre.pilot.hover(pane, offset=(1 + LEFT + columns // 2, 1 + rows // 2))
        assert "theta 0  omega 0  E/Es 0  libration" in pane.text
        await theatre.pilot.hover(pane, offset=(1 + LEFT + columns // 3, 1))
        assert "  rotation" in pane.text.splitlines()[-1]
        assert plot(pane) != plain
        for beside in ((LEFT, 1), (1 + LEFT, 1 + rows), (1 + LEFT + columns, 1)):
            await theatre.pilot.hover(pane, offset=beside)
            assert pane.pointer is None
        await theatre.pilot.mouse_down(pane, offset=(30, 8))
        await theatre.pilot.hover(offset=(0, 0))
        await theatre.pilot.mouse_up(offset=(0, 0))
        assert plot(pane) == plain
        assert theatre.scene == DRIFT
        expected = pane.viewport.at_cell(33 - LEFT, 6)
        x, y = pane.content_region.offset
        for kind, at in (
            (events.MouseDown, (x + 30, y + 8)),
            (events.MouseMove, (x + 33, y + 6)),
            (events.MouseUp, (x + 33, y + 6)),
        ):  # as a driver sends them: Textual makes a click of the last
            theatre.app.post_message(kind(None, *at, 0, 0, 1, False, False, False, *at))
            await theatre.pilot.pause()
        assert state(theatre) == tuple(expected)


async def test_arrows_move_a_crosshair_from_the_start_enter_chooses_it_and_esc_leaves_it():
    async with phase_view() as (theatre, pane):
        for size in ((40, 8), (120, 40)):  # too small for a moment
            await theatre.pilot.resize_terminal(*size)
            await theatre.pilot.pause()
        await until(theatre.pilot, lambda: pane.has_focus)
        viewport = pane.viewport
        plain = plot(pane)
        keys = theatre.stage.active_bindings
        assert not {"enter", "escape"} <= {*keys}
        await theatre.press("right")
        assert pane.cursor == viewport.stepped(State(1.0, 0.0), 4, 0)
        await theatre.press("escape", "enter")
        assert (plot(pane), theatre.scene) == (plain, DRIFT)
        await theatre.press("left", "up")
        expected = viewport.stepped(viewport.stepped(State(1.0, 0.0), -4, 0), 0, 4)
        assert pane.cursor == expected
        await theatre.press("z")  # around the crosshair, which is then in the middle
        near = viewport._replace(theta=expected.theta, omega=expected.omega)
        assert pane.viewport == near.zoomed(0.5, *viewport.middle)
        await theatre.press("enter")
        assert state(theatre) == expected
        assert pane.cursor is None


async def test_the_wheel_zooms_around_the_pointer():
    async with phase_view(SCENES["gentle"]) as (theatre, pane):
        before = pane.viewport
        assert before.theta_span > 6.2  # all angles, by key o
        x, y = pane.content_region.offset
        theatre.app.post_message(events.MouseScrollUp(None, x + 30, y + 2, *[0] * 6))
        await theatre.pilot.pause()
        nearer = before.zoomed(0.8, 2 * (30 - LEFT) + 1, 4 * 2 + 2)
        assert pane.viewport == nearer
        await theatre.press("right", "escape")  # leaves the crosshair alone
        assert pane.viewport == nearer
        await theatre.press("escape")
        assert pane.viewport == before


async def test_a_start_that_no_pendulum_has_is_refused_with_a_sentence():
    async with phase_view(Scene(omega=9e8)) as (theatre, pane):
        await theatre.click(pane, 20, 1)
        assert theatre.scene.omega == 9e8
        assert "out of range" in theatre.notices[0]


async def test_g_draws_a_ring_that_catches_up_in_a_paused_lab_and_takes_it_away(monkeypatch):
    async with phase_view(SCENES["large-swing"]) as (theatre, pane):
        await theatre.run(20)
        await theatre.press("space", "g")
        assert not pane.settled
        await theatre.press("f2")
        assert pane.settled  # out of sight
        await theatre.press("f3")
        await until(theatre.pilot, lambda: pane.neighbours and pane.settled)
        source = theatre.source
        expected = Neighbourhood(source.scene, pane.neighbours.radius).following(
            source.sample.step, source.changes, 1000
        )
        assert pane.ring.area_ratios == expected.area_ratios
        theatre.stage.show_now()
        table = theatre.pane("#phase ErrorTable")
        head, _, symplectic, _, rk4 = table.text.splitlines()
        assert "theta error  area/area0   theta [rad]" in head
        assert any(area in symplectic for area in (" 1 + ", " 1 - ", " 1 "))  # but for rounding
        assert f" {expected.area_ratios[3]:.9f} " in rk4  # a loss that four digits do not show
        assert str(pane.border_subtitle) == "ring, radius 0.1 rad"
        monkeypatch.setattr("pendu_tui.tui.views.phase.has_own", lambda scene: True)
        source.start(DRIFT.with_cast(DRIFT.cast[:3]))
        table.follow(source, source.sample, theatre.stage.shown)  # before the pane has a new ring
        assert "area" not in table.text
        source.start(SCENES["gentle"])
        source.step(9)
        theatre.stage.show_now()
        assert (pane.neighbours.radius, pane.neighbours.step) == (pytest.approx(0.01), 1)
        fail = Mock(side_effect=OwnMethodError("No ring."))
        monkeypatch.setattr(Neighbourhood, "following", fail)
        pane.draw()
        assert pane.ring is None
        await theatre.run(0.1)
        fail.assert_called_once()
        assert theatre.notices == ["No ring."]
        assert "area" not in table.text
        assert pane.border_subtitle == "click: start, wheel: zoom, g: ring"


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    "scene",
    [
        Scene(theta=1e6, omega=-3.0),
        Scene(h=16.0),
        Scene(theta=0.0),
        Scene(gravity=1e-6),
        Scene(omega=1e9, h=100.0),
    ],
)
async def test_no_start_is_too_much_for_it(scene):
    async with phase_view(scene, "5", (80, 24)) as (theatre, pane):
        await theatre.run(1)
        theatre.source.step(500)
        pane.action_zoom(0.01)
        theatre.stage.show_now()
        pane.action_move(3, 2)
        text = pane.text + theatre.text("#phase ErrorTable")
        assert "libration" in text or "rotation" in text
        assert not re.search("nan|inf", text)


@pytest.mark.parametrize(
    ("ratio", "text"),
    [
        (1.0, "1"),
        (1 + 2**-52, "1 + 2.2e-16"),
        (1 - 3e-7, "1 - 3.0e-07"),
        (0.99783850123, "0.997838501"),
        (3.42e12, "3.420e+12"),
        (999.5, "999.500000000"),
        (1000.5, "1.000e+03"),
        (1.1e-3, "0.001100000"),
        (0.9e-3, "9.000e-04"),
        (0.0, "< 1e-308"),
        (math.inf, "> 1e308"),
    ],
)
def test_an_area_has_digits_enough_to_tell_it_from_one(ratio, text):
    assert area_text(ratio) == text


def test_a_ring_says_how_far_it_is_behind_and_what_the_true_motion_leaves_of_it():
    drift = Live(DRIFT)
    damped = Live(SCENES["damped"])
    for live in (drift, damped):
        live.step(100)
        live.change(Stepping(0.05, cast=live.scene.cast))
        live.step(100)
    left = math.exp(-0.05 * 7.5)
    for live, steps, words in (
        (damped, 200, f": the exact motion shrinks its area to {left:.9f}"),
        (drift, 200, ""),
        (drift, 50, ", 150 steps behind"),
    ):
        ring = Neighbourhood(live.scene, 0.1)
        ring.following(live.sample.step, live.changes, steps)
        assert ring_text(live, ring) == f"ring, radius 0.1 rad{words}"
    stiff = Live(SCENES["stiff-slow"])
    assert ring_text(stiff, None) == stiff.scene.why_no_ring != ""


@pytest.fixture(autouse=True)
def _few_starts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pendu_tui.tui.views.phase.STARTS", 30)


async def section_of(theatre, *keys: str) -> SectionPane:
    """The pane with a section that is complete, after these keys."""
    await theatre.press("f3", *keys)
    await theatre.run(0.2)
    pane = theatre.pane(SectionPane)
    await until(theatre.pilot, lambda: pane.shown.section and pane.settled)
    pane.draw()
    return pane


@pytest.mark.parametrize("size", [(60, 16), (120, 40)])
async def test_x_shows_the_own_map_of_velocity_verlet_and_the_portrait_again(size):
    async with lab(RESONANT, size=size) as theatre:
        pane = await section_of(theatre, "x")
        assert pane.border_title == "Map of Velocity Verlet: h 0.348011 s, z 1.09"
        words = "start: A chain of islands: 1 turn in every 6 steps, 1:6."
        assert pane.text.splitlines()[-1] == words
        assert pane._section.result._near.any(axis=1).all()  # other orbits, too
        await theatre.pilot.hover(pane, offset=(LEFT + 2, 2))
        words = pane.text.splitlines()[-1]
        assert words.startswith("{:g}, {:g}: ".format(*pane.pointer))
        assert "islands" not in words
        pane._section.result.orbits = 15
        pane.draw()
        assert str(pane.border_title).endswith(", computing 50%")
        for _ in range(4):
            pane.action_method(1)
        assert [each.is_cancelled for each in pane.workers].count(False) == 1  # the last
        await theatre.press("n", "b")
        pane.draw()
        own = -theatre.source.stepping.own[2]
        assert own < -theatre.source.stepping.h
        assert f"h {own:g} s" in str(pane.border_title)
        await theatre.stage.start(SCENES["stiff-slow"])
        await theatre.pilot.pause()
        assert " ".join(pane.text.split()) == SCENES["stiff-slow"].why_not_mapped
        await theatre.press("x")
        assert str(pane.border_title).startswith("Phase space")
        await theatre.press("u", "u", "x")
        assert "E/Es" in pane.text
        half = pane.viewport.up[1]
        for quantity, size in (("omega", 3), ("theta_error", 1)):
            pane.shown = pane.shown._replace(line=Line(quantity, -2 * half, "fence"))
            assert pane.viewport.up[1] == pytest.approx(size * half, rel=0.2)


async def test_a_key_that_comes_at_once_after_that_of_a_view_reaches_its_pane():
    async with lab(RESONANT) as theatre:
        for key in ("f3", "x"):
            theatre.app.post_message(events.Key(key, None))
        await until(theatre.pilot, lambda: theatre.stage.shown.section)
