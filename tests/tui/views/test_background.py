"""Computing in another process, which neither outlives its reader nor runs what lies in the current folder."""

import asyncio
import gc
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import aclosing
from io import StringIO
from pathlib import Path

import numpy as np
import pytest

from engine.stability.grid import Grid, pieces
from tui.views.background import computed

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[3]
GRID = Grid(np.array([0.5, 1.5, 2.5]), np.linspace(0.2, 3, 14), 100)


def forever() -> Iterator[int]:
    """The process that runs this, again and again."""
    while True:
        yield os.getpid()
        time.sleep(0.01)


def busy() -> Iterator[int]:
    yield os.getpid()
    while True:
        pass


def is_alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


def ends(process: int) -> bool:
    """Whether it ends in time."""
    for _ in range(500):
        if not is_alive(process):
            return True
        time.sleep(0.01)
    return False


async def test_the_pieces_of_a_map_make_the_map():
    cells = GRID.unknown()
    async for piece in computed(pieces, GRID, (10, 100), 5):
        cells[piece.z, piece.method] = piece.cells
    assert cells.tobytes() == GRID.cells().tobytes()


def test_a_first_map_is_complete_before_the_final_one_begins():
    progress = [(piece.steps, piece.done) for piece in pieces(GRID, (10, 100), 5)]
    assert progress == sorted(progress)
    assert [done for steps, done in progress if steps == 10][-1] == 1


@pytest.mark.parametrize("function", [forever, busy])
async def test_a_task_that_is_cancelled_leaves_no_process_and_no_complaint(function, caplog):
    processes = []

    async def read() -> None:
        async for process in computed(function):
            processes.append(process)

    task = asyncio.create_task(read())
    while not processes:
        await asyncio.sleep(0.01)
    assert os.getpid() not in processes
    task.cancel()
    with pytest.raises(asyncio.CancelledError):
        await task
    assert not is_alive(processes[0])
    await asyncio.sleep(0.05)
    gc.collect()
    assert not caplog.records


async def test_it_starts_where_stderr_has_no_file_number(monkeypatch):
    monkeypatch.setattr(
        "multiprocessing.resource_tracker._resource_tracker._fd", None
    )  # or it has been started
    monkeypatch.setattr("sys.stderr", StringIO())
    monkeypatch.setattr("sys.stderr.fileno", lambda: -1)
    async with aclosing(computed(forever)) as found:
        assert await anext(found) != os.getpid()


async def test_the_process_is_deaf_to_ctrl_c():
    async with aclosing(computed(forever)) as found:
        process = await anext(found)
        os.kill(process, signal.SIGINT)
        assert [await anext(found) for _ in range(3)] == [process] * 3


async def test_a_computation_that_fails_or_is_killed_is_an_error_here():
    async with aclosing(computed(forever)) as found:
        os.kill(await anext(found), signal.SIGKILL)
        with pytest.raises(Exception, match="has ended"):
            await anext(found)


READER = """
import asyncio
from tests.tui.views.test_background import busy
from tui.views.background import computed

async def read():
    async for process in computed(busy):
        print(process, flush=True)

if __name__ == "__main__":
    asyncio.run(read())
"""


def test_no_process_outlives_a_reader_that_is_killed_and_no_module_of_the_current_folder_is_run(
    tmp_path,
):
    here, scripts = tmp_path / "here", tmp_path / "scripts"
    for folder in (here, here / "tui", scripts):
        folder.mkdir()
    for name in (
        "pickle.py",
        "numpy.py",
        "multiprocessing.py",
        "tui/__init__.py",
        "sitecustomize.py",
    ):
        (here / name).write_text(f"open({str(here / 'marker')!r}, 'w').write({name!r})\n")
    (scripts / "reader.py").write_text(READER)
    command = [sys.executable, str(scripts / "reader.py")]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    with subprocess.Popen(
        command,
        cwd=here,
        env=environment,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as reader:
        worker = int(reader.stdout.readline())
        assert is_alive(worker)
        reader.kill()
        assert ends(worker)
        assert reader.stderr.read() == ""
    assert not (here / "marker").exists()
