"""The names of `from pendu_tui.engine import ...`."""

import math
import pkgutil
from dataclasses import replace
from itertools import islice

import numpy as np
import pytest

from pendu_tui import engine
from pendu_tui.engine import (
    METHODS,
    SCENES,
    fluctuation_order,
    judge,
    library,
    limits,
    measure,
    recommend,
    simulate,
)
from pendu_tui.engine.run.lockstep import Lockstep

GENERAL = [key for key, method in METHODS.items() if method.general]
TIMES = np.arange(2000.0)
WAVE = 10 + np.cos(TIMES)


def test_no_module_hides_a_name_of_the_library():
    modules = {module.name for module in pkgutil.iter_modules(engine.__path__)}
    assert "run" in modules
    assert not modules & {*dir(engine)}


def test_a_run_has_every_step_of_the_lockstep_as_arrays():
    run = simulate("drift", theta=2.0, h=0.05, time=60, methods="rk4,verlet")
    lockstep = Lockstep(run.scene)
    assert list(run) == ["rk4", "velocity_verlet"]
    for step in range(0, 1201, 100):
        rk4, verlet = lockstep.sample().readings
        assert (run.t[step], run["rk4"].theta[step]) == (lockstep.t, rk4.theta)
        assert run["verlet"].energy_error[step] == verlet.energy_error
        lockstep.advance(100)
    assert (run["rk4"].verdict, run["verlet"].verdict) == ("loses", "bounded")
    coarse = simulate("drift", theta=2.0, h=0.05, time=60, methods="verlet", every=500)
    assert coarse.t.tolist() == run.t[[0, 500, 1000, 1200]].tolist()
    assert coarse["verlet"].omega[-1] == run["verlet"].omega[-1]
    assert type(simulate(h=np.float32(0.1), time=1).scene.h) is float
    one = simulate(time=0.05)
    assert (one.scene, len(one.t)) == (SCENES["drift"], 2)


def test_a_run_keeps_so_many_readings_of_all_its_methods_together(monkeypatch):
    assert library.MAX_READINGS * 4 * 8 == 320e6  # bytes
    monkeypatch.setattr("pendu_tui.engine.library.MAX_READINGS", 40)
    assert len(simulate(h=0.1, time=2, methods="rk4,verlet").t) == 21
    assert len(simulate(h=0.1, time=0.3, methods=METHODS["rk4"]).t) == 4
    assert len(simulate(h=0.1, time=8, methods="rk4", every=np.int64(2)).t) == 41
    with pytest.raises(ValueError, match="21 steps are too many"):
        simulate(h=0.1, time=2.1, methods="rk4,verlet")


def test_results_print_briefly_and_refuse_other_methods_with_a_sentence():
    run = simulate(time=60, methods="rk4,verlet")
    for results in (run, limits(methods="rk4,verlet", steps=5)):
        assert results["verlet"] is results["velocity_verlet"]
        with pytest.raises(KeyError, match=r"'heun' does not name one .* rk4, velocity_verlet"):
            results["heun"]
    with pytest.raises(KeyError, match=r"'nope' does not name one .* explicit_euler, "):
        METHODS["nope"]
    with pytest.raises(KeyError, match="one method"):
        METHODS["blanes"]
    for result in (run, recommend(1e-2, "spin", methods="rk4,verlet", time=1)):
        assert "rk4" in repr(result)
        assert len(repr(result)) < 1000


def test_a_run_that_overflows_says_when():
    track = simulate("linear", h=3.0, time=4000, methods=[METHODS["rk4"]], every=100)["rk4"]
    assert track.verdict == "failed"
    assert 0 < track.diverged_at < 4000
    assert np.isfinite(track.theta).all()


RISING = WAVE - 30 + 1e-3 * TIMES


@pytest.mark.parametrize(("scale", "size"), [("std", np.std(RISING)), ("first", 19.0), (2.0, 2.0)])
def test_the_judge_gives_a_trend_with_its_uncertainty_over_the_scale(scale, size):
    found = judge(TIMES.tolist(), RISING.tolist(), scale=scale)
    assert (found.verdict, found.scale) == ("grows", pytest.approx(size))
    assert abs(found.slope * found.scale - 1e-3) < 4 * found.uncertainty * found.scale < 1e-4
    assert found.max_error == pytest.approx(3 / found.scale, rel=0.5)
    assert found.error == pytest.approx((RISING[-1] - RISING[0]) / found.scale)
    assert found.fluctuation == pytest.approx(math.sqrt(0.5) / found.scale, rel=1e-3)
    assert (found.independent, found.rests) == (2000, False)
    assert judge(TIMES, WAVE + 10 * (TIMES > 300), scale).rests
    assert judge(TIMES, WAVE).max_error == pytest.approx(2 / 11, rel=1e-3)  # downwards
    assert judge([1, 2], np.array([200, 199], dtype=np.uint8)).error == -1 / 200


def test_a_trend_is_never_beyond_doubles():
    found = judge(TIMES, 1e290 * (WAVE + TIMES), scale=1e-300)
    assert (found.slope, found.uncertainty, found.bound) == (None, None, None)
    largest = judge(TIMES, 1e290 * WAVE, scale="std").scale
    assert largest == pytest.approx(1e290 * np.std(WAVE))
    assert found.lines()[-1] == "energy error  too large for a number"


def test_a_judged_series_prints_as_the_command_does():
    half_the_band = WAVE + TIMES / len(TIMES)  # rises by 1, in a band from -1 to 1
    found = replace(judge(TIMES, half_the_band), slope=5e-5, uncertainty=2e-6, bound=6e-5)
    found = replace(found, reason="it waits", error=-0.25, max_error=0.5, scale=20.0)
    assert found.lines("ps", "eV") == [
        "verdict       grows: it waits",
        "trend         relative +5.00e-05 ± 2e-06 per ps, absolute +1.00e-03 ± 4e-05 eV per ps",
        "bound         relative 6.00e-05 per ps at 99 %",
        "share         +50 % of the band over this record",
        "energy error  -2.50e-01 at the end, 5.00e-01 at most, relative to 20 eV",
    ]
    settled = replace(found, rests=True, reason="", share=-1.0)
    assert settled.lines(step="step") == [
        "verdict       grows, then settles",
        "trend         relative +5.00e-05 ± 2e-06 per step, absolute +1.00e-03 ± 4e-05 per step",
        "bound         relative 6.00e-05 per step at 99 %",
        "share         -1 times the band over this record",
        "energy error  -2.50e-01 at the end, 5.00e-01 at most, relative to 20",
    ]
    failed = judge(TIMES, [*WAVE[:-1], math.nan])
    assert failed.lines("fs")[0] == "verdict       failed: the energies break down at 1999 fs"
    assert "nan" not in str(failed)
    assert "± 2e-06 per unit of time, absolute" in str(found)


def test_an_energy_that_never_changes_is_bounded_on_every_scale():
    for energy, scale in ((3.0, "std"), (3.0, "first"), (0.0, "std")):
        found = judge(range(100), [energy] * 100, scale=scale)
        assert (found.verdict, found.slope, found.max_error) == ("bounded", 0, 0)


@pytest.mark.parametrize("energy", [math.nan, math.inf, -1.79769e308])
@pytest.mark.parametrize("after", [[], WAVE[-5:] + 100])
def test_the_first_energy_that_is_nan_infinite_or_too_large_has_failed(energy, after):
    energies = [*WAVE[: -10 - len(after)], *[energy] * 10, *after]
    found = judge(TIMES, energies)
    assert found.verdict == "failed"
    assert found.slope is None
    assert found.max_error < 10


def still(force, phase, h):
    yield phase


@pytest.mark.parametrize(
    ("call", "word"),
    [
        (lambda: judge([0, 1, 2], [1, 1]), "3 times and 2 energies"),
        (lambda: judge(TIMES[::-1], WAVE), r"times\[1\] is not later"),
        (lambda: judge(TIMES, [math.nan, *WAVE[1:]]), r"energies\[0\] is nan"),
        *((lambda t=t: judge(t, t), "times must be a list of numbers") for t in ([TIMES], [], "t")),
        *(
            (lambda e=e: judge([1, 2], e), "energies must be a list")
            for e in ([10**400, 1], np.array([1j, 1]))
        ),
        (lambda: judge(TIMES, np.ma.masked_greater(WAVE, 10)), "energies has masked values"),
        (lambda: judge(TIMES, 0 * WAVE, scale="first"), "above zero"),
        (lambda: judge(TIMES, WAVE, scale="frist"), "no scale 'frist': did you mean first"),
        (lambda: judge(TIMES, WAVE, scale=10**400), "not a finite number"),
        (lambda: simulate("pendulum", time=1), "no scene 'pendulum'; choose from drift, gentle, "),
        (lambda: simulate("x" * 99, time=1), f"no scene '{60 * 'x'}'"),
        (lambda: recommend(1e-3, error="angle"), "no kind of error 'angle'"),
        (lambda: simulate(time=1, methods=5), "no method '5'"),
        (lambda: simulate(time=1e308), r"steps are too many to keep; use every="),
        (lambda: judge(1e160 * TIMES, WAVE), r"times span 2e\+163"),
        (lambda: judge(1e-200 * TIMES, WAVE), "times span 2e-197"),
        (lambda: simulate(time=0.01), "shorter than one step"),
        (lambda: simulate(time=True), "time = True"),
        (lambda: simulate(time=None), "time = None"),
        (lambda: simulate(time=126_000), r"use every=252\."),  # ten million readings
        (lambda: simulate(time=1, every=1.5), "every = 1.5"),
        (lambda: simulate(time=1, theta="90"), "theta = '90'"),
        (lambda: simulate(time=1, tetha=2.0), "no number 'tetha': did you mean theta"),
        (
            lambda: recommend(1e-20, time=1, methods="explicit_euler,rk4"),
            "1e-20 over 1 s; RK4: rounding",
        ),
        (lambda: recommend(0), "target = 0 is not above zero"),
        (lambda: recommend(1e-3, time=0), "time = 0 is"),
        (lambda: recommend(1e-3, theta=0), "at rest"),
        (lambda: limits(omega=20), "a pendulum that swings"),
        (lambda: limits("linear"), "a pendulum that swings"),
        (lambda: limits("damped", methods="rk4"), "no friction"),
        (lambda: limits(steps=0), "steps = 0"),
        (lambda: measure(5), "step: it is not a generator function"),
        (lambda: measure(still), r"test_library\.py, line \d+: still ends"),
        (lambda: fluctuation_order([(math.nan, TIMES, WAVE)]), "h = nan"),
        (lambda: fluctuation_order([(0.1, [0], [1])]), r"h = 0\.1: 1 energies are too few"),
        (
            lambda: fluctuation_order([(0.1, TIMES, [1, math.inf, *WAVE[2:]])]),
            r"energies at h = 0\.1\[1\] is inf",
        ),
    ],
)
def test_what_cannot_be_used_is_refused_with_a_sentence(call, word):
    with pytest.raises(ValueError, match=word):
        call()


def test_limits_are_where_the_swing_is_lost():
    found = limits(theta=2.0, methods="verlet,rk4,blanes_moan_6")
    verlet = found["velocity_verlet"]
    assert (verlet.linear, verlet.reason) == (2, "over the top")
    assert (found["rk4"].z, found["rk4"].reason) == (pytest.approx(0.684, rel=0.01), "loses")
    assert (found["blanes_moan_6"].z, found["blanes_moan_6"].reason) == (None, "")
    thrown = limits(theta=0, omega=5.27, methods="verlet", steps=5)["verlet"]  # to 2.0 rad
    assert thrown.z > verlet.z
    assert list(limits(steps=5)) == GENERAL
    for share, held in [(0.98, True), (1.0, False)]:
        run = simulate(theta=2.0, h=share * verlet.h, time=1000 * verlet.h, methods="verlet")
        assert (np.abs(run["verlet"].theta).max() < math.pi) == held


def test_the_cheapest_runs_that_are_good_enough_come_first():
    def found(target, methods="rk4,verlet", time=5, **error):
        attempts = recommend(target, methods=methods, time=time, **error)
        return [(each.method.letter, each.point.steps) for each in attempts]

    assert found(1e-2) == found(1e-2, error="theta") == [("r", 24), ("v", 115)]
    assert found(1e-2, error="energy") == [("v", 76), ("r", 28)]
    assert found(1e-2, error="final") == [("r", 24), ("v", 107)]
    assert found(1e-9, "explicit_euler,rk4", time=1) == [("r", 185)]
    assert recommend(0.5, methods="rk4")[0].point.time == 20.0  # ten small swings


def test_the_order_of_a_step_and_that_of_its_fluctuations_are_measured():
    found = measure(METHODS["velocity_verlet"].phases)
    assert (round(found.order, 1), found.force_evaluations) == (2, 1)
    runs = [simulate(time=40, methods="verlet", h=h) for h in (0.1, 0.05)]
    order = fluctuation_order((run.scene.h, run.t, run["verlet"].energy) for run in runs)
    assert order.power == pytest.approx(2, abs=0.02)


def test_only_methods_for_any_force_take_one():
    for key, method in METHODS.items():
        if key not in GENERAL:
            with pytest.raises(ValueError, match=f"{method.label} is made for the scenes"):
                method.phases(np.negative, (1.0, 0.0), 0.1)


USED_AGAIN = np.empty(2)


def gravity(q):
    return np.divide(-q, np.hypot(*q) ** 3, out=USED_AGAIN)


TURN = ([0.8, 0.0], [0.0, 1.5**0.5])  # of an orbit of eccentricity 0.2


@pytest.mark.parametrize("key", GENERAL)
def test_any_force_on_arrays_is_integrated_with_the_order_of_the_method(key):
    method, errors = METHODS[key], []
    for n in (1000, 2000):
        phase = tuple(map(np.array, TURN))
        end = next(islice(method.phases(gravity, phase, math.tau / n), n - 1, None))
        errors.append(np.abs(np.subtract(end, TURN)).max())
        assert np.array_equal(phase, TURN)
    assert errors[1] < 2e-9 or math.log2(errors[0] / errors[1]) > method.order - 0.3


def test_an_implicit_method_may_give_nan_where_the_elements_of_an_array_are_coupled():
    phases = METHODS["backward_euler"].phases(gravity, tuple(map(np.array, TURN)), 0.1)
    assert np.isnan([q for q, _ in islice(phases, 60)]).any()
