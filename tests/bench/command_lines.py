"""Random command lines: none may leave a traceback, or a code that is not in the table.

    python -m tests.bench.command_lines [N] [SEED]

Each runs in a child process of its own, in an empty folder, for at most 15 s.
"""

import os
import random
import select
import signal
import sys
import tempfile
import traceback
from collections import Counter
from pathlib import Path
from typing import Any

from engine.methods import METHODS
from engine.scenes import SCENES
from recordings.library import GOLDEN
from tui.cli.dispatch import COMMANDS, RENAMED, command_of, main
from tui.cli.errors import Exit

SECONDS = 15  # until it is ended
TRACEBACK, SLOW = 99, -1
VALUES = [
    *(
        "",
        "--",
        "-",
        "-1",
        "0",
        "1",
        "2",
        "5",
        "1e-3",
        "-1e-3",
        "0.05",
        "1e9",
        "1e308",
        "1e400",
        "nan",
        "inf",
        "-inf",
    ),
    *(
        "9" * 400,
        "0x10",
        "1_000",
        "٣",
        "½",
        "\ud800",
        "\x1b[31m",
        "\x00"[:0],
        "θ",
        "a b",
        "'",
        "1,2",
        "0.1:3:5",
        ":::",
    ),
    *(
        "120deg",
        "2rad",
        "90°",
        "pi/2",
        "5s",
        "latest",
        "drift",
        "golden",
        "absent.mcap",
        "whole.mcap",
        "cut.mcap",
    ),
    *(
        "scene.toml",
        "bom.toml",
        "digits.toml",
        "zero.toml",
        "mine.py:mine",
        "mine.py:other",
        "mine.py",
        "energies.csv",
    ),
    *(
        "out.csv",
        "out.json",
        "out.npz",
        "out.svg",
        "out.pdf",
        "absent/out.csv",
        ".",
        "/",
        "/dev/null",
        "80x24",
        "3x3",
    ),
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
    "--method": "mine.py:mine",
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
MINE = """def mine(force, phase, h):
    theta, omega = phase
    while True:
        theta, omega = theta + h * omega, omega + h * force(theta)
        yield theta, omega
"""


def prepare() -> None:
    whole = (GOLDEN / "drift.mcap").read_bytes()
    Path("whole.mcap").write_bytes(whole)
    Path("cut.mcap").write_bytes(whole[: len(whole) // 2])
    Path("scene.toml").write_text("theta = 0.5\n")
    Path("bom.toml").write_text("\ufefftheta = '30deg'\n", encoding="utf-8")
    Path("digits.toml").write_text(f"theta = {'9' * 5000}\n")
    Path("zero.toml").write_bytes(bytes(1000))
    Path("mine.py").write_text(MINE)
    Path("energies.csv").write_text("t,E\n" + "".join(f"{n},{10 + n % 2}\n" for n in range(200)))


def arguments(rng: random.Random, options: dict[str, list[Any]]) -> list[str]:
    name = rng.choice([*COMMANDS, *COMMANDS, *COMMANDS, *RENAMED, *VALUES])
    words = [name] * (rng.random() < 0.9)
    for _ in range(rng.choice([0, 1, 1, 2, 3])):
        option = rng.choice(options.get(name) or options["live"])
        value = FITTING.get(option, "drift") if rng.random() < 0.6 else rng.choice(VALUES)
        words += rng.choice([[option, value], [f"{option}={value}"], [option], [value]])
    return [word for word in words if word != "serve"]


def outcome(words: list[str]) -> tuple[int, str]:
    """The exit code of a command line, or TRACEBACK with its text, or SLOW."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        null = os.open(os.devnull, os.O_RDWR)
        for number in (0, 1, 2):
            os.dup2(null, number)
        try:
            code = main(words)
        except BaseException:
            os.write(writing, traceback.format_exc()[-3000:].encode(errors="replace"))
            code = TRACEBACK
        os._exit(code)
    os.close(writing)
    if not select.select([reading], [], [], SECONDS)[0]:
        os.kill(child, signal.SIGKILL)  # a lab that prints sentences, for example
    with os.fdopen(reading, errors="replace") as pipe:
        text = pipe.read()
    _, status = os.waitpid(child, 0)
    return (SLOW if os.WIFSIGNALED(status) else os.WEXITSTATUS(status)), text


def bench(number: int, seed: int) -> None:
    rng = random.Random(seed)
    options = {}
    for name in COMMANDS:
        parser, _ = command_of(name)
        options[name] = [text for action in parser._actions for text in action.option_strings]
    codes: Counter[int] = Counter()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        prepare()
        homes = ["library", "~nosuch/x", "whole.mcap"]
        for _ in range(number):
            os.environ["PENDU_RECORDINGS"] = rng.choice(homes)
            words = arguments(rng, options)
            code, text = outcome(words)
            codes[code] += 1
            if code not in {SLOW, *Exit}:
                print(f"{words!r} in {os.environ['PENDU_RECORDINGS']}: {code}\n{text}")
        os.chdir("/")
    print(
        ", ".join(
            f"{'slow' if code == SLOW else code}: {times}" for code, times in sorted(codes.items())
        )
    )


if __name__ == "__main__":
    bench(int((sys.argv[1:] or ["1600"])[0]), int((sys.argv[2:] or ["1"])[0]))
