"""`pendu-tui tour` as one uses it: on a terminal, and with a pipe in its place."""

import signal

import pytest

from recordings.library import listing
from recordings.verification import verify
from tests.tui.commands.test_plain import read_until, started
from tests.tui.pty_lab import PtyLab


@pytest.mark.slow
def test_in_plain_it_asks_when_the_moment_has_come_and_records_as_the_lab_does(tmp_path):
    with started(tmp_path, "tour", "--plain") as process:
        lines = read_until(process, "Question: Nothing pushes this pendulum.")
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=30)
    assert (process.returncode, err) == (0, "")
    assert lines[0].startswith("Tour 1 of 8: who gains. ")
    assert "Explicit Euler went over the top" in lines[1]
    (item,) = listing(tmp_path)
    assert f"saved {item.path}" in out
    report = verify(item.path)
    assert (report.identical, report.complete) == (True, True)


def test_on_a_terminal_it_is_walked_with_enter_and_left_with_esc_and_nothing_is_recorded_if_not_wanted(
    tmp_path,
):
    with PtyLab("tour", "--no-record", PENDU_RECORDINGS=str(tmp_path)) as session:
        session.wait_for("Tour 1 of 8")
        session.type("\r")
        session.wait_for("five times its initial energy")
        session.type("\x1b")
        session.wait_for("T goes on with the tour")
        session.type("q")
        assert session.end() == 0
    assert not list(tmp_path.iterdir())
