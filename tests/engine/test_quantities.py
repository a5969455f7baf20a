"""Each quantity is named once, and what is read off the list agrees with it."""

import re

from pendu_tui.engine.models import MODELS
from pendu_tui.engine.quantities import CHARTED, QUANTITIES, RECORDED
from pendu_tui.engine.run.lockstep import Reading

ROWS = """
theta, rad, always, gate, theta [rad]
omega, rad/s, always, gate, omega [rad/s]
energy, s⁻², always, gate, energy [1/s²]
energy_error, (E - E0) / E0, always, gate, dE/E0, |dE/E0|
max_energy_error, over every step so far, always, gate, largest
energy_error_low, since the sample before, if known
energy_error_high, since the sample before, if known
diverged_at, s, if known, gate
max_invariant_error, over every step so far, if known, gate
log_energy_error, gate
theta_error, rad, gate, theta error, theta error [rad]
shadow_error, |shadow error|
drift_per_second, 1/s, gate, trend per s
slope, 1/s, gate
bound, 1/s, gate
share, gate
force_evaluations, gate, evals/step
"""


def told(each):
    """Name, unit or what it is, whether recorded and compared, and its titles."""
    words = [each.name, each.unit, each.about, each.recorded, "gate" if each.in_gate else ""]
    return ", ".join(filter(None, (*words, each.head.wide, each.chart.magnitude)))


def test_a_quantity_is_recorded_compared_and_shown_in_its_unit():
    known = ROWS.split("\n")[1:-1]
    assert [row for row in map(told, QUANTITIES) if row in known] == known
    for each in QUANTITIES:
        assert bool(each.head.wide) == bool(each.sentence), each.name
        shown = f"{each.head.wide} {each.label} {each.sentence} {each.chart}"
        assert {*re.findall(r"\[(.+?)\]", shown)} <= {each.unit, "1/s²"}


def test_a_reading_has_the_recorded_quantities_in_order():
    *fields, extra = Reading._fields
    assert fields == [each.name for each in RECORDED]
    assert extra == "extra"
    assert {*Reading._field_defaults} >= {"diverged_at", "max_invariant_error", extra}
    assert "energy_error_high" not in Reading._field_defaults


def test_no_two_quantities_share_a_name():
    own = (each for model in MODELS.values() for each in model.variables)
    names = [each.name for each in (*QUANTITIES, *own)]
    assert len(set(names)) == len(names)


def test_the_charted_quantities_are_those_with_a_title():
    assert {each for each in QUANTITIES if each.chart.title} == {*CHARTED}
    names = [each.name for each in CHARTED]
    assert names == ["energy_error", "theta_error", "shadow_error", "energy"]
