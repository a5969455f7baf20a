"""Processor time and peak memory of every command that reads a hostile file."""

import os
import subprocess
import sys
from multiprocessing import get_context
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from tests.recordings.hostile import FILES, write_file

LIMITS = {"processor_seconds": 10.0, "memory_mb": 200, "largest_exit_code": 3}
COMMANDS = (
    ("verify",),
    ("recordings", "show"),
    ("recordings", "recover", "-o", "out.mcap", "--force"),
    ("export", "-o", "out.csv", "--force"),
)


def measure(share: float) -> dict[str, Any]:
    worst: dict[str, Any] = dict.fromkeys(LIMITS, 0)
    with TemporaryDirectory() as folder:
        for name in FILES:
            path = Path(folder) / "hostile.mcap"
            arguments = (path, name, round(90_000 * share))
            # In another process, as commands inherit the peak memory of this one.
            writer = get_context("spawn").Process(target=write_file, args=arguments)
            writer.start()
            writer.join()
            for command in COMMANDS:
                program = [sys.executable, "-m", "pendu_tui.tui", *command, str(path)]
                quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
                process = subprocess.Popen(program, cwd=folder, **quiet)
                _, status, usage = os.wait4(process.pid, 0)
                figures = {
                    "processor_seconds": round(usage.ru_utime + usage.ru_stime, 2),
                    "memory_mb": round(usage.ru_maxrss / 1000),
                    "largest_exit_code": abs(os.waitstatus_to_exitcode(status)),
                }
                worst = {key: max(worst[key], value) for key, value in figures.items()}
    return {"cases": len(FILES) * len(COMMANDS), **worst}
