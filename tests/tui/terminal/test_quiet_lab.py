"""Where nothing changes, nothing is sent."""

import pytest

from tests.tui.pty_lab import PtyLab

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("arguments", [("live", "--no-record"), ("replay", "drift")])
def test_a_paused_program_sends_no_byte(arguments):
    with PtyLab(*arguments) as lab:
        lab.wait_for("running")
        lab.run(1.0)
        lab.type(" ")
        lab.wait_for("paused")
        for _ in range(10):  # until the last chart is there, and a hint that is due
            sent = len(lab.output)
            lab.run(1.4)
            if len(lab.output) == sent:
                break
        assert len(lab.output) == sent
        lab.type(" ")
        lab.wait_for("running")
        lab.type("q")
        assert lab.end() == 0
