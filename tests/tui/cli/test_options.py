"""Numbers and names of a scene from options."""

import re

import pytest

from pendu_tui.engine.inputs import number
from pendu_tui.engine.scenes import Scene
from pendu_tui.tui.cli import units
from pendu_tui.tui.cli.options import above_zero, count, ladder, moment, scale, step_sizes, values
from pendu_tui.tui.cli.scene import scene_of
from pendu_tui.tui.commands.options import parser_of


def scene_from(*arguments: str) -> Scene:
    return scene_of(parser_of("snapshot").parse_args(list(arguments)))


OTHERS = "ps bar kbar atm GPa MPa g/cm^3 A^3 nm^3 % m m/s rad rad/s deg N V V/m"


@pytest.mark.parametrize(
    ("read", "text", "value"),
    [
        (values(number), "0.2,0.1,0.2", [0.1, 0.2]),
        (values(number), "1:2:2", [1.0, 2.0]),
        (values(number), "1:2:3", [1.0, 1.5, 2.0]),
        *((values(number), text, None) for text in ("1:2", "1:2:1", "2:1:3", "1:2:1000001")),
        (ladder, "0.001:0.2:1000", (0.2, 0.001, 1000)),  # the largest first
        (ladder, "0.2:0.001:9", (0.2, 0.001, 9)),
        (ladder, "0.2:0.1:1001", None),
        (above_zero(number, 2), "1.9", 1.9),
        *((above_zero(number, 2), text, "zero and below 2") for text in ("0", "2", "nan")),
        *((moment, text, float(text)) for text in ("0", "3600")),
        *((moment, text, None) for text in ("-0.1", "3600.1", "nan")),
        (count, "1234567890", 1_234_567_890),
        *((count, text, None) for text in ("0", "1_0", 19 * "1")),
        (scale, "std", ("std", None)),
        (scale, "2", (2.0, None)),
        (scale, "kinetic:Ekin", (None, "Ekin")),
        *((scale, text, None) for text in ("kinetic:", "first:1")),
        (step_sizes, "1,2", [1.0, 2.0]),
        *((units.is_unit, text, True) for text in ("fs", "eV")),
        *(
            (lambda text: bool(re.fullmatch(units.UNIT, text)), f"{each}J", True)
            for each in "kmnuµμ"
        ),
        (lambda text: {units.shown("time", text)}, "Myr", {"Myr"}),
        (lambda text: [units.shown(kind, text) for kind in ("time", "energy")], "S", ["s", "S"]),
        (lambda text: units.size("time", text), "lj", "the unit of time is not known"),
        (units.moment, "-2.5e-1ps", (-0.25, "ps")),
        (units.moment, "1e999", None),
        (units.quantity, "0fs", None),
        *((units.quantity, f"1{unit}", f"'{unit}' is not a known unit") for unit in ("kg", "eV")),
        (units.assignments, "energy=lj,", {"energy": "lj"}),
        (units.assignments, "time=ps, energy = kJ/mol", {"time": "ps", "energy": "kJ/mol"}),
        *((units.assignments, text, None) for text in ("time=ps,mass=u", "time=,energy=eV", ",")),
        (units.assignments, "time=lj", "'lj' is not a known unit of time"),
        *(
            (units.assignments, f"energy={unit}", f"'{unit}' is not a unit of")
            for unit in OTHERS.split()
        ),
        *((units.moment, text, None) for text in ("ps", "")),
        (units.moment, "2", (2.0, "")),
        (units.moment, "2 ps", (2.0, "ps")),
        (units.split_unit, " Time (ps) ", ("Time", "ps")),
        *((units.split_unit, f"t{end}", ("t", "ps")) for end in ("_ps", "/ps", " ps", "{ps}")),
        *((units.split_unit, f"E{end}", ("E", "eV")) for end in ("_eV", "/eV", " eV", "[eV]")),
        *(
            (units.split_unit, end, (end, ""))
            for end in ("E (kin)", "Epot(pot)", "E(const)", "E_s")
        ),
        (units.split_unit, "E(t)", ("E", "")),
    ],
)
def test_the_text_of_an_option_is_its_value_or_refused(read, text, value):
    if value is not None and not isinstance(value, str):
        assert read(text) == value
        return
    with pytest.raises(ValueError, match=re.escape(value or repr(text))):
        read(text)


@pytest.mark.parametrize("text", ["-1", "-1e-3", "-.5", "-0", "-pi/2", "-π/2"])
def test_a_negative_number_after_an_option_is_its_value(text):
    assert scene_from("--omega", text) == scene_from(f"--omega={text}")
