"""The chart's title: which quantity, its unit, of what each point is the largest, and how far back."""

from itertools import product

import pytest

from engine.scenes import SCENES
from tui.playback.shown import WINDOWS, Shown, quantities
from tui.views.lab.time_chart import title


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
