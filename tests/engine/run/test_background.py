"""Loops that never keep the screen waiting."""

import functools
import math
import threading

import pytest

from engine.methods import METHODS
from engine.run import background as unhurried
from engine.run import compiled
from engine.run.loops import plain

needs_numba = pytest.mark.skipif(not compiled.available(), reason="Numba is not installed")
each_method = pytest.mark.parametrize("method", METHODS, ids=lambda method: method.key)


@each_method
def test_it_gives_the_same_bits_before_and_after(method, monkeypatch):
    monkeypatch.setattr(unhurried, "COMPILED_FROM", 3_000)
    loops = unhurried.unhurried.__wrapped__(method)
    for n in (1_000, 1_000, 2_000, 500):
        start = (9.81, (2.0, 0.0), 0.05, n)
        assert loops.travel(*start) == plain(method).travel(*start)
        assert loops.advance(*start, math.inf) == plain(method).advance(*start, math.inf)


@needs_numba
def test_who_must_not_wait_goes_on_plain_until_another_thread_has_compiled(monkeypatch):
    method, release, used = METHODS[3], threading.Event(), []

    def slowly(method):
        release.wait(10)
        return plain(method)._replace(advance=lambda *start: used.append(start) or plain(method).advance(*start))

    monkeypatch.setattr(unhurried, "COMPILED_FROM", 10)
    monkeypatch.setattr(unhurried, "compiled", slowly)
    monkeypatch.setattr(unhurried, "_compiling", functools.cache(unhurried._compiling.__wrapped__))
    loops, start = unhurried.unhurried.__wrapped__(method), (9.81, (1.0, 0.0), 0.05, 20, math.inf)
    expected = plain(method).advance(*start)
    assert loops.advance(*start) == expected  # at once: `slowly` has not been let go
    assert not used
    release.set()
    unhurried._compiling(method).result(10)
    assert loops.advance(*start) == expected
    assert used[-1] == start
