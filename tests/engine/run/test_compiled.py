"""Compiled loops have the bits of plain ones, or are plain ones."""

import math

import pytest

from pendu_tui.engine.methods import GENERAL, RK4, VELOCITY_VERLET
from pendu_tui.engine.models import MODELS
from pendu_tui.engine.models.pendulum import Pendulum
from pendu_tui.engine.run import loops as loops_module
from pendu_tui.engine.run.loops import CompiledLoops, PlainLoops, TieredLoops, available, compiled
from tests.engine.run.test_loops import OVERFLOWING

needs_numba = pytest.mark.skipif(not available(), reason="Numba is not installed")
PENDULUM = Pendulum(9.81)
each_method = pytest.mark.parametrize("method", GENERAL, ids=lambda method: method.key)


@needs_numba
@each_method
def test_compiled_steps_have_the_same_bits_and_free_their_memory(method):
    fast, slow = compiled(method, PENDULUM), PlainLoops(method, PENDULUM)
    assert fast is not slow
    start = ((2.5, 0.3), 0.05, 20_000)
    assert fast.advance(*start, math.inf) == slow.advance(*start, math.inf)

    resource = pytest.importorskip("resource", reason="no count of page faults")

    def faults(runs):
        before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
        for _ in range(runs):
            fast.propagate((1.0, 0.0), 0.01, 2)
        return resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before

    faults(1000)
    assert faults(20_000) < 200  # pages; a list of BM4's in each run would fill 1000


@needs_numba
@pytest.mark.parametrize("method", [VELOCITY_VERLET, RK4], ids=lambda method: method.key)
@pytest.mark.parametrize(
    "model", [kind(98.1) for kind in MODELS.values() if not kind.without_force], ids=str
)
@pytest.mark.parametrize("h", [0.001, -0.02, 0.7, 3.0])
def test_compiled_and_plain_agree_on_any_model_at_any_step(method, model, h):
    start = ((math.radians(179.9), -0.2), h, 2_000)
    fast, slow = compiled(method, model), PlainLoops(method, model)
    found = fast.advance(*start, 1e9)
    assert repr(found) == repr(slow.advance(*start, 1e9))  # repr: nan where no step was taken
    if found[0] == 2_000:
        assert fast.propagate(*start) == slow.propagate(*start)


@needs_numba
def test_a_method_that_overflows_ends_at_the_same_step_compiled_and_plain():
    start = ((1.7, 0.0), 0.1, 100, math.inf)
    expected = PlainLoops(OVERFLOWING, PENDULUM).advance(*start)
    assert 0 < expected[0] < 100
    assert compiled(OVERFLOWING, PENDULUM).advance(*start) == expected


@each_method
@pytest.mark.parametrize("ahead", [0, 10_000])
def test_loops_have_the_same_bits_before_and_after_they_are_compiled(method, ahead, monkeypatch):
    monkeypatch.setattr(loops_module, "COMPILED_FROM", 3_000)
    loops, plain = (
        TieredLoops(method, PENDULUM, expected_steps=ahead),
        PlainLoops(method, PENDULUM),
    )
    for n in (1_000, 1_000, 2_000, 500):
        start = ((2.0, 0.0), 0.05, n)
        assert loops.propagate(*start) == plain.propagate(*start)
        assert loops.advance(*start, math.inf) == plain.advance(*start, math.inf)


@needs_numba
@pytest.mark.parametrize(("ahead", "compiled_steps"), [(0, [2, 4]), (3, [1, 2, 4])])
def test_it_pays_from_a_number_of_steps_done_or_known_to_lie_ahead(
    ahead, compiled_steps, monkeypatch
):
    monkeypatch.setattr(loops_module, "COMPILED_FROM", 3)
    used = []

    def fast(method, model):
        advance = PlainLoops(method, model).advance
        return CompiledLoops(propagate=lambda *start: used.append(start[-1]), advance=advance)

    loops = TieredLoops(GENERAL[0], PENDULUM, fast, ahead)
    for n in (1, 2, 4):
        loops.propagate((1.0, 0.0), 0.05, n)
    assert used == compiled_steps


@needs_numba
def test_where_the_compiled_sine_differs_plain_loops_are_used(monkeypatch):
    class OtherSine:
        """Numba where one sine in two thousand is a bit off."""

        @staticmethod
        def njit(function):
            def sine(x):
                right = function(x)
                return math.nextafter(right, 2.0) if round(1000 * x) % 2000 == 7 else right

            return sine

    monkeypatch.setattr(loops_module, "_same_sine", loops_module._same_sine.__wrapped__)
    monkeypatch.setattr(loops_module, "_compiled", loops_module._compiled.__wrapped__)
    assert not isinstance(compiled(GENERAL[0], PENDULUM), PlainLoops)
    monkeypatch.setattr(loops_module, "import_module", lambda name: OtherSine)
    assert isinstance(compiled(GENERAL[0], PENDULUM), PlainLoops)
