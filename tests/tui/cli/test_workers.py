"""Where tasks run: the answers are the same, and those that are there are kept."""

import argparse
import os
import sys
import time
from itertools import repeat
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import Mock

import pytest

from pendu_tui.engine.methods.own import OwnMethodError
from pendu_tui.tui.cli import workers
from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.workers import Work, received, work_of
from tests.tui.command_line import pendu

STABILITY = ("stability", "--steps", 300, "--z-values", "0.1:3:12", "--theta-values", "0.5,2")
RUNS = ("run", "--theta", "10deg:170deg:3", "--h", "0.05,0.1", "--time", 2)


def test_the_answer_is_the_same_to_the_bit_in_other_processes():
    assert pendu(*RUNS, "--csv", "--workers", 2).out == pendu(*RUNS, "--csv").out


def interrupted(error: BaseException, done: int, output: Path | None = None) -> Work:
    options = argparse.Namespace(workers=1, dask=None, output=output)
    with work_of(options, "runs", 3) as work:
        work.show = Mock()
        work.step(done)
        work.show.assert_called_once_with(done, 3)
        raise error
    return work


@pytest.mark.parametrize(
    ("error", "code", "why"),
    [
        (KeyboardInterrupt(), 130, "interrupted"),
        (OwnMethodError("mine fails."), 3, "mine fails"),
        (UserError("lost.", Exit.INPUT_UNREADABLE), 3, "lost"),
    ],
)
def test_what_is_done_before_an_error_is_kept_unless_a_file_is_there(
    error, code, why, tmp_path, capsys
):
    assert interrupted(error, done=1).conclude() == code
    assert interrupted(error, done=1, output=tmp_path / "new.csv").conclude() == code
    assert capsys.readouterr().err.endswith(f" {why}: 33 % of the runs are done and kept.\n")
    with pytest.raises(type(error)):
        interrupted(error, done=0)
    older = tmp_path / "older.csv"
    older.touch()
    with pytest.raises(UserError, match="is unchanged") as kept:
        interrupted(error, done=1, output=older)
    assert kept.value.code == 130


class Lost:
    """A pool of processes that are lost."""

    def __init__(self, count, *_):
        self.count = count

    def submit(self, *_):
        raise RuntimeError(f"the last of {self.count}.")

    def shutdown(self, wait=True):
        assert wait


def test_workers_are_at_most_four_a_processor_and_to_lose_them_is_an_error(monkeypatch):
    monkeypatch.setattr(workers, "ProcessPoolExecutor", Lost)
    child = SimpleNamespace(terminate=lambda: ended.append("one"))
    ended = []
    monkeypatch.setattr(workers, "active_children", lambda: [child])
    for asked, processors, count in ((2, 3, 2), (99, 3, 12), (99, 64, 61), (99, None, 4)):
        monkeypatch.setattr(os, "cpu_count", repeat(processors).__next__)
        outcome = pendu(*RUNS, "--workers", asked)
        assert outcome.refused(3, f"the workers are lost (RuntimeError: the last of {count}).")
    assert ended == ["one"] * 4
    assert os.environ["PYTHONSAFEPATH"] == "1"
    monkeypatch.setattr(Lost, "submit", Mock(side_effect=OwnMethodError("mine fails.")))
    assert pendu(*RUNS, "--workers", 2).refused(3, "pendu-tui: mine fails.")
    assert pendu(*RUNS, "--workers", 1).code == 0


@pytest.mark.filterwarnings("error")  # of a thread that fails
def test_an_interrupt_ends_the_workers_also_while_tasks_wait():
    options = argparse.Namespace(workers=2, dask=None, output=None)
    with work_of(options, "runs", 9) as work:
        work.step()
        for _ in work.run(time.sleep, [0.0, *[60.0] * 8]):
            raise KeyboardInterrupt
    assert work.conclude() == 130


@pytest.mark.slow
def test_so_it_is_on_a_dask_cluster(monkeypatch):
    monkeypatch.setattr("pendu_tui.engine.studies.stability.PART", 6)
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, host="127.0.0.1", dashboard_address=None
    ) as cluster:
        for command in ((*STABILITY, "--csv"), (*RUNS, "--csv")):
            there = pendu(*command, "--dask", cluster.scheduler_address)
            assert there.out == pendu(*command).out


def test_dask_without_its_package_says_what_to_install(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert pendu(*RUNS, "--dask", "tcp://127.0.0.1:1").refused(2, "pendu-tui[cluster]")


def test_what_a_process_sends_is_awaited_and_its_errors_are_raised(monkeypatch):
    sent = iter(["done", OwnMethodError("mine fails.")])
    here = SimpleNamespace(recv=sent.__next__)
    process = SimpleNamespace(sentinel="ended")
    ready = iter([[], ["ended"], [here], [here]])
    waits = []

    def wait(_, seconds):
        waits.append(seconds)
        return next(ready)

    monkeypatch.setattr(workers, "wait", wait)
    for error in (TimeoutError, EOFError):
        with pytest.raises(error):
            received(here, process, 3.0)
    assert received(here, process) == "done"
    with pytest.raises(OwnMethodError):
        received(here, process)
    assert waits == [3.0, 3.0, None, None]
