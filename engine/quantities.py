"""Quantities: what is measured of a method in a run, named once.

Recorded fields, JSON, CSV, the gate, heads of tables, titles of charts and the glossary are read
off these rows.  A model adds its own variables, and may say what its energy error is.
"""

from typing import Literal, NamedTuple


class Head(NamedTuple):
    """The head of a column in the table of the lab: narrow, and where there is room."""

    narrow: str = ""
    width: int = 0
    wide: str = ""
    wide_width: int = 0


class Chart(NamedTuple):
    """The titles of a chart over time."""

    title: str = ""
    magnitude: str = ""  # of a logarithmic chart, if it has another title


class Quantity(NamedTuple):
    """A number of a method at one step."""

    name: str  # in readings, recordings, JSON, CSV and --fail-if
    unit: str = ""
    about: str = ""  # a clause, which viewers of recordings show in place of a unit
    recorded: Literal["always", "if known", ""] = ""
    in_gate: bool = False  # --fail-if compares it
    label: str = ""  # of its column in the tables of commands
    form: str = ""  # likewise, how to write it
    head: Head = Head()  # without a name: it has no column
    sentence: str = ""  # of the glossary, and of the pointer on its head
    chart: Chart = Chart()  # without a title: it has no chart
    relative: bool = False  # a model's variable, over its value at the start of the run


THETA = Quantity(
    "theta",
    "rad",
    recorded="always",
    in_gate=True,
    head=Head("theta", 11, "theta [rad]", 13),
    sentence="angle from the downward vertical [rad]; it may exceed a turn",
)
OMEGA = Quantity(
    "omega",
    "rad/s",
    recorded="always",
    in_gate=True,
    head=Head("omega", 6, "omega [rad/s]", 13),
    sentence="angular velocity [rad/s]",
)
ENERGY = Quantity(
    "energy",
    "s⁻²",
    recorded="always",
    in_gate=True,
    chart=Chart("energy per m L² [1/s²]", "energy [1/s²]"),
)
ENERGY_ERROR = Quantity(
    "energy_error",
    about="(E - E0) / E0",
    recorded="always",
    in_gate=True,
    label="energy error",
    form="+.2e",
    head=Head("dE/E0", 8, "dE/E0", 8),
    sentence="the energy error relative to the initial energy; the exact pendulum keeps its energy",
    chart=Chart("energy error dE/E0", "|dE/E0|"),
)
LARGEST = Quantity(
    "max_energy_error",
    about="over every step so far",
    recorded="always",
    in_gate=True,
    label="largest",
    form=".2e",
    head=Head("largest", 7, "largest", 8),
    sentence="the largest |dE/E0| since the start, or since the last change of h",
)
LOW = Quantity("energy_error_low", about="since the sample before", recorded="if known")
HIGH = Quantity("energy_error_high", about="since the sample before", recorded="if known")
DIVERGED_AT = Quantity("diverged_at", "s", recorded="if known", in_gate=True)
INVARIANT = Quantity(
    "max_invariant_error", about="over every step so far", recorded="if known", in_gate=True
)
LOG_ENERGY_ERROR = Quantity("log_energy_error", in_gate=True)
THETA_ERROR = Quantity(
    "theta_error",
    "rad",
    in_gate=True,
    label="theta error [rad]",
    form=".2e",
    head=Head("th.err", 7, "theta error", 11),
    sentence="the distance from the exact angle [rad]; after a change of h, its change since then",
    chart=Chart("theta - exact theta [rad]", "theta error [rad]"),
)
SHADOW_ERROR = Quantity("shadow_error", chart=Chart("shadow energy error", "|shadow error|"))
TREND = Quantity(
    "drift_per_second",
    "1/s",
    in_gate=True,
    label="per second",
    form="+.1e",
    head=Head("per s", 8, "trend per s", 11),
    sentence="the mean change of dE/E0 per second",
)
SLOPE = Quantity("slope", "1/s", in_gate=True)
BOUND = Quantity("bound", "1/s", in_gate=True)
SHARE = Quantity("share", in_gate=True)
EVALUATIONS = Quantity(
    "force_evaluations",
    in_gate=True,
    label="force evaluations",
    form="d",
    head=Head("evals/step", 10, "evals/step", 10),
    sentence="force evaluations per step: what the method costs",
)

QUANTITIES = (
    *(THETA, OMEGA, ENERGY, ENERGY_ERROR, LARGEST, LOW, HIGH, DIVERGED_AT, INVARIANT),
    *(LOG_ENERGY_ERROR, THETA_ERROR, SHADOW_ERROR, TREND, SLOPE, BOUND, SHARE),
    EVALUATIONS,
)
"""The quantities of every model, in the order of recorded fields."""

RECORDED = tuple(each for each in QUANTITIES if each.recorded)
EXTREMES = (LOW.name, HIGH.name)
CHARTED = (ENERGY_ERROR, THETA_ERROR, SHADOW_ERROR, ENERGY)
"""In the order of the key that goes from chart to chart; a model's own come after the first."""
