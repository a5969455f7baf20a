"""The chart: how it answers to the mouse, and that it depends on the run alone."""

import re

import pytest
from textual.events import MouseScrollDown, MouseScrollUp
from textual.geometry import Size

from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.drawing.time_chart import time_chart
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.shown import Shown, Stretch
from pendu_tui.tui.views.lab import TimeChart
from tests.tui.harness import lab

WHOLE = SCENES["drift"]


async def test_the_pointer_reads_the_chart_out_the_wheel_zooms_there_and_keys_lead_on_and_back():
    async with lab(size=(120, 60)) as theatre:
        await theatre.run(12)
        await theatre.settled()
        chart, second = theatre.stage.query(TimeChart)
        titles = [str(each.border_title) for each in (chart, second)]
        assert [title[:9] for title in titles] == ["max |dE/E", "max theta"]
        await theatre.pilot.hover(chart, offset=(30, 4))
        text = str(chart.border_subtitle)
        assert [word for word in text.split() if word in "esvr"] == ["e", "s", "v", "r"]
        assert text.startswith(f"{chart.plot.at(29).t:.2f} s:")
        x, y = chart.content_region.offset
        for act, factor in ((MouseScrollUp, 0.8), ("z", 0.5), (MouseScrollDown, 1.25)):
            ends = chart.plot.zoomed(theatre.source.history.window(), factor, 29)
            if act == "z":
                await theatre.press(act)
            else:
                theatre.app.post_message(act(None, x + 29, y + 3, *[0] * 6))
                await theatre.pilot.pause()
            await theatre.run(2)  # the past stays there
            assert theatre.stage.shown.stretch == Stretch(1, *ends, log_time=False)
            await theatre.settled()
        assert chart.border_title == "max |dE/E0|, {:.5g} to {:.5g} s".format(*ends)
        for factor in (*[0.7] * 12, 1.1):  # not nearer than 8 rows
            chart.zoom(factor)
            await theatre.pilot.pause()
            await theatre.run(0)
        near = theatre.stage.shown.stretch
        assert 8 <= (near.end - near.begin) / WHOLE.h < 8 / 0.7 * 1.1 + 1
        few = near._replace(end=near.begin + 3 * WHOLE.h)  # as where a long run has joined rows
        theatre.stage.shown = theatre.stage.shown._replace(stretch=few)
        await theatre.run(0)
        chart.zoom(2)
        await theatre.pilot.pause()
        assert theatre.stage.shown.stretch.end > few.end
        await theatre.press("w")
        assert theatre.stage.shown == Shown().through(WHOLE)
        chart.zoom(0.5)
        await theatre.pilot.pause()
        chart.zoom(1e3)
        await theatre.press("w")
        chart.zoom(1e3)  # which has nothing to zoom out of
        await theatre.pilot.pause()
        assert theatre.stage.shown == Shown().through(WHOLE)._replace(seconds=20.0)
        await theatre.pilot.hover(second, offset=(second.plot.left + 1, 4))
        await theatre.press("z")  # at the left end, where the pointer is
        assert theatre.stage.shown.stretch.begin < 0.5
        await theatre.press("space", "+", "w")
        assert "h 0.1" in chart.text  # before the next step


def test_a_ghost_beyond_the_stretch_changes_no_axis():
    damped = SCENES["damped"].altered(h=0.1)
    live = Live(damped.with_cast(damped.cast[1:]))
    live.lay_under(2 * damped.h, 30.0)
    live.step(300)
    chart = TimeChart()
    chart.source = live
    chart.room = Size(70, 14)
    shown = Shown(quantity="energy", log=False, stretch=Stretch(1, 10.0, 15.0, log_time=False))
    axis = chart._charted(live.sample, shown).y_axis
    energies = live.ghost.window(30.0).high["energy"]
    assert energies[-1].max() < axis.low < axis.high < energies[0].min()


def test_below_a_chart_are_keys_or_the_values_that_are_known_and_fit():
    pane = TimeChart()
    pane.source = Live(WHOLE.with_cast(WHOLE.cast[1:3]))
    pane.room = Size(44, 12)
    pane.shown = Shown(quantity="shadow_error")
    pane.picture(pane.source, pane.source.sample)
    assert pane.border_subtitle == "e: quantity, w: window, z: zoom, y: axes"
    pane.source = Live(WHOLE)
    for steps, h in ((100, -0.05), (60, -0.1), (1, -0.1)):
        pane.source.step(steps)
        pane.source.change(Stepping(h))
    pane.pointer = 20
    for width, letters in ((30, "s"), (44, "sv")):  # what is known and fits
        pane.room = Size(width, 12)
        pane.picture(pane.source, pane.source.sample)
        assert re.findall(" ([esvr]) ", str(pane.border_subtitle)) == [*letters]
    assert re.findall(r"h (-\S+)", pane.plot.picture.text) == ["-0.05", "-0.1"]


def charted(fps, scene, *, changes=False, returns=False):
    """The chart of a run at so many frames a second, paused at 30 s."""
    live = Live(scene, clock=lambda: 0.0)
    for frame in range(30 * fps + 1):
        live.tick(frame / fps)
        if changes and frame == 10 * fps:
            live.change(Stepping(2 * scene.h))
    live.pause(True)
    if returns:
        end = live.sample.step
        live.go_to(1, 50)
        live.history.window()
        live.go_to(1, end)
    return time_chart(live.history.window(), scene.cast, Shown(), 60, 16).picture


@pytest.mark.parametrize(("h", "changes"), [(0.05, True), (0.01, False)])
def test_a_chart_depends_on_the_run_and_not_on_the_frames_or_on_going_back(h, changes):
    scene = WHOLE.altered(h=h)
    expected = charted(60, scene, changes=changes)
    assert charted(3, scene, changes=changes, returns=True) == expected
