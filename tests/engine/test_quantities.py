"""Each quantity is named once, and what is read off the list agrees with it."""

import re

from pendu_tui.engine.models import MODELS
from pendu_tui.engine.quantities import CHARTED, EXTREMES, QUANTITIES, RECORDED
from pendu_tui.engine.run.lockstep import Reading


def test_a_reading_has_the_recorded_quantities_in_order_and_requires_those_always_recorded():
    *fields, extra = Reading._fields
    assert fields == [each.name for each in RECORDED]
    assert extra == "extra"
    defaults = Reading._field_defaults
    optional = {each.name for each in RECORDED if each.recorded == "if known"}
    assert set(defaults) - {"extra"} <= optional
    assert all(each.unit or each.about for each in RECORDED)  # which viewers show


def test_no_two_quantities_share_a_name_or_a_head():
    for model in MODELS.values():
        quantities = (*QUANTITIES, *model.variables)
        assert len({each.name for each in quantities}) == len(quantities)
    heads = [each.head.narrow for each in QUANTITIES if each.head.narrow]
    assert len(set(heads)) == len(heads)
    gate = {each.name for each in QUANTITIES if each.in_gate}
    assert gate >= {"log_energy_error", "slope", "bound", "share", "force_evaluations"}
    assert {each.name for each in QUANTITIES} - gate == {*EXTREMES, "shadow_error"}


def test_what_has_a_column_is_explained_and_fits_its_width():
    for each in (*QUANTITIES, *(model.error for model in MODELS.values())):
        assert bool(each.head.wide) == bool(each.sentence), each.name
        assert bool(each.label) == bool(each.form and format(1, each.form))
        assert len(each.head.narrow) <= each.head.width <= each.head.wide_width
        assert len(each.head.wide) <= each.head.wide_width <= 13


def test_every_chart_has_a_title_and_the_charted_are_those_with_one():
    assert {each for each in QUANTITIES if each.chart.title} == {*CHARTED}
    assert [tuple(each.chart) for each in CHARTED] == [
        ("energy error dE/E0", "|dE/E0|"),
        ("theta - exact theta [rad]", "theta error [rad]"),
        ("shadow energy error", "|shadow error|"),
        ("energy per m L² [1/s²]", "energy [1/s²]"),
    ]


def test_quantities_have_the_units_of_their_equations():
    found = {each.name: each.unit for each in QUANTITIES}
    per_second = dict.fromkeys(("drift_per_second", "slope", "bound"), "1/s")
    angles = {"theta": "rad", "omega": "rad/s", "theta_error": "rad"}
    known = {**angles, "energy": "s⁻²", "diverged_at": "s", **per_second}
    assert known.items() <= found.items()
    for each in QUANTITIES:
        told = f"{each.head.wide} {each.label} {each.sentence} {each.chart}"
        assert {*re.findall(r"\[(.+?)\]", told)} <= {each.unit, "1/s²"}
