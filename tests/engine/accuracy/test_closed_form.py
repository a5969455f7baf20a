"""The closed form compiled: the same motion, many times as fast."""

import itertools

import numpy as np
import pytest

from engine.accuracy import closed_form
from engine.accuracy.closed_form import at_times, closed_form_seconds, compiled_motion
from engine.run.compiled import available
from engine.scenes import Scene

REGIMES = {
    "libration": Scene(theta=2.0),
    "rotation": Scene(theta=0.5, omega=-8.0),
    "separatrix": Scene(theta=0.0, omega=2.0, gravity=1.0),
    "equilibrium": Scene(theta=0.0),
}


@pytest.mark.skipif(not available(), reason="Numba is not installed")
@pytest.mark.parametrize("regime", REGIMES)
def test_compiled_it_is_the_motion_of_plain_python_but_for_the_last_digit(regime):
    exact, times = REGIMES[regime].exact(), np.linspace(0, 20, 401)
    assert exact.regime == regime
    fast, plain = compiled_motion(exact.at), [exact.at(float(t)) for t in times]
    largest = np.max(np.abs(plain))
    assert np.max(np.abs(np.array([fast(float(t)) for t in times]) - plain)) <= 1e-15 * largest
    assert at_times(fast, times) == pytest.approx([state.theta for state in plain], rel=1e-15, abs=1e-15 * largest)


@pytest.mark.parametrize("compiled", [True, False])
def test_its_seconds_are_the_shortest_by_the_clock(compiled, monkeypatch):
    monkeypatch.setattr(closed_form, "available", lambda: compiled and available())
    ticks = itertools.chain.from_iterable((0.0, length) for length in (50.0, 30.0, 40.0, 60.0, 35.0))
    assert closed_form_seconds(REGIMES["libration"], 100.0, lambda: next(ticks)) == 30.0 / closed_form.RUNS
    assert next(ticks, None) is None
