"""Random command lines: none leaves a traceback, or an exit code that is not in the table."""

import os
import random
import subprocess
import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from engine.methods import METHODS
from engine.scenes import SCENES
from recordings.library import GOLDEN
from tests.tui.command_line import own_method
from tui.cli.dispatch import COMMANDS, RENAMED, command_of
from tui.cli.errors import Exit

LIMITS = {"failed": 0}
MAX_SECONDS = 15  # then a command is ended: a lab that prints sentences, for example
WORDS = """
-- - -1 0 1 2 5 1e-3 -1e-3 0.05 1e9 1e308 1e400 nan inf -inf 0x10 1_000 ٣ ½ θ ' 1,2 0.1:3:5 :::
120deg 2rad 90° pi/2 5s latest drift golden absent.mcap whole.mcap cut.mcap scene.toml bom.toml
digits.toml zero.toml mine.py energies.csv out.csv out.json out.npz out.svg out.pdf absent/out.csv
. / /dev/null 80x24 3x3
"""
VALUES = [
    *WORDS.split(),
    *("", "a b", "9" * 400, "\udcff", "\x1b[31m", "my methods.py:mine", "my methods.py:other"),
    *(method.key for method in METHODS[:4]),
    *list(SCENES)[:4],
]
FITTING = {  # an option's value that works, next to any of VALUES
    "--time": "2",
    "--h": "0.1",
    "--theta": "90deg",
    "--omega": "-1",
    "--methods": "rk4,verlet",
    "--scene": "spin",
    "--method": "my methods.py:mine",
    "--steps": "20",
    "--z-values": "0.5,2.5",
    "--theta-values": "1",
    "--target": "1e-2",
    "--h-values": "0.1:0.01:3",
    "-o": "out.csv",
    "--output": "out.json",
    "--record": "new.mcap",
    "--starts": "9",
    "--energy": "E",
    "--size": "80x24",
    "--fail-if": "rk4.max_energy_error > 1",
    "--budget": "1000",
}


def prepare(folder: Path) -> None:
    """Write the files that VALUES name."""
    whole = (GOLDEN / "drift.mcap").read_bytes()
    (folder / "whole.mcap").write_bytes(whole)
    (folder / "cut.mcap").write_bytes(whole[: len(whole) // 2])
    (folder / "scene.toml").write_text("theta = 0.5\n")
    (folder / "bom.toml").write_text("\ufefftheta = '30deg'\n", encoding="utf-8")
    (folder / "digits.toml").write_text(f"theta = {'9' * 5000}\n")
    (folder / "zero.toml").write_bytes(bytes(1000))
    rows = [f"{n},{10 + n % 2}\n" for n in range(200)]
    (folder / "energies.csv").write_text("t,E\n" + "".join(rows))
    own_method(folder)


def command_line(chance: random.Random) -> list[str]:
    name = chance.choice([*COMMANDS, *COMMANDS, *COMMANDS, *RENAMED, *VALUES])
    parser, _ = command_of(name if name in COMMANDS else "live")
    options = [text for action in parser._actions for text in action.option_strings]
    words = [name]
    for _ in range(chance.choice([0, 1, 1, 2, 3])):
        option = chance.choice(options)
        value = FITTING.get(option, "drift")
        if chance.random() < 0.4:
            value = chance.choice(VALUES)
        words += chance.choice([[option, value], [f"{option}={value}"], [option], [value]])
    return [word for word in words if word != "serve"]


def exit_code(words: list[str], folder: Path, library: str) -> int | None:
    """Run a command; return its exit code, or None where it took too long."""
    try:
        done = subprocess.run(
            [sys.executable, "-m", "tui", *words],
            cwd=folder,
            env={**os.environ, "PENDU_RECORDINGS": library},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=MAX_SECONDS,
        )
    except subprocess.TimeoutExpired:
        return None
    if b"Traceback" in done.stderr or done.returncode not in set(Exit):
        print(f"{words!r} in {library}: {done.returncode}\n{done.stderr!r}", file=sys.stderr)
        return -1
    return done.returncode


def measure(share: float) -> dict[str, Any]:
    chance = random.Random(1)
    count = round(1600 * share)
    lines = [command_line(chance) for _ in range(count)]
    libraries = chance.choices(["library", "~nosuch/x", "whole.mcap"], k=count)
    with TemporaryDirectory() as folder, ThreadPoolExecutor(2) as pool:
        prepare(Path(folder))
        outcomes = pool.map(exit_code, lines, [Path(folder)] * count, libraries)
        codes = Counter(outcomes)
    return {"failed": codes.pop(-1, 0), "slow": codes.pop(None, 0), "exit_codes": dict(codes)}
