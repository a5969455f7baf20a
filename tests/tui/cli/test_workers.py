"""Where tasks run: the answers are the same."""

import argparse
import os
import signal
import sys
import time
from contextlib import nullcontext

import pytest

from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.workers import received, started, workers_of
from tests.tui.command_line import pendu

STABILITY = ("stability", "--steps", 300, "--z-values", "0.1:3:12", "--theta-values", "0.5,2")
RUNS = ("run", "--theta", "10deg:170deg:3", "--h", "0.05,0.1", "--time", 2)


@pytest.fixture
def small_parts(monkeypatch):
    monkeypatch.setattr("pendu_tui.engine.studies.stability.PART", 6)


def test_the_answer_is_the_same_to_the_bit_in_other_processes():
    assert pendu(*RUNS, "--csv", "--workers", 2).out == pendu(*RUNS, "--csv").out


LOST = UserError("the workers are lost.", Exit.INPUT_UNREADABLE)
ACCURACY = ("accuracy", "--time", 5, "--h-values", "0.2:0.05:3")


@pytest.mark.parametrize(("error", "code"), [(KeyboardInterrupt(), 130), (LOST, 3)], ids=str)
@pytest.mark.parametrize(
    ("command", "rows", "share"),
    [(RUNS, 4, "17 % of the runs"), (STABILITY, 6, "6 % of the swings"), (ACCURACY, 1, "4 % of")],
    ids=lambda value: value[0] if isinstance(value, tuple) else "",
)
def test_an_interrupt_and_lost_workers_keep_what_is_done(
    monkeypatch, tmp_path, small_parts, command, rows, share, error, code
):
    def run(function, tasks):
        yield function(next(iter(tasks)))
        raise error

    monkeypatch.setattr("pendu_tui.tui.cli.workers.workers_of", lambda _: nullcontext(run))
    outcome = pendu(*command, "--csv")
    assert (outcome.code, outcome.out.count("\n")) == (code, 1 + rows)
    assert share in outcome.err
    assert pendu(*command, "--json").json["interrupted"]
    older = tmp_path / "older.csv"
    older.write_text("precious", encoding="utf-8")
    assert pendu(*command, "-o", older, "--force").refused(130, "stays as it was")
    assert older.read_text(encoding="utf-8") == "precious"


@pytest.mark.slow
def test_so_it_is_on_a_dask_cluster(small_parts):
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, host="127.0.0.1", dashboard_address=None
    ) as cluster:
        for command in ((*STABILITY, "--csv"), (*RUNS, "--csv")):
            there = pendu(*command, "--dask", cluster.scheduler_address)
            assert there.out == pendu(*command).out


def die(number: int) -> int:
    os.kill(os.getpid(), signal.SIGKILL)
    return number


@pytest.mark.slow
def test_workers_that_die_are_lost():
    options = argparse.Namespace(workers=2, dask=None)
    with workers_of(options) as run, pytest.raises(UserError, match="lost") as lost:
        list(run(die, [1]))
    assert lost.value.code == Exit.INPUT_UNREADABLE


def test_there_are_workers_or_a_cluster():
    assert pendu(*RUNS, "--workers", "2", "--dask", "tcp://x:1").refused(2, "not allowed")


def test_dask_without_its_package_says_what_to_install(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert pendu(*RUNS, "--dask", "tcp://127.0.0.1:1").refused(2, "pendu-tui[cluster]")


def silent(there):
    time.sleep(5)


def test_a_process_is_awaited_for_so_long():
    process, here = started(silent)
    with pytest.raises(TimeoutError):
        received(here, process, 0.2)
    process.terminate()
