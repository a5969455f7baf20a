"""F4: speed against accuracy for the pendulum on screen."""

from dataclasses import replace
from functools import partial

import pytest
from textual.geometry import Size

from pendu_tui.engine.methods import GENERAL, USUAL_CAST
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES
from pendu_tui.engine.studies.accuracy import Point, Study, front, ladder, measured
from pendu_tui.tui.views.accuracy import (
    ERROR_LABELS,
    AccuracyPane,
    accuracy_chart,
    accuracy_series,
)
from pendu_tui.tui.words.studies import COSTS, front_words
from tests.tui.drawn import look
from tests.tui.harness import until, view_of

RUNGS = ladder(5.0, 0.2, 0.01, 4)
VERLET = 2


@pytest.fixture(autouse=True)
def _few_points(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pendu_tui.tui.views.accuracy.usual", lambda scene, all: (5.0, RUNGS))


def words(pane: AccuracyPane) -> str:
    """All that is below the chart, on one line."""
    return " ".join(pane.text.split(f" {COSTS['evaluations']}\n", 1)[1].split())


def is_complete(pane: AccuracyPane) -> bool:
    return pane.settled and all(pane.present(place) for place in range(len(USUAL_CAST)))


async def complete(pilot, pane: AccuracyPane) -> None:
    await until(pilot, lambda: is_complete(pane))
    pane.draw()


accuracy_view = partial(view_of, "f4", AccuracyPane, is_complete)


@pytest.mark.other_process
async def test_the_points_fill_in_are_the_engines_and_the_cheapest_is_named():
    async with accuracy_view() as (_, pane, _live):
        for point in measured(SCENES["drift"], 5.0, RUNGS):
            assert pane.points[point.method.key, point.steps].errors == point.errors
        assert pane.border_title == "Accuracy (F4) over 5 s: energy error"
        assert pane.border_subtitle == "@ current h  x no correct digit  ~ limited by rounding"
        points = [point for (_, steps), point in pane.points.items() if steps in RUNGS]
        cheapest = front(points, "energy", "evaluations")
        assert {one.method.key for one in cheapest} == {"velocity_verlet", "rk4"}
        assert words(pane).endswith(front_words(cheapest, "evaluations"))


def test_charts_of_points_with_flaws_and_marks_and_a_line_for_each_order(snapshot):
    euler, symplectic, verlet, _ = USUAL_CAST

    def point(method, steps, error, flaw=None):
        errors = dict.fromkeys(ERROR_LABELS, error)
        flaws = dict.fromkeys(ERROR_LABELS, flaw)
        seconds = {verlet: steps / 1e5}.get(method)
        return Point(method, 5.0, 3.0, steps, errors, flaws, steps, seconds)

    points = [
        *(point(euler, 40, 3.0, "lost"), point(euler, 100, 0.5), point(euler, 1000, 0.05)),
        *(point(symplectic, 1600 // by, 0.01 * by) for by in (1, 2, 8)),
        *(point(verlet, 100 * by, 1e-3 / by**2.2) for by in (1, 3, 9, 30)),
        *(point(verlet, 9000, 1e-6, "rounding"), point(verlet, 20_000, 0.0)),
    ]
    texts = []
    for kind, cost in zip(ERROR_LABELS, ("evaluations", "seconds", "evaluations"), strict=True):
        marks = [("@", points[1]), ("O", points[2]), ("@", points[6])]
        series = accuracy_series(points, kind, cost, USUAL_CAST[1:], marks=marks)
        texts.append(look(accuracy_chart(series, kind, cost, 76, 16).picture))
    snapshot("accuracy.txt", "\n".join(texts))


async def test_another_h_moves_the_mark_enter_uses_the_cursors_and_a_start_has_its_own_points():
    async with accuracy_view() as (pilot, pane, live):
        before = dict(pane.points)
        await pilot.press("plus", "b")
        await complete(pilot, pane)
        assert pane.here == [50] * 4  # backwards, too
        assert before.items() <= pane.points.items()
        await pilot.press("u", "u", "n")
        await complete(pilot, pane)
        assert pane.here == [100, 100, 100, 25]  # at equal cost each method has its own
        await pilot.press("left", "left")
        await complete(pilot, pane)
        assert "O" in pane.text
        await pilot.press("enter")
        await until(pilot, lambda: live.stepping.h == pytest.approx(4 * 5.0 / RUNGS[0]))
        assert (live.sample.run, pane.cursor) == (1, None)  # the run goes on
        await until(pilot, lambda: pane.settled)
        for steps in (1, 2_000_001):  # too few or too many to compute
            live.change(Stepping(5.0 / steps, cast=USUAL_CAST))
            pane.draw()
            assert pane.settled
            assert words(pane).startswith("the current h is not on this chart")
        await pilot.press("left")
        live.change(Stepping(0.07, cast=USUAL_CAST))
        pane.draw()
        live.start(SCENES["large-swing"].altered(h=5.0 / RUNGS[1]))
        await until(pilot, lambda: pane.sample.run == live.sample.run)  # the next frame
        await complete(pilot, pane)
        assert {steps for _, steps in pane.points} == {*RUNGS}  # nothing of the scene before
        assert pane.cursor is None
        expected = Study(SCENES["large-swing"], 5.0).run(USUAL_CAST[VERLET], RUNGS[0])
        shown = pane.points["velocity_verlet", RUNGS[0]]
        assert shown.errors == expected.errors


async def test_the_pointer_reads_a_point_out_and_a_click_uses_its_h():
    async with accuracy_view() as (pilot, pane, live):
        point = pane.points["rk4", RUNGS[2]]
        column, row = pane._chart.result.cell(point.force_evaluations, point.errors["energy"])
        assert pane.text.splitlines()[row][column] == "r"
        at = (column + 1, row + 1)  # the frame
        await pilot.press("right")  # the pointer goes before the cursor
        await pilot.hover(pane, (at[0] + 3, at[1]))
        assert words(pane).startswith(f"RK4 at h {point.h:.4g} s: energy error")
        assert "(z 0.0851, 73.8 steps per small-amplitude period)" in words(pane)
        exact = replace(pane.points["rk4", RUNGS[1]], errors=dict.fromkeys(ERROR_LABELS, 0.0))
        pane.add(exact)
        pane._chart.forget()
        pane.draw()
        assert exact not in pane._drawn  # which no logarithm has
        pane._drawn = [point]
        for right, up, found in ((6, 0, point), (7, 0, None), (0, 3, point), (0, 4, None)):
            await pilot.hover(pane, (at[0] + right, at[1] - up))
            assert pane.pointer is found
        await pilot.click(pane, at)
        await complete(pilot, pane)
        assert (live.stepping.h, pane.index) == (point.h, 3)
        assert pane.pointer is None  # the words follow h until it moves again
        await pilot.press("right")
        assert pane.cursor.steps == RUNGS[3]
        await pilot.press("up")
        assert (pane.index, pane.cursor.method.key) == (VERLET, "velocity_verlet")
        await pilot.press("escape", "e")
        assert "theta error" in str(pane.border_title)
        await pilot.hover(pane, (70, 2))
        assert pane.pointer is None  # far from any point


async def test_all_methods_are_charted_and_one_beside_the_cast_gives_its_h():
    async with accuracy_view() as (pilot, pane, live):
        await pilot.press("asterisk")
        await until(pilot, lambda: pane.all and is_complete(pane))
        assert pane.cast[:4] == USUAL_CAST
        assert {*pane.cast} == {*GENERAL}
        assert all(letter in pane.text for letter in "fbm")
        charts = [pane._charted(Size(60, rows)).picture for rows in (8, 11, 14, 30)]
        assert [len(chart.rows) for chart in charts] == [8, 9, 9, 24]
        pane.room = Size(60, 11)
        pane.draw()
        *_, last = pane.text.splitlines()
        assert (pane.text.count("\n"), last[-1]) == (10, "…")  # two rows of words
        assert f" {last[:-1]}" in f" {' '.join(pane._sentences())}"  # which ends with a whole word
        await pilot.press(*["tab"] * 3, "left")
        assert pane.cast[pane.index] not in USUAL_CAST
        await pilot.press("enter", "asterisk")
        await complete(pilot, pane)
        assert live.stepping.h == 5.0 / RUNGS[0]
        assert pane.cast == USUAL_CAST
