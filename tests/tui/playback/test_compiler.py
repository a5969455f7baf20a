"""Loops that never keep the screen waiting."""

import functools
import math
import threading

import pytest

from engine.run import compiled
from engine.run.loops import PlainLoops
from engine.scenes import DEFAULT_SCENE
from tui.playback import compiler


@pytest.mark.skipif(not compiled.available(), reason="Numba is not installed")
def test_loops_stay_plain_until_another_thread_has_compiled_them(monkeypatch):
    scene, release, used = DEFAULT_SCENE, threading.Event(), []

    method, model = scene.cast[3], scene.equations
    slow = PlainLoops(method, model)

    def slowly(method, model):
        release.wait(10)
        return compiled.CompiledLoops(
            slow.propagate, lambda *start: used.append(start) or slow.advance(*start)
        )

    monkeypatch.setattr(compiled, "COMPILED_FROM", 10)
    monkeypatch.setattr(compiler, "compiled", slowly)
    monkeypatch.setattr(compiler, "_compiling", functools.cache(compiler._compiling.__wrapped__))
    loops, start = compiler.compiled_in_background(method, model), ((1.0, 0.0), 0.05, 20, math.inf)
    expected = slow.advance(*start)
    assert loops.advance(*start) == expected  # at once: `slowly` has not been let go
    assert not used
    release.set()
    compiler._compiling(method, model).result(10)
    assert loops.advance(*start) == expected
    assert used[-1] == start
