"""A small part of tests/bench/signals.py: no signal leaves a lab that hangs."""

import random
import signal

import pytest

from tests.bench.signals import STOPS, ends, survives

pytestmark = pytest.mark.slow

CONTINUE = (signal.SIGCONT,)


@pytest.mark.parametrize("kinds", [[CONTINUE], [STOPS, CONTINUE]], ids=["continue", "stop"])
def test_a_lab_lives_on_after_a_storm_of_signals(kinds):
    counts = survives(40, *kinds)
    assert (counts["alive"], counts["exit_0"], counts["verified"]) == (1, 1, 1)


@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("seed", range(3))
def test_a_lab_ends_though_it_was_stopped_and_its_recording_verifies(seed, closed):
    counts = ends(random.Random(seed), closed=closed)
    assert (counts["still_there"], counts["late"], counts["unfinished"]) == (0, 0, 0)
    assert counts["verified"] == 1
