"""Computing in another process, which does not outlive its reader."""

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

import pytest

from pendu_tui.tui.views.background import computed

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[3]


def forever() -> Iterator[int]:
    """The process that runs this, again and again."""
    while True:
        yield os.getpid()
        time.sleep(0.01)


def busy() -> Iterator[int]:
    for stream in (1, 2):
        os.write(stream, b"What nobody may read.")
    yield os.getpid()
    while True:
        pass


def ends(process: int) -> bool:
    """Whether it ends in time."""
    for _ in range(500):
        try:
            os.kill(process, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.01)
    return False


@pytest.mark.parametrize("function", [forever, busy])
async def test_a_task_that_is_cancelled_leaves_no_process_and_no_complaint(function, caplog):
    processes = []

    async def read() -> None:
        async for process in computed(function):
            processes.append(process)

    task = asyncio.create_task(read())
    while not processes:
        await asyncio.sleep(0.01)
    task.cancel()
    with pytest.raises(asyncio.CancelledError):
        await task
    assert ends(processes[0])
    await asyncio.sleep(0.05)
    gc.collect()
    assert not caplog.records


async def test_it_starts_where_stderr_has_no_file_number_and_is_deaf_to_ctrl_c(monkeypatch):
    tracker = "multiprocessing.resource_tracker._resource_tracker._fd"
    monkeypatch.setattr(tracker, None)  # or it has been started
    monkeypatch.setattr("sys.stderr", StringIO())
    monkeypatch.setattr("sys.stderr.fileno", lambda: -1)
    async with aclosing(computed(forever)) as found:
        process = await anext(found)
        assert process != os.getpid()
        os.kill(process, signal.SIGINT)
        assert [await anext(found) for _ in range(3)] == [process] * 3


READER = """
import asyncio
from tests.tui.views.test_background import busy
from pendu_tui.tui.views.background import computed

async def read():
    async for process in computed(busy):
        print(process, flush=True)

if __name__ == "__main__":
    asyncio.run(read())
"""


def test_no_process_outlives_a_reader_that_is_killed(tmp_path):
    (tmp_path / "reader.py").write_text(READER)
    with subprocess.Popen(
        [sys.executable, tmp_path / "reader.py"],
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as reader:
        first = reader.stdout.readline()
        reader.kill()
        assert ends(int(first))
        assert reader.stderr.read() == ""
