"""The chart: what its title says, and how it answers to the mouse."""

from itertools import product

import pytest
from textual.events import MouseScrollUp

from engine.scenes import SCENES
from tests.tui.harness import lab
from tui.playback.shown import WINDOWS, Shown, quantities
from tui.views.lab.time_chart import TimeChart, modified_energy_of, title


@pytest.mark.parametrize("name", SCENES)
def test_a_title_says_what_the_chart_shows_with_its_unit_and_fits_above_the_narrowest_chart(name):
    scene = SCENES[name]
    exact, model = scene.exact(), scene.equations
    for quantity, log, seconds in product(quantities(scene), (True, False), WINDOWS):
        text = title(Shown(quantity=quantity, log=log, seconds=seconds), exact, model.conserved)
        assert len(text) + 6 <= 52  # of 80 columns the pendulums have 28; two corners, two lines, two spaces
        cycle = {"libration": "per half swing", "rotation": "per turn"}[exact.regime] if log and exact.period else "per"
        assert cycle in text or cycle == "per"
        unit = {"theta_error": "[rad]", "energy": "[1/s²]"}.get(quantity, "")
        assert unit in text
        assert unit or any(ratio in text for ratio in ("dE/E0", "ln(E/E_true)", "shadow", "1 at"))


def test_a_chart_goes_through_what_a_scene_has_and_no_more():
    spring, drift = SCENES["stiff-slow"], SCENES["drift"]
    assert quantities(spring) == ("energy_error", "theta_error", "energy", "spring_energy")
    assert quantities(drift) == ("energy_error", "theta_error", "shadow_error", "energy")
    shown = Shown()
    for _ in range(3):
        shown = shown.next_quantity(spring)
    assert shown.quantity == "spring_energy"
    assert shown.next_quantity(spring) == Shown()
    assert shown.quantity_ahead(0, drift) == "energy_error"  # what the next scene lacks is not shown


def test_the_chart_names_the_methods_that_have_a_modified_energy_unless_all_have_one():
    cast = SCENES["drift"].cast
    assert modified_energy_of(cast) == "shadow energy is known for s and v only"
    assert modified_energy_of(cast[1:3]) == ""
    assert modified_energy_of(cast[3:]) == "shadow energy is known for none only"


async def test_the_pointer_reads_the_chart_out_and_the_wheel_takes_another_window():
    async with lab() as theatre:
        await theatre.run(12)
        await theatre.settled()
        chart = theatre.stage.query(TimeChart).first()
        await theatre.pilot.hover(chart, offset=(30, 4))
        told = str(chart.border_subtitle)
        assert [word for word in told.split() if word in "esvr"] == ["e", "s", "v", "r"]
        assert told.startswith(f"{chart._plot.at(29).t:.2f} s:")
        chart.on_mouse_scroll_up(MouseScrollUp(chart, 5, 5, 0, -1, 0, False, False, False))
        await theatre.pilot.pause()
        await theatre.pilot.pause()
        assert theatre.stage.shown.seconds == 5.0
        await theatre.press("u")
        assert theatre.stage.shown.seconds is None
        assert [each.message for each in theatre.app._notifications] == ["Undone: the window of the chart"]


async def test_it_is_built_again_when_a_column_has_passed_and_at_once_where_one_asks():
    async with lab() as theatre:
        chart = theatre.stage.query_one(TimeChart)
        await theatre.run(40)
        await theatre.settled()
        column = chart._plot.column
        assert column > 0.5  # s, on a logarithmic axis
        theatre.source.tick(theatre.now + column / 2)
        assert not chart.is_due(theatre.source.sample)
        theatre.source.tick(theatre.now + 1.5 * column)
        assert chart.is_due(theatre.source.sample)
        theatre.stage.show_now()
        assert not chart.settled
