"""The two state variables, and what a method needs to know of the physics."""

from collections.abc import Callable
from typing import Any, NamedTuple

Number = Any  # float, complex, NumPy array or mpmath number: one definition of a method serves them all

Phase = tuple[Number, Number]
"""(theta, omega) as a method takes and returns it: a bare tuple, the quickest value CPython builds."""

Acceleration = Callable[[Number], Number]
"""theta in rad -> theta'' in rad/s²."""


class State(NamedTuple):
    """A point of phase space."""

    theta: float  # rad from the downward vertical, unwrapped
    omega: float  # rad/s
