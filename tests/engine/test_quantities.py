"""Each quantity is named once, and what is read off the list agrees with it."""

from pendu_tui.engine.models import MODELS, NUMBERS
from pendu_tui.engine.quantities import CHARTED, QUANTITIES, RECORDED
from pendu_tui.engine.run.lockstep import Reading


def test_a_reading_has_the_recorded_quantities_in_order_and_requires_those_always_recorded():
    *fields, extra = Reading._fields
    assert fields == [each.name for each in RECORDED]
    assert extra == "extra"
    defaults = Reading._field_defaults
    optional = {each.name for each in RECORDED if each.recorded == "if known"}
    assert set(defaults) - {"extra"} <= optional


def test_no_two_quantities_share_a_name_or_a_head():
    for model in MODELS.values():
        quantities = (*QUANTITIES, *model.variables)
        assert len({each.name for each in quantities}) == len(quantities)
    heads = [each.head.narrow for each in QUANTITIES if each.head.narrow]
    assert len(set(heads)) == len(heads)


def test_what_has_a_column_is_explained_and_fits_its_width():
    for each in QUANTITIES:
        assert bool(each.head.wide) == bool(each.sentence), each.name
        assert len(each.head.narrow) <= each.head.width
        assert len(each.head.wide) <= each.head.wide_width


def test_every_chart_has_a_title_and_the_charted_are_those_with_one():
    assert {each for each in QUANTITIES if each.chart.title} == {*CHARTED}
    for model in MODELS.values():
        assert all(each.chart.title for each in model.charted())


def test_the_numbers_of_a_scene_have_the_units_of_its_equations():
    units = {name: number.unit for name, number in NUMBERS.items()}
    known = {
        "theta": "rad",
        "omega": "rad/s",
        "length": "m",
        "gravity": "m/s²",
        "h": "s",
        "friction": "s⁻¹",
        "stiffness": "s⁻²",
        "coupling": "s⁻²",
        "level_frequency": "s⁻¹",
    }
    assert known.items() <= units.items()
