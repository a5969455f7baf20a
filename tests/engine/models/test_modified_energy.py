"""Modified (shadow) energies: symplectic methods keep them."""

import math
from itertools import islice

import pytest

from pendu_tui.engine.methods import METHODS
from pendu_tui.engine.models.pendulum import Pendulum

PENDULUM = Pendulum(9.81)
with_shadow = [method for method in METHODS if method.modified_energy]


def wobbles(method, h):
    """How far the energy and the modified energy go from their starts and back, within 20 s."""
    phases = list(islice(method.on(PENDULUM)((1.0, 0.0), h), round(20 / h)))
    plain = [PENDULUM.energy()(phase) for phase in phases]
    modified = [method.modified_energy(PENDULUM, phase, h) for phase in phases]
    return max(plain) - min(plain), max(modified) - min(modified)


def test_only_symplectic_methods_have_one():
    keys = {"symplectic_euler", "velocity_verlet", "position_verlet", "implicit_midpoint"}
    assert {method.key for method in with_shadow} == keys
    assert all(method.symplectic for method in with_shadow)


@pytest.mark.parametrize("method", with_shadow, ids=lambda method: method.key)
def test_the_energy_wobbles_by_the_order_and_the_modified_energy_by_h4(method):
    (plain, modified), (finer, finer_modified) = (wobbles(method, h) for h in (0.05, 0.025))
    assert modified < plain / 100
    # the sampled extremes of a wobble are a few per cent off the true ones
    assert math.log2(plain / finer) == pytest.approx(method.order, abs=0.1)
    assert math.log2(modified / finer_modified) == pytest.approx(4, abs=0.1)
