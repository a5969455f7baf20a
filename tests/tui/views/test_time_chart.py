"""The chart: how it answers to the mouse, and that it depends on the run alone."""

import pytest
from textual.events import MouseScrollDown, MouseScrollUp

from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.drawing.time_chart import time_chart
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.shown import Shown, Stretch
from pendu_tui.tui.views.lab import TimeChart
from tests.tui.harness import lab
from tests.tui.playback.test_history import run

WHOLE = SCENES["drift"]


def chart(seconds=100.0, shown=None, **options):
    """The chart of a run of a sample every 50 ms, and its history."""
    history = run(WHOLE, (round(seconds / WHOLE.h), WHOLE.h))
    between = history.window() if shown is None else history.between(*shown[1:3])
    return time_chart(between, WHOLE.cast, Shown(stretch=shown, **options), 60, 12), history


@pytest.mark.parametrize("log", [True, False])
def test_what_is_under_the_pointer_stays_there_in_a_zoom_and_the_whole_run_is_the_farthest(log):
    plot, history = chart(log=log, log_time=log)
    column = plot.left + 35
    begin, end = plot.zoomed(history.window(), 0.1, column)
    nearer, _ = chart(shown=Stretch(1, begin, end, plot.log_time), log=log)
    assert (plot.log_time, nearer.log_time) == (log, log)
    assert nearer.times[35] == pytest.approx(plot.times[35], rel=1e-6)
    assert plot.times[0] < nearer.times[0] < nearer.times[-1] < plot.times[-1]
    assert nearer.zoomed(history.window(), 1e3) is None


async def test_the_pointer_reads_the_chart_out_the_wheel_zooms_there_and_keys_lead_on_and_back():
    async with lab() as theatre:
        await theatre.run(12)
        await theatre.settled()
        chart = theatre.stage.query(TimeChart).first()
        await theatre.pilot.hover(chart, offset=(30, 4))
        text = str(chart.border_subtitle)
        assert [word for word in text.split() if word in "esvr"] == ["e", "s", "v", "r"]
        t = chart.plot.at(29).t
        assert text.startswith(f"{t:.2f} s:")
        x, y = chart.content_region.offset
        scroll = None, x + 29, y + 3, *[0] * 6
        theatre.app.post_message(MouseScrollUp(*scroll))
        await theatre.pilot.pause()
        await theatre.settled()
        stretch = theatre.stage.shown.stretch
        assert stretch.end - stretch.begin == pytest.approx(0.8 * 12, rel=0.01)
        assert chart.plot.at(29).t == pytest.approx(t, abs=0.02)
        await theatre.run(2)  # the past stays there
        assert theatre.stage.shown.stretch == stretch
        span = f"{stretch.begin:.5g} to {stretch.end:.5g} s"
        assert str(chart.border_title) == f"max |dE/E0|, {span}"
        await theatre.press("z")
        half = theatre.stage.shown.stretch
        assert half.end - half.begin == pytest.approx((stretch.end - stretch.begin) / 2)
        theatre.app.post_message(MouseScrollDown(*scroll))
        await theatre.pilot.pause()
        farther = theatre.stage.shown.stretch
        assert farther.end - farther.begin == pytest.approx((half.end - half.begin) / 0.8)
        for factor in (*[0.7] * 12, 1.1):  # not nearer than 8 rows
            chart.zoom(factor)
            await theatre.pilot.pause()
            await theatre.run(0)
        near = theatre.stage.shown.stretch
        assert 8 <= (near.end - near.begin) / WHOLE.h < 8 / 0.7 * 1.1 + 1
        await theatre.press("w")
        assert theatre.stage.shown == Shown().through(WHOLE)
        chart.zoom(0.5)
        await theatre.pilot.pause()
        chart.zoom(1e3)
        await theatre.press("w")
        chart.zoom(1e3)  # which has nothing to zoom out of
        await theatre.pilot.pause()
        assert theatre.stage.shown == Shown().through(WHOLE)._replace(seconds=20.0)
        await theatre.press("space", "+")
        assert "h 0.1" in chart.text  # before the next step


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
