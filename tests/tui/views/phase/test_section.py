"""The phase portrait of a method's own map, as a picture and in the view."""

import math

import numpy as np
import pytest

from engine.methods import USUAL_CAST, VELOCITY_VERLET
from engine.models.model import State
from engine.phase_space.section import iterate, orbit, pieces
from engine.scenes import SCENES, Scene
from tests.tui import drawn
from tests.tui.harness import Theatre, lab, until
from tui.drawing.palette import FRAME, faint
from tui.views.phase.picture import Section, starts
from tui.views.phase.view import SectionPane
from tui.views.phase.viewport import Viewport

SCENE = Scene(theta=1.25, h=0.348011)  # at the 1:6 resonance of velocity Verlet
MODEL, H, START = SCENE.equations, SCENE.h, State(SCENE.theta, SCENE.omega)
VIEWPORT = Viewport.portrait(70, 24, SCENE)
MINE, OTHERS = 2, faint(2)


def cells(picture, ink: int) -> set[tuple[int, int]]:
    return {
        (column, row)
        for (row, column), (_, colour) in drawn.cells(picture).items()
        if colour == ink
    }


def test_the_starts_are_all_over_the_viewport():
    theta, omega = starts(VIEWPORT, 200)
    x, y = VIEWPORT.x(theta), VIEWPORT.y(omega)
    assert ((x >= 0) & (x <= 140) & (y >= 0) & (y <= 96)).all()
    counts, _, _ = np.histogram2d(x, y, bins=4, range=[(0, 140), (0, 96)])
    assert counts.min() >= 9  # of 12.5


def test_an_orbit_is_drawn_where_its_points_are_with_the_angle_within_a_turn():
    section = Section(VIEWPORT, MODEL, VELOCITY_VERLET, MINE)
    points = iterate(VELOCITY_VERLET, MODEL, H, (np.array([0.0]), np.array([7.0])), 500)
    assert np.ptp(points[0]) > 2 * math.pi
    section.add(points)
    found = cells(
        section.picture(orbit(VELOCITY_VERLET, MODEL, H, (0.0, 0.0), 1), (0.0, 0.0)), OTHERS
    )
    theta = np.remainder(points[0] + math.pi, math.tau) - math.pi
    x, y = VIEWPORT.x(theta[:, 0]), VIEWPORT.y(points[1][:, 0])
    inside = (y >= 0) & (y < 96)
    expected = {
        (int(i) // 2, int(j) // 4)
        for i, j in zip(x[inside], y[inside], strict=True)
        if 0 <= i < 140
    }
    assert expected - found <= {
        (c, r) for c, r in expected if r >= 23 or c < 3 or abs(c - 35) < 4
    }  # words, the start
    assert len(found) > 40
    assert found <= expected


def test_an_orbit_that_leaves_no_gap_to_those_before_is_not_drawn():
    section = Section(VIEWPORT, MODEL, VELOCITY_VERLET, MINE)
    rest = orbit(VELOCITY_VERLET, MODEL, H, (0.0, 0.0), 1)
    for theta, is_drawn in ((1.6, True), (1.61, False), (2.0, True), (0.3, True)):
        before = cells(section.picture(rest, (0.0, 0.0)), OTHERS)
        section.add(iterate(VELOCITY_VERLET, MODEL, 0.05, (np.array([theta]), np.zeros(1)), 500))
        assert (cells(section.picture(rest, (0.0, 0.0)), OTHERS) != before) == is_drawn


def test_the_starts_orbit_stands_out_and_the_separatrix_lies_underneath():
    section = Section(VIEWPORT, MODEL, VELOCITY_VERLET, MINE)
    for piece in pieces(VELOCITY_VERLET, MODEL, H, starts(VIEWPORT, 100), 1000):
        section.add(piece)
    picture = section.picture(orbit(VELOCITY_VERLET, MODEL, H, START, 1000), START)
    mine = cells(picture, MINE)
    assert {column > 35 for column, _ in mine} == {True, False}
    assert (
        int(VIEWPORT.x(0.0)) // 2,
        int(VIEWPORT.y(0.0)) // 4,
    ) not in mine  # islands go around the middle
    assert len(cells(picture, FRAME)) > 20
    flat = Section(VIEWPORT, SCENES["linear"].equations, VELOCITY_VERLET, MINE)
    assert not cells(flat.picture(orbit(VELOCITY_VERLET, MODEL, H, START, 10), START), FRAME)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("method", USUAL_CAST, ids=lambda method: method.key)
@pytest.mark.parametrize("size", [(1, 1), (3, 2), (60, 5), (200, 60)])
def test_it_fits_every_size_and_method(method, size):
    viewport = Viewport.portrait(*size, SCENE)
    section = Section(viewport, MODEL, method, MINE)
    section.add(iterate(method, MODEL, 50.0, starts(viewport, 20), 300))
    picture = section.picture(orbit(method, MODEL, 50.0, START, 300), START, State(0.5, 0.5))
    assert drawn.size(picture) == size


async def section_of(theatre: Theatre, *keys: str) -> SectionPane:
    """The pane with a section that is complete, after these keys."""
    await theatre.press("f3")
    await theatre.pilot.press(*keys)
    await theatre.run(0.2)
    pane = theatre.stage.query_one(SectionPane)
    await until(theatre.pilot, lambda: pane.shows_section and pane.settled)
    return pane


@pytest.mark.parametrize("size", [(60, 16), (120, 40)])
async def test_x_shows_the_own_map_of_velocity_verlet_and_the_portrait_again(size):
    async with lab(SCENE, size=size) as theatre:
        await theatre.press("f3")
        await theatre.run(0.2)
        portrait = theatre.stage.query_one(SectionPane).border_title
        pane = await section_of(theatre, "x")
        assert pane.border_title == "Own map of Velocity Verlet: h 0.348011 s, z 1.09"
        assert (
            pane.text.splitlines()[-1] == "start: A chain of islands: 1 turn in every 6 steps, 1:6."
        )
        await theatre.pilot.press("x")
        assert pane.border_title == portrait
        assert "E/Es" in pane.text


@pytest.mark.other_process
async def test_the_section_is_the_engines():
    async with lab(SCENE, size=(100, 30)) as theatre:
        pane = await section_of(theatre, "x")
        section = Section(pane.viewport, MODEL, VELOCITY_VERLET, MINE)
        for piece in pieces(VELOCITY_VERLET, MODEL, H, starts(pane.viewport, 300), 2000):
            section.add(piece)
        expected = section.picture(
            orbit(VELOCITY_VERLET, MODEL, H, START, 2000), START
        ).text.splitlines()
        assert [line.rstrip() for line in pane.text.splitlines()[:-1]] == expected


async def test_another_step_redraws_it_and_tab_takes_the_next_method():
    async with lab(SCENE, size=(100, 30)) as theatre:
        pane = await section_of(theatre, "x")
        before = pane.text
        pane = await section_of(theatre, "plus")
        assert "h 0.5 s" in str(pane.border_title)
        assert pane.text != before
        pane = await section_of(theatre, "tab")
        assert str(pane.border_title).startswith("Own map of RK4: h 0.5 s")
        assert not theatre.stage.query_one("#facts").is_on_screen


async def test_a_lab_that_is_paused_redraws_it_for_another_step_and_another_start():
    async with lab(SCENE, size=(100, 30)) as theatre:
        pane = await section_of(theatre, "x", "space")
        for keys, title in ((("plus",), "h 0.5 s"), (("u",), "h 0.348011 s")):
            await theatre.pilot.press(*keys)
            assert title in str(pane.border_title)
        await until(theatre.pilot, lambda: pane.settled)
        before = pane.text
        await theatre.pilot.press("i", "2", "enter")
        await until(theatre.pilot, lambda: pane.text != before)


async def test_words_follow_the_crosshair_and_the_pointer():
    async with lab(Scene(theta=0.5, h=0.1), size=(100, 30)) as theatre:
        pane = await section_of(theatre, "o", "x", "up")
        assert pane.cursor is not None
        assert pane.text.splitlines()[-1].startswith(
            f"{pane.cursor.theta:g}, {pane.cursor.omega:g}: Regular: "
        )
        await theatre.pilot.press("escape")
        await theatre.pilot.hover(pane, offset=(50, 2))
        assert "over the top" in pane.text.splitlines()[-1]
        expected = pane.viewport.at_cell(49, 1)
        await theatre.pilot.press("right", "left", "enter")
        assert theatre.source.scene.theta == pytest.approx(
            expected.theta, abs=pane.viewport.theta_per_dot
        )
