"""A small part of tests/bench/signals.py: no signal leaves a lab that hangs."""

import random
import signal

import pytest

from tests.bench.signals import STOPS, ends, survives

pytestmark = pytest.mark.slow


def test_a_lab_lives_on_after_a_storm_of_signals():
    counts = survives(20, STOPS, (signal.SIGCONT,))
    assert (counts["alive"], counts["exit_0"], counts["verified"]) == (1, 1, 1)


@pytest.mark.parametrize("closed", [False, True])
def test_a_lab_ends_though_it_was_stopped_and_its_recording_verifies(closed):
    counts = ends(random.Random(4), closed=closed)
    assert (counts["still_there"], counts["late"], counts["unfinished"]) == (0, 0, 0)
    assert counts["verified"] == 1
