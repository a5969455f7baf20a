"""Equal cost: every method spends the same number of force evaluations, and all meet at the same times."""

from dataclasses import replace

import pytest

from engine.methods import METHODS
from engine.models.state import Acceleration, Phase
from engine.run.lockstep import Lockstep, parts
from engine.scenes import DEFAULT_SCENE, Scene


def bits(lockstep: Lockstep) -> list[tuple[float, float, float]]:
    return [(reading.theta, reading.omega, reading.max_energy_error) for reading in lockstep.sample().readings]


def test_every_method_then_needs_the_same_number_of_evaluations():
    costs = {method.force_evaluations * cut for method, cut in zip(METHODS, parts(), strict=True)}
    assert len(costs) == 1


@pytest.mark.parametrize("index", range(len(METHODS)), ids=[method.key for method in METHODS])
def test_a_method_takes_the_step_in_its_own_parts(index: int):
    cut = parts()[index]
    equal, alone = Lockstep(DEFAULT_SCENE), Lockstep(DEFAULT_SCENE)
    equal.set_h(0.2, equal_cost=True)
    alone.set_h(0.2 / cut)
    equal.advance(50)
    alone.advance(50 * cut)
    assert equal.t == 50 * 0.2
    assert bits(equal)[index] == bits(alone)[index]


def test_any_cut_of_the_steps_gives_the_same_bits():
    whole, cut = Lockstep(DEFAULT_SCENE), Lockstep(DEFAULT_SCENE)
    for lockstep in (whole, cut):
        lockstep.advance(7)
        lockstep.set_h(0.2, equal_cost=True)
    whole.advance(30)
    for n in (1, 9, 20):
        cut.advance(n)
    assert bits(whole) == bits(cut)


def test_a_method_that_diverges_says_when_to_its_own_part_of_a_step():
    def doubling(acceleration: Acceleration, phase: Phase, h: float) -> Phase:
        return phase[0], phase[1] * 2 + 1

    bad = replace(METHODS[0], key="bad", step=doubling)
    lockstep = Lockstep(DEFAULT_SCENE, methods=(bad, METHODS[3]))
    lockstep.set_h(0.2, equal_cost=True)
    lockstep.advance(1000)
    at = lockstep.sample().readings[0].diverged_at
    assert at is not None
    parts_taken = round(at / 0.05)
    assert at == parts_taken * 0.05
    assert (2.0 ** (parts_taken - 1)) ** 2 / 2 < 1e300 < (2.0**parts_taken) ** 2  # where omega²/2 leaves the range


def test_verlet_beats_rk4_in_energy_at_once_at_equal_cost():
    lockstep = Lockstep(Scene(theta=1.0))
    lockstep.set_h(0.4, equal_cost=True)
    lockstep.advance(25)
    error = dict(zip((m.key for m in METHODS), lockstep.sample().readings, strict=True))
    assert error["velocity_verlet"].max_energy_error < error["rk4"].max_energy_error / 10
