"""A method, its claims, and what is measured of one."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any, NamedTuple

from pendu_tui.engine.models import STUDIED
from pendu_tui.engine.models.model import Model, Offer, Phase, Sine

Phases = Callable[[Any, Phase, float], Iterator[Phase]]
"""(force, phase, h) -> the phases after one step of h [s], after two, and so on endlessly.

In place of the force, some take another `Offer` of the model.
"""

BoundPhases = Callable[[Phase, float], Iterator[Phase]]
"""(phase, h) -> phases, on one model."""


HAIRER = "Hairer, Lubich & Wanner, Geometric Numerical Integration (2006)"

COMPILABLE: dict[Phases, Callable[[], Phases]] = {}
"""Phases that Numba cannot compile -> a function that returns equal ones that it can."""


def compilable(phases: Phases) -> Phases:
    """Return equal phases that Numba can compile."""
    return COMPILABLE.get(phases, lambda: phases)()


ModifiedEnergy = Callable[[Model, Phase, float], float]
"""(model, (theta, omega), h [s]) -> modified energy [s⁻²]."""


def _modified(moving: float, pulled: float) -> ModifiedEnergy:
    """Return H + h² (moving omega² f'(theta) + pulled f(theta)²)/24 [s⁻²], where f is the force.

    What remains oscillates with h⁴.
    """

    def modified_energy(model: Model, phase: Phase, h: float) -> float:
        theta, omega = phase
        force = model.force()(theta)
        parts = moving * omega * omega * model.slope(theta) + pulled * force * force
        modified: float = model.energy()(phase) + h * h / 24 * parts
        return modified

    return modified_energy


velocity_verlet_modified_energy = _modified(-2, -1)
position_verlet_modified_energy = _modified(1, 2)
implicit_midpoint_modified_energy = _modified(1, -1)  # for small swings a multiple of H


def symplectic_euler_modified_energy(model: Model, phase: Phase, h: float) -> float:
    """Return velocity Verlet's modified energy half a kick later, where the two methods agree."""
    theta, omega = phase
    return velocity_verlet_modified_energy(model, (theta, omega + h / 2 * model.force()(theta)), h)


@dataclass(frozen=True, kw_only=True)
class Method:
    """A method and its properties, which tests/engine/methods measure."""

    key: str  # in topics, JSON and on the command line
    label: str  # for people
    letter: str  # its mark on charts
    hue: int | None = None  # its number on every palette; None: the next free one of the cast
    phases: Phases
    formula: str
    order: int  # global order on the nonlinear pendulum, over at most one period; 0: none
    force_evaluations: int  # a step; 0: a series, which has none to count
    # the last force of a step is the first of the next, so a run needs one more at its start
    first_same_as_last: bool = False
    symplectic: bool = False  # the step's Jacobian has determinant 1
    reversible: bool = False  # a step with -omega undoes a step
    # largest stable z = h·w0 on the linear oscillator; 0: none; inf: all; None: no single number
    linear_limit: float | None = None
    other_names: tuple[str, ...] = ()
    reference: str
    used: str | None = None  # a program that uses it, with its page in brackets
    note: str = ""  # also tested
    modified_energy: ModifiedEnergy | None = None  # conserved up to O(h⁴); None if none is known
    takes: Offer = "force"  # what `phases` takes of a model
    # the same method for models that offer something else, or that first
    others: Mapping[Offer, Phases] = field(default_factory=dict, hash=False)
    models: tuple[str, ...] = STUDIED  # keys of the models that it integrates
    any_numbers: bool = True  # also arrays, complex and mpmath numbers
    longest_substep: float = 1.0  # of a symplectic splitting, in steps: chaos begins there first
    epsilon: float = 2.0**-53  # the relative error of a rounding
    varies: bool = False  # evaluations depend on the phase; `force_evaluations` is a mean

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.key})"

    @property
    def general(self) -> bool:
        """Whether it takes any force and any numbers, as maps and studies need."""
        return self.any_numbers and self.takes == "force"

    def on(self, model: Model, sin: Sine = math.sin) -> BoundPhases:
        """Return the method's phases on a model, for numbers with this sine."""
        takes, phases = self.phases_for(model)
        return partial(phases, getattr(model, takes)(sin))

    def phases_for(self, model: Model) -> tuple[Offer, Phases]:
        """Return what it takes of a model, and its phases from that."""
        known = {self.takes: self.phases, **self.others}
        takes = next(offer for offer in model.offers if offer in known)
        return takes, known[takes]

    @property
    def names(self) -> tuple[str, ...]:
        """All names that users may type."""
        return (self.key, self.label, *self.other_names)

    def step(self, force: Any, phase: Phase, h: float) -> Phase:
        """Return the phase after one step of h [s]."""
        return next(self.phases(force, phase, h))

    def evaluations(self, steps: int) -> int:
        """Return how often a run of so many steps evaluates the force, or about that."""
        return steps * self.force_evaluations + int(self.first_same_as_last)


SMALL_ERROR = 0.1  # rad; larger ones are not yet proportional to a power of h


class Measured(NamedTuple):
    """The measured properties of a method."""

    order: float | None  # the slope of log error over log h; None: no error is ever small
    force_evaluations: float  # a step, on average over many
    more_at_the_start: int  # force evaluations
    symplectic: bool
    reversible: bool
    linear_limit: float  # z; 0: none; inf: none found

    def __str__(self) -> str:
        stable = {0.0: "at no h", math.inf: "at any h"}
        limit = f"up to z = h·w0 = {self.linear_limit:.4g}"
        lines = (
            f"order             {no_order(self.order) or f'{self.order:.3f}'}",
            f"force evaluations {self.force_evaluations:.3g} per step",
            f"symplectic        {yes(self.symplectic)}",
            f"reversible        {yes(self.reversible)}",
            f"stable            {stable.get(self.linear_limit, limit)} (small swings)",
        )
        return "\n".join(lines)


def no_order(order: float | None) -> str:
    """Return why a method has no order, a clause; "" if it has one."""
    if order is None:
        return (
            f"no order: its error stays above {SMALL_ERROR:g} rad; it may solve the wrong equation"
        )
    if round(order) < 1:
        return f"order {order:.3f}: the error does not fall with h; it solves the wrong equation"
    return ""


def yes(value: bool) -> str:
    """Return a property as a word."""
    return "yes" if value else "no"
