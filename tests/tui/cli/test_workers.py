"""Where tasks run: the answers are the same, and workers may die."""

import argparse
import os
import signal
import sys
from functools import partial
from pathlib import Path

import pytest

from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.workers import workers_of
from tests.tui.command_line import pendu

STABILITY = ("stability", "--steps", 300, "--z-values", "0.1:3:12", "--theta-values", "0.5,2")
RUNS = ("run", "--theta", "10deg:170deg:3", "--h", "0.05,0.1", "--time", 20)


@pytest.fixture
def small_parts(monkeypatch):
    monkeypatch.setattr("pendu_tui.engine.stability.grid.PART", 6)


@pytest.mark.parametrize("command", [(*STABILITY, "--csv"), (*RUNS, "--csv")])
@pytest.mark.parametrize(
    "where",
    [("--workers", 2), ("--executor", "concurrent.futures:ThreadPoolExecutor")],
    ids=lambda where: where[0],
)
def test_the_answer_is_the_same_to_the_bit_whatever_computes_it(where, command, small_parts):
    assert pendu(*command, *where).out == pendu(*command).out


@pytest.mark.slow
def test_so_it_is_on_a_dask_cluster(small_parts):
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, host="127.0.0.1", dashboard_address=None
    ) as cluster:
        for command in ((*STABILITY, "--csv"), (*RUNS, "--csv")):
            there = pendu(*command, "--dask", cluster.scheduler_address)
            assert there.out == pendu(*command).out


def square(number: int) -> int:
    return number * number


def square_or_die(number: int, folder: str) -> int:
    """Return the square; the first process that is asked for that of 7 is killed."""
    mark = Path(folder) / "died"
    if number == 7 and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return square(number)


def workers(**options):
    given = {"workers": 1, "dask": None, "executor": None} | options
    return workers_of(argparse.Namespace(**given))


@pytest.mark.slow
def test_a_worker_that_is_killed_costs_nothing_but_time(tmp_path):
    with workers(workers=2) as two:
        found = list(two.map(partial(square_or_die, folder=str(tmp_path)), range(20)))
    assert found == [number * number for number in range(20)]


def die(number: int) -> int:
    os.kill(os.getpid(), signal.SIGKILL)
    return number


@pytest.mark.slow
def test_workers_that_die_again_and_again_are_lost():
    with workers(workers=2) as two, pytest.raises(UserError, match="lost") as lost:
        list(two.map(die, [1]))
    assert lost.value.code == Exit.INPUT_UNREADABLE


def test_many_more_tasks_than_are_handed_out_at_once_stay_in_order(monkeypatch):
    monkeypatch.setattr("pendu_tui.tui.cli.workers.MAX_AHEAD", 3)
    with workers(executor="concurrent.futures:ThreadPoolExecutor") as threads:
        assert list(threads.map(square, range(50))) == [number * number for number in range(50)]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--workers", "2", "--dask", "tcp://x:1"), ("not allowed",)),
        (("--executor", "nothing"), ("MODULE:CALLABLE",)),
        (("--executor", "math:sin"), ("math:sin",)),
        (("--executor", "builtins:dict"), ("returns a dict",)),
    ],
)
def test_what_is_no_executor_is_one_sentence(arguments, words):
    assert pendu(*RUNS, *arguments).refused(2, *words)


def test_dask_without_its_package_says_what_to_install(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert pendu(*RUNS, "--dask", "tcp://127.0.0.1:1").refused(2, "pendu-tui[cluster]")
