"""Loops that never keep the screen waiting."""

import functools
import math
import threading

import pytest

from engine.methods import METHODS
from engine.run import compiled
from engine.run.loops import plain
from tui.playback import compiler


@pytest.mark.skipif(not compiled.available(), reason="Numba is not installed")
def test_loops_stay_plain_until_another_thread_has_compiled_them(monkeypatch):
    method, release, used = METHODS[3], threading.Event(), []

    def slowly(method):
        release.wait(10)
        return plain(method)._replace(advance=lambda *start: used.append(start) or plain(method).advance(*start))

    monkeypatch.setattr(compiled, "COMPILED_FROM", 10)
    monkeypatch.setattr(compiler, "compiled", slowly)
    monkeypatch.setattr(compiler, "_compiling", functools.cache(compiler._compiling.__wrapped__))
    loops, start = compiler.patient(method), (9.81, (1.0, 0.0), 0.05, 20, math.inf)
    expected = plain(method).advance(*start)
    assert loops.advance(*start) == expected  # at once: `slowly` has not been let go
    assert not used
    release.set()
    compiler._compiling(method).result(10)
    assert loops.advance(*start) == expected
    assert used[-1] == start
