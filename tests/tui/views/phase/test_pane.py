"""Phase space under mouse and keyboard."""

import math
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import pytest
from textual import events
from textual.app import App, ComposeResult
from textual.pilot import Pilot

from engine.phase_space.area import Neighbours
from engine.scenes import SCENES, Scene
from tui.playback.live import Live
from tui.playback.shown import Shown
from tui.views.phase.pane import DOTS, PhasePane
from tui.views.phase.viewport import MIN_SPAN
from tui.views.view import SceneChosen

DRIFT = SCENES["drift"]


class Recording(Live):
    """A source that is no longer to be changed."""

    kind = "REPLAY"  # type: ignore[assignment]


class PhaseApp(App[None]):
    """A pane, and what it asked for."""

    CSS = "PhasePane { border: round; }"

    def __init__(self, live: Live, columns: int, rows: int) -> None:
        super().__init__()
        self.live = live
        self.pane = PhasePane()
        self.pane.styles.width = columns + 2
        self.pane.styles.height = rows + 3
        self.chosen: list[tuple[float, float]] = []

    def compose(self) -> ComposeResult:
        yield self.pane

    def on_mount(self) -> None:
        pane = self.query_one(PhasePane)
        pane.source, pane.sample = self.live, self.live.sample
        pane.focus()

    def on_scene_chosen(self, choice: SceneChosen) -> None:
        self.chosen.append((choice.scene.theta, choice.scene.omega))


@asynccontextmanager
async def shown(
    live: Live | None = None, columns: int = 46, rows: int = 16
) -> AsyncIterator[tuple[Pilot, PhasePane]]:
    """The pane with so many cells of plot, and a row of text below; its border comes on top."""
    app = PhaseApp(live or Live(DRIFT), columns, rows)
    async with app.run_test(size=(max(columns + 2, 60), max(rows + 3, 16))) as pilot:
        await pilot.pause()
        pane = app.query_one(PhasePane)
        pane.shown = Shown(overview=True)
        yield pilot, pane


def at(column: int, row: int) -> tuple[int, int]:
    """The offset of a cell of the plot in the pane: its border comes first."""
    return column + 1, row + 1


async def mouse(
    pilot: Pilot, pane: PhasePane, kind: type[events.MouseEvent], cell: tuple[int, int], **how
) -> None:
    """What a terminal sends, for which Pilot has no method."""
    x, y = at(*cell)
    what = {"button": 1, "shift": False, "meta": False, "ctrl": False} | how
    pane.post_message(kind(pane, x, y, 0, 0, screen_x=x, screen_y=y, **what))
    await pilot.pause()


async def test_a_click_on_any_cell_chooses_the_state_in_its_middle():
    async with shown(columns=6, rows=4) as (pilot, pane):
        viewport = pane.viewport
        for column in range(6):
            for row in range(4):
                pilot.app.chosen.clear()
                await pilot.click(pane, offset=at(column, row))
                ((theta, omega),) = pilot.app.chosen
                # half a dot, and 1e-9 for the rounding of doubles
                assert viewport.x(theta) == pytest.approx(2 * column + 1, abs=0.5 + 1e-9)
                assert viewport.y(omega) == pytest.approx(4 * row + 2, abs=0.5 + 1e-9)


async def test_the_line_below_says_what_is_under_the_pointer():
    async with shown() as (pilot, pane):
        assert pane.text.splitlines()[-1].startswith("exact period 2.13914 s")
        await pilot.hover(pane, offset=at(23, 8))
        assert pane.text.splitlines()[-1] == "theta 0  omega 0  E/Es 0  libration"
        await pilot.hover(pane, offset=at(23, 0))
        assert pane.text.splitlines()[-1].endswith("rotation")


async def test_a_drag_shows_the_orbit_through_the_pointer_before_release_chooses_it():
    async with shown() as (pilot, pane):
        plain = pane.text
        await pilot.mouse_down(pane, offset=at(30, 8))
        await pilot.hover(pane, offset=at(33, 6))
        shown_orbit = pane.text
        assert shown_orbit.splitlines()[:-1] != plain.splitlines()[:-1]
        assert not pilot.app.chosen
        await pilot.mouse_up(pane, offset=at(33, 6))
        assert pilot.app.chosen == [tuple(pane.viewport.at_cell(33, 6))]
        assert pane.text.splitlines()[:-1] == plain.splitlines()[:-1]  # the orbit is gone


async def test_esc_cancels_a_drag():
    async with shown() as (pilot, pane):
        await pilot.mouse_down(pane, offset=at(30, 8))
        await pilot.press("escape")
        await pilot.mouse_up(pane, offset=at(30, 8))
        assert not pilot.app.chosen


async def test_a_drag_that_ends_outside_chooses_nothing():
    async with shown() as (pilot, pane):
        await pilot.mouse_down(pane, offset=at(30, 8))
        await pilot.hover(offset=(0, 0))
        await pilot.mouse_up(offset=(0, 0))
        assert not pilot.app.chosen
        assert not pane.aiming


async def test_arrows_move_a_crosshair_from_the_start_and_enter_chooses_it():
    async with shown() as (pilot, pane):
        viewport = pane.viewport
        await pilot.press("right")
        # a round number within half a dot of the dot beside the start's
        assert viewport.x(pane.cursor.theta) == pytest.approx(viewport.x(1.0) + DOTS, abs=0.5)
        await pilot.press("left", "left", "up")
        assert viewport.x(pane.cursor.theta) == pytest.approx(viewport.x(1.0) - DOTS, abs=1.0)
        assert viewport.y(pane.cursor.omega) == pytest.approx(viewport.y(0.0) - DOTS, abs=0.5)
        expected = tuple(pane.cursor)
        await pilot.press("enter")
        assert pilot.app.chosen == [expected]
        assert pane.cursor is None


async def test_esc_leaves_the_crosshair():
    async with shown() as (pilot, pane):
        plain = pane.text
        await pilot.press("up", "up")
        assert pane.text != plain
        await pilot.press("escape", "enter")
        assert pane.text == plain
        assert not pilot.app.chosen


async def test_the_wheel_zooms_around_the_pointer():
    async with shown() as (pilot, pane):
        cell = (30, 5)
        before = pane.viewport.at_cell(*cell)
        span = pane.viewport.theta_span
        await mouse(pilot, pane, events.MouseScrollUp, cell, button=0)
        assert pane.viewport.theta_span < span
        after = pane.viewport.at_cell(*cell)
        assert after.theta == pytest.approx(before.theta, abs=pane.viewport.theta_per_dot)
        assert after.omega == pytest.approx(before.omega, abs=pane.viewport.omega_per_dot)
        await pilot.press("escape")
        assert pane.viewport.theta_span == pytest.approx(span)


async def test_z_zooms_in_to_a_thousandth_of_a_radian_at_the_unstable_point():
    async with shown(Live(Scene(theta=3.141592653589793))) as (pilot, pane):
        await pilot.press("up", "down", "z")
        for _ in range(30):
            pane.action_zoom(0.5)
        assert pane.viewport.theta_span == pytest.approx(MIN_SPAN)
        assert abs(abs(pane.cursor.theta) - math.pi) < 1e-15  # no dot away from it, at any zoom
        assert all(word in pane.text for word in ("separatrix", "rotation", "3.1414", "3.1418"))
        for _ in range(30):
            pane.action_zoom(2.0)
        assert pane.viewport.theta_span > 6


async def test_a_start_that_no_pendulum_has_is_refused_with_a_sentence():
    async with shown(Live(Scene(omega=9e8))) as (pilot, pane):
        await pilot.click(pane, offset=at(20, 0))
        assert not pilot.app.chosen
        assert "out of range" in str(next(iter(pilot.app._notifications)).message)


async def test_a_ring_has_the_radius_one_chooses_or_is_not_there():
    live = Live(DRIFT)
    async with shown(live) as (pilot, pane):
        assert pane.ring is None
        await pilot.press(*"g" * 6)
        live.step(20)
        pane.follow(live.sample)
        await pilot.pause()
        assert pane.radius == 0.05
        expected = Neighbours(0.05).follow(DRIFT, 1, 20, live.changes, 20)
        assert pane.ring.area_ratios == expected.area_ratios
        await pilot.press("g")
        assert pane.ring is None


async def test_a_recording_cannot_be_started_elsewhere_but_can_be_looked_at():
    async with shown(Recording(DRIFT)) as (pilot, pane):
        await pilot.click(pane, offset=at(20, 5))
        await pilot.press("right", "enter")
        assert pane.cursor is None
        assert not pilot.app.chosen
        span = pane.viewport.theta_span
        await pilot.press("z")
        assert pane.viewport.theta_span < span


async def test_it_fits_every_size():
    for columns, rows in ((1, 1), (3, 2), (8, 3), (200, 60)):
        async with shown(columns=columns, rows=rows) as (pilot, pane):
            await pilot.press("g", "right")
            lines = pane.text.splitlines()
            assert len(lines) <= rows + 1
            assert all(len(line) <= columns for line in lines)
