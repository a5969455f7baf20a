"""A method and its claims."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from engine.models.model import Force, Model, Phase
from engine.models.modified_energy import ModifiedEnergy

Phases = Callable[[Force, Phase, float], Iterator[Phase]]
"""(force, phase, h) -> the phases after one step of h [s], after two, and so on without end."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Method:
    """A method and what is claimed of it; tests/engine/methods measure every claim."""

    key: str  # in topics, JSON and on the command line
    label: str  # for people
    letter: str  # its mark on charts, never colour alone
    phases: Phases
    formula: str
    order: int  # global order on the nonlinear pendulum, over at most one period
    force_evaluations: int  # a step
    first_same_as_last: bool = (
        False  # the last force of a step is the next one's first: a run needs one more than its steps
    )
    symplectic: bool = False  # the step's Jacobian has determinant 1
    reversible: bool = False  # the step and omega -> -omega undo each other
    linear_limit: float | None = None  # largest stable z = h·w0 on the linear oscillator; 0: none; None: no one number
    other_names: tuple[str, ...] = ()
    reference: str
    used: str | None  # a program that uses it, with its page in brackets; None if we know of none
    note: str = ""  # what else to know; also tested
    modified_energy: ModifiedEnergy | None = None  # conserved up to O(h⁴); None if none is known
    with_friction: Phases | None = None  # the same where the force has `friction`, if `phases` does not ask for it
    models: tuple[str, ...] = ("pendulum", "linear")  # keys of the models that it integrates
    general: bool = True  # takes any force, also on arrays, complex and mpmath numbers; maps and areas need that
    varies: bool = False  # its evaluations depend on the phase; `force_evaluations` is then an average

    def on(self, model: Model) -> "Method":
        """This method for a model: with its friction, if it has any."""
        return replace(self, phases=self.with_friction) if model.friction and self.with_friction else self

    def step(self, force: Force, phase: Phase, h: float) -> Phase:
        """The phase after one step of h [s]."""
        return next(self.phases(force, phase, h))

    def evaluations(self, steps: int) -> int:
        """How many times a run of so many steps evaluates the force; about, where that varies."""
        return steps * self.force_evaluations + self.first_same_as_last
