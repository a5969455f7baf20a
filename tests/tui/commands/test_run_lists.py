"""Lists of runs: every combination, kept as they come, and resumed."""

import csv
import os
import signal
import subprocess
import time

import pytest

from recordings.library import hold
from tests.tui.command_line import pendu
from tests.tui.pty_lab import PENDU
from tui.commands.studies import lists

LIST = ("run", "--theta", "30deg,pi/2", "--h", "50ms:0.1:2", "--time", 2, "--methods", "verlet,rk4")


@pytest.fixture
def whole(tmp_path):
    """The bytes of a file with all rows of the list."""
    path = tmp_path / "whole.csv"
    assert pendu(*LIST, "-o", path).code == 0
    return path.read_bytes()


def rows(outcome):
    return list(csv.DictReader(outcome.out.splitlines()))


def test_every_combination_is_run_and_its_rows_are_those_of_a_single_run():
    found = rows(pendu(*LIST, "--csv"))
    starts = [(row["start_theta"], row["h"], row["method"]) for row in found]
    assert len(set(starts)) == len(starts) == 2 * 2 * 2
    (single,) = rows(
        pendu("run", "--theta", "90deg", "--h", 0.1, "--time", 2, "--methods", "rk4", "--csv")
    )
    assert single.items() <= found[-1].items()


def test_a_table_has_a_column_for_each_number_that_varies():
    head, *lines = pendu(*LIST).out.splitlines()
    assert head.split()[:3] == ["start_theta", "h", "method"]
    assert len(lines) == 8


def test_a_file_has_the_rows_of_stdout_and_nothing_else_is_left(whole, tmp_path):
    assert whole.decode() == pendu(*LIST, "--csv").out
    assert [each.name for each in tmp_path.iterdir()] == ["whole.csv"]


@pytest.mark.parametrize("cut", [0, 40, 600, 1500])
def test_what_was_interrupted_is_resumed_to_the_same_bytes(cut, whole, tmp_path):
    path = tmp_path / "some.csv"
    part = lists.partial_of(path)
    part.write_bytes(whole[:cut])
    assert pendu(*LIST, "-o", path).refused(5, "--resume", "--force")
    assert pendu(*LIST, "-o", path, "--resume").code == 0
    assert path.read_bytes() == whole
    assert not part.exists()


@pytest.mark.parametrize(
    "other", [("--time", 3), ("--h", "50ms:0.2:2"), ("--methods", "rk4"), ("--h", 0.05)]
)
def test_rows_of_other_arguments_are_not_resumed(other, whole, tmp_path):
    path = tmp_path / "some.csv"
    lists.partial_of(path).write_bytes(whole)
    assert pendu(*LIST, *other, "-o", path, "--resume").refused(2, "other arguments")
    assert lists.partial_of(path).read_bytes() == whole


def test_rows_that_other_code_computed_are_not_resumed(whole, tmp_path):
    path = tmp_path / "some.csv"
    lists.partial_of(path).write_bytes(
        whole.replace(b"bounded", b"chaotic").replace(b"early", b"late")
    )
    assert pendu(*LIST, "-o", path, "--resume").refused(2, "other numbers")


def test_a_file_that_somebody_writes_is_left_alone(tmp_path):
    path = tmp_path / "some.csv"
    with lists.partial_of(path).open("wb") as file:
        hold(file)
        assert pendu(*LIST, "-o", path, "--resume").refused(5, "another process")


@pytest.mark.slow
def test_ctrl_c_keeps_the_rows_that_are_done(tmp_path):
    path = tmp_path / "some.csv"
    part = lists.partial_of(path)
    endless = ["run", "--h", "0.05,0.1", "--time", "1e8", "--no-compiled", "-o", str(path)]
    short = ["run", "--h", "0.01:0.02:2000", "--time", "2", "-o", str(path)]
    for arguments in (short, endless):
        process = subprocess.Popen([*PENDU, *arguments], stderr=subprocess.PIPE, text=True)
        deadline = time.monotonic() + 60
        while not part.exists() or (arguments is short and part.stat().st_size < 2000):
            assert time.monotonic() < deadline
            time.sleep(0.02)
        time.sleep(0.5)
        os.kill(process.pid, signal.SIGINT)
        _, err = process.communicate(timeout=60)
        assert process.returncode == 130
        if arguments is short:
            assert "--resume goes on" in err
            assert part.read_bytes().endswith(b"\n")
            part.unlink()
        else:
            assert err == "pendu-tui: interrupted.\n"
    assert not list(tmp_path.iterdir())


def test_the_gate_is_that_of_every_run(tmp_path):
    path = tmp_path / "report.xml"
    check = ("--fail-if", "rk4.max_energy_error > 1e-4", "--junit", path)
    outcome = pendu(*LIST, *check)
    assert outcome.code == 1
    assert "in 2 of 4 runs, first at theta 0.523599, h 0.1" in outcome.err
    assert path.read_text().count("<failure") == 2


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--record", "x.mcap"), ("--record", "one run")),
        (("--resume",), ("-o FILE.csv",)),
        (("-o", "x.csv", "--resume", "--fail-if", "rk4.energy > 1"), ("leave out",)),
        (("--length", "1,1e9"), ("length",)),
        (("--h", "0.05,5"), ("--time 2", "5 s")),
    ],
)
def test_what_a_list_cannot_do_is_one_sentence(arguments, words):
    assert pendu(*LIST, *arguments).refused(2, *words)


@pytest.mark.slow
def test_a_step_that_does_not_end_ends_a_list_in_other_processes(tmp_path):
    lines = [
        "def endless(force, phase, h):",
        "    theta, omega = phase",
        "    for step in range(100_000):",
        "        omega = omega + h * force(theta)",
        "        theta = theta + h * omega",
        "        yield theta, omega",
        "    while True: pass",
    ]
    (tmp_path / "mine.py").write_text("\n".join(lines))
    own = ("--method", f"{tmp_path}/mine.py:endless", "--methods", "endless")
    outcome = pendu("run", *own, "--h", "0.001,0.002", "--time", 200, "--csv", "--workers", 2)
    assert outcome.refused(2, "line 7", "takes more than 3 s for a step")
