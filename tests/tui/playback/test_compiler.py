"""Loops that never keep the screen waiting."""

import functools
import math
import threading

import pytest

from pendu_tui.engine.run import loops
from pendu_tui.engine.run.loops import CompiledLoops, PlainLoops, available
from pendu_tui.engine.scenes import DEFAULT_SCENE
from pendu_tui.tui.playback import live


@pytest.mark.skipif(not available(), reason="Numba is not installed")
def test_loops_stay_plain_until_another_thread_has_compiled_them(monkeypatch):
    method, model = DEFAULT_SCENE.cast[3], DEFAULT_SCENE.equations
    start = (1.0, 0.0), 0.05, 20, math.inf
    release, used = threading.Event(), []
    plain = PlainLoops(method, model)

    def advance(*start):
        used.append(start)
        return plain.advance(*start)

    def slowly(method, model):
        release.wait(10)
        return CompiledLoops(plain.propagate, advance)

    monkeypatch.setattr(loops, "COMPILED_FROM", 10)
    monkeypatch.setattr(live, "compiled", slowly)
    monkeypatch.setattr(live, "_compiling", functools.cache(live._compiling.__wrapped__))
    tiered = live.compiled_in_background(method, model)
    expected = plain.advance(*start)
    assert tiered.advance(*start) == expected  # at once: `slowly` has not been let go
    assert not used
    release.set()
    live._compiling(method, model).result(10)
    assert tiered.advance(*start) == expected
    assert used[-1] == start
