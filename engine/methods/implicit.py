"""Implicit methods for any force: each step solves an equation for theta by Newton's iteration.

The slope of the force is a difference quotient.  An element of an array that has converged is not
changed any more, so its bits do not depend on the others.
"""

import math
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any

from pendu_tui.engine.methods.method import (
    COMPILABLE,
    HAIRER,
    Method,
    Phases,
    implicit_midpoint_modified_energy,
)
from pendu_tui.engine.models.model import Force, Phase
from pendu_tui.engine.models.spring import SpringParts

TOLERANCE = 1e-12  # rad, and relative, of the last correction: the next would be far smaller
MAX_ITERATIONS = 30  # a solution takes 3 to 7 below z = 0.9
WIDTH = 2.0**-26  # rad, and relative, of the difference quotient: half the digits of a double


def implicit(share: float) -> Phases:
    """Return the method with the force at a share s of the step: 1/2 is the middle, 1 the end.

    A step solves theta_s = theta + s h omega + (s h)² a(theta_s), with one solution if s z < 1.  A
    step for which Newton's iteration finds none is nan.
    """
    for_numbers = _solving(share, bool)

    @cache
    def for_arrays() -> Phases:
        import numpy as np

        return _solving(share, np.any)

    def implicit_steps(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
        if any(hasattr(value, "shape") for value in phase):
            yield from for_arrays()(force, phase, h)
        yield from for_numbers(force, phase, h)

    COMPILABLE[implicit_steps] = for_arrays
    return implicit_steps


def _solving(share: float, any_of: Callable[[Any], Any]) -> Phases:
    """Return the method for numbers; `any_of` tells whether any of an array is true."""

    def solved(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
        theta, omega = phase
        part = share * h
        while True:
            ahead = theta + part * omega
            inside = ahead
            precision = TOLERANCE * (1 + abs(ahead))
            width = WIDTH * (1 + abs(ahead))
            unsolved = precision > 0
            for _ in range(MAX_ITERATIONS):
                a = force(inside)
                slope = (force(inside + width) - a) / width
                correction = (ahead + part * part * a - inside) / (1 - part * part * slope)
                inside = inside + unsolved * correction
                unsolved = abs(correction) > precision
                if not any_of(unsolved):
                    break
            if any_of(unsolved):
                inside = inside * math.nan**unsolved  # nan ** 0 is 1: a solution stays
            a = force(inside)
            theta = theta + h * (omega + part * a)
            omega = omega + h * a
            yield theta, omega

    return solved


def implicit_midpoint_of_spring(parts: SpringParts, phase: Phase, h: float) -> Iterator[Phase]:
    """The implicit midpoint rule on a spring, with a closed form for the middle."""
    q, w = phase
    while True:
        middle = parts.solve(q + h / 2 * w + h * h / 4 * parts.slow(q), h * h / 4)
        q, w = 2 * middle - q, 4 * (middle - q) / h - w
        yield q, w


BACKWARD_EULER = Method(
    key="backward_euler",
    label="Backward Euler",
    letter="d",
    phases=implicit(1.0),
    formula="theta' = theta + h omega';  omega' = omega + h a(theta')",
    order=1,
    force_evaluations=7,
    varies=True,
    linear_limit=math.inf,
    other_names=("implicit Euler",),
    reference=f"{HAIRER}, I.1.2",
    used="stiff and differential-algebraic equations: PETSc, TSBEULER [petsc.org, TSBEULER]",
    note="The mirror image of explicit Euler: it loses energy in small swings. Newton's "
    "method, to 1e-12 rad, usually takes three iterations of two evaluations; beyond z = 1 a step "
    "may have several solutions, and fails if the iteration finds none.",
)

IMPLICIT_MIDPOINT = Method(
    key="implicit_midpoint",
    label="Implicit midpoint",
    letter="i",
    phases=implicit(0.5),
    others={"parts": implicit_midpoint_of_spring},
    formula="theta' = theta + h (omega + omega')/2;  omega' = omega + h a((theta + theta')/2)",
    order=2,
    force_evaluations=7,
    varies=True,
    symplectic=True,
    reversible=True,
    linear_limit=math.inf,
    other_names=("Gauss method of order 2",),
    reference=f"{HAIRER}, II.1.1",
    used="Markov chain Monte Carlo: BlackJAX, implicit_midpoint [blackjax-devs.github.io, "
    "blackjax.mcmc.integrators]",
    note="It keeps the energy of small swings exactly, but not their phase; beyond z = 2 a step "
    "fails if Newton's method, to 1e-12 rad with two evaluations per iteration, finds no solution. "
    "A step on a spring has a closed form, counted as one evaluation.",
    modified_energy=implicit_midpoint_modified_energy,
    models=(*Method.models, "spring"),
)

FAMILY = (BACKWARD_EULER, IMPLICIT_MIDPOINT)
