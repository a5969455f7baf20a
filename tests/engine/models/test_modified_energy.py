"""Modified (shadow) energies: symplectic methods keep them."""

import math

import pytest

from engine.methods import METHODS
from engine.models.pendulum import Pendulum, acceleration, energy

W0_SQUARED = 9.81


def energy_range(quantity, method, h, time=20.0):
    force = acceleration(W0_SQUARED)
    phase = (1.0, 0.0)
    values = []
    for _ in range(round(time / h)):
        phase = method.step(force, phase, h)
        values.append(quantity(*phase))
    return max(values) - min(values)


def shadow_of(method, h):
    assert method.modified_energy is not None
    return lambda theta, omega: method.modified_energy(Pendulum(W0_SQUARED), (theta, omega), h)


def plain_energy(theta, omega):
    return energy(W0_SQUARED, theta, omega)


def order(quantity_at, method):
    coarse, fine = (energy_range(quantity_at(h), method, h) for h in (0.05, 0.025))
    return math.log2(coarse / fine)


with_shadow = pytest.mark.parametrize(
    "method", [m for m in METHODS if m.modified_energy], ids=lambda m: m.key
)


def test_only_symplectic_methods_have_one():
    assert {method.key for method in METHODS if method.modified_energy} == {
        "symplectic_euler",
        "velocity_verlet",
        "position_verlet",
        "implicit_midpoint",
    }
    assert all(method.symplectic for method in METHODS if method.modified_energy)


@with_shadow
def test_the_energy_wobbles_with_the_order_of_the_method_and_the_modified_energy_with_h4(method):
    # the sampled extremes of a wobble are a few per cent off the true ones
    assert order(lambda h: plain_energy, method) == pytest.approx(method.order, abs=0.1)
    assert order(lambda h: shadow_of(method, h), method) == pytest.approx(4, abs=0.1)


@with_shadow
def test_the_modified_energy_is_flat_where_the_energy_wobbles(method):
    assert (
        energy_range(shadow_of(method, 0.05), method, 0.05)
        < energy_range(plain_energy, method, 0.05) / 100
    )
