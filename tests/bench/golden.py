"""Write down what the program says, so that a move can be seen to change nothing.

python -m tests.bench golden OUT             write one file for each command line, picture and recording
python -m tests.bench golden OUT --compare   say the same again and print what differs, line by line

Wall times, dates, versions, paths and the size of the terminal are masked.  It is a tool for a
change, not a stored test: freeze the program before a move, compare after it.
"""

import asyncio
import difflib
import os
import re
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.cli.dispatch import COMMANDS
from tests.tui.command_line import own_method

ROOT = Path(__file__).resolve().parent.parent.parent
PROCESSES = os.cpu_count() or 1

COMMAND_LINES = [
    "--help",
    *(f"{command} --help" for command in COMMANDS),
    *(f"run {scene} --time 20" for scene in SCENES),
    "run --time 60 --json",
    "run --time 60 --methods rk4,verlet,heun --csv",
    "run --theta 10deg:170deg:5 --h 0.01:0.5:4 --time 5 --csv",
    "run --time 5 --workers 2 --theta 1,2 --json",
    "run --time 10 --method 'my methods.py:mine' --methods rk4",
    "run --time 60 --fail-if 'rk4.max_energy_error > 1e-9'",
    "run --time 10 --record made.mcap",
    "run --time 10 --scene scene.toml",
    "live --plain --time 3 --no-record",
    "accuracy --time 5",
    "accuracy --time 5 --json",
    "accuracy --time 5 --error energy --csv",
    "accuracy --target 1e-3 --time 5",
    "accuracy --target 1e-6 --time 5 --methods verlet,bm4 --json",
    "stability --theta 1 --z-values 0.5:3:12 --steps 300",
    "stability --theta 2 --z-values 0.5:3:12 --steps 300 --json",
    "stability --map --theta-values 0.5,2 --z-values 0.5:3:6 --steps 100 --csv",
    "methods",
    "methods rk4",
    "methods --json",
    "methods --method 'my methods.py:mine'",
    "scenes",
    "scenes crossover",
    "scenes --json",
    "judge energy.csv --time t --energy E",
    "judge energy.csv --time t --energy E --json",
    "judge fine.csv energy.csv --steps 1,2 --time t --energy E",
    "judge energy.csv --time t --energy E --scale std --fail-if 'verdict != bounded'",
    "verify golden",
    "verify golden --json",
    "export drift",
    "export spin -o spin.csv",
    "recordings",
    "recordings show drift",
    "recordings show drift --json",
    "replay --plain drift",
    "snapshot --time 3 --size 80x24 -o lab.svg",
    "tour --plain",
    "--print-completion bash",
    # wrong input
    "rum",
    "run",
    "run nowhere --time 1",
    "run --time -1",
    "run --time 1 --h 0",
    "run --time 1 --theta east",
    "run --time 1 --methods rk5",
    "run --time 1 --fail-if 'rk4.speed > 1'",
    "run --time 1 --scene broken.toml",
    "run --time 1 --method 'my methods.py:other'",
    "run --time 1 --record energy.csv",
    "run --time 1 -o energy.csv",
    "accuracy --target 10",
    "accuracy -o table.xyz",
    "stability --z-values 3:1:x",
    "judge absent.csv --time t --energy E",
    "judge energy.csv --time t --energy F",
    "judge energy.csv --time t --energy E --fail-if verdict",
    "verify energy.csv",
    "export nothing",
    "recordings show nothing",
    "recordings frobnicate",
    "snapshot --size 10x10",
    "snapshot -o lab.png",
]
VIEWS = {
    "lab": [],
    "phase": ["f3"],
    "accuracy": ["f4"],
    "stability": ["f5"],
    "help": ["question_mark"],
}
SIZES = ((60, 16), (80, 24), (120, 40))

MASKS = (
    (
        r"\b20\d\d-\d\d-\d\d(?:[T ]\d\d[:-]\d\d(?:[:-]\d\d)?(?:\.\d+)?(?:Z|[+-]\d\d:\d\d)?)?",
        "<date>",
    ),
    (r"(?m)^\d+\.\d\d s: energy errors .*$", "<what a running player says every few seconds>"),
    (r"\bin (?:\d+ min )?\d+(?:\.\d+)? m?s\b", "in <wall>"),
    (r'("(?:wall_seconds|seconds|elapsed|seconds_per_step|wall)": )[-+.\de]+', r"\1<wall>"),
    (r"\b\d+(?:\.\d+)? [kM]?B\b", "<size>"),
    (r"\b(?:numpy|textual|rich|plotext|mcap|python|pendu-tui) \d+(?:\.\w+)+", "<version>"),
)


def prepare(folder: Path) -> None:
    """Write the inputs that the command lines name."""
    for name, every in (("fine.csv", 1), ("energy.csv", 2)):
        rows = [
            f"{step * every},{10 + every**2 * (step * 7919 % 101) / 1e5!r}" for step in range(2000)
        ]
        (folder / name).write_text("t,E\n" + "\n".join(rows) + "\n")
    (folder / "scene.toml").write_text(
        'model = "pendulum"\ntheta = 2.0\nh = 0.1\nmethods = ["rk4"]\n'
    )
    (folder / "broken.toml").write_text('model = "pendulum"\ntheta = "west"\n')
    own_method(folder)


def masked(text: str, folder: Path) -> str:
    text = text.replace(str(folder), "<folder>").replace(str(ROOT), "<checkout>")
    for pattern, mask in MASKS:
        text = re.sub(pattern, mask, text)
    return text


def said_by(line: str) -> str:
    """Return what a command line prints, its exit code and the text files that it writes."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name).resolve()
        prepare(folder)
        given = set(folder.iterdir())
        library = folder / "library"
        environment = {
            **os.environ,
            "PENDU_RECORDINGS": str(library),
            "COLUMNS": "100",
            "LINES": "40",
        }
        command = [sys.executable, "-m", "pendu_tui.tui", *shlex.split(line)]
        done = subprocess.run(
            command, cwd=folder, env=environment, capture_output=True, check=False, timeout=300
        )
        parts = [
            f"exit code {done.returncode}",
            done.stdout.decode(),
            "stderr:",
            done.stderr.decode(),
        ]
        for path in sorted(set(folder.iterdir()) - given - {library}):
            content = path.read_text("utf-8") if path.suffix in (".csv", ".svg", ".json") else ""
            parts += [f"file {path.name}:", content]
        return masked("\n".join(parts), folder)


def pictures() -> Iterator[tuple[str, str]]:
    """Draw every view at three sizes."""
    from pendu_tui.engine.scenes import DEFAULT_SCENE
    from pendu_tui.tui.screens.launch import still

    for view, keys in VIEWS.items():
        for size in SIZES:
            picture = asyncio.run(still(DEFAULT_SCENE, 12.0, size, keys=keys))
            yield f"picture {view} {size[0]}x{size[1]}", picture


def everything() -> Iterator[tuple[str, str]]:
    with ThreadPoolExecutor(PROCESSES) as pool:
        yield from zip(COMMAND_LINES, pool.map(said_by, COMMAND_LINES), strict=True)
        from pendu_tui.recordings.files import GOLDEN

        bundled = [f"export {path.stem}" for path in sorted(GOLDEN.glob("*.mcap"))]
        yield from zip(bundled, pool.map(said_by, bundled), strict=True)
    yield from pictures()


def file_of(title: str, folder: Path) -> Path:
    return folder / (re.sub(r"[^\w.=-]+", "_", title)[:120] + ".txt")


def golden(folder: Path, compare: bool) -> int:
    """Write what the program says, or return 1 if it differs from what stands in the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    differs = False
    kept = {path.name for path in folder.glob("*.txt")}
    for title, said in everything():
        path = file_of(title, folder)
        kept.discard(path.name)
        if not compare:
            path.write_text(said, encoding="utf-8")
            continue
        before = path.read_text(encoding="utf-8") if path.exists() else ""
        changes = list(difflib.unified_diff(before.split("\n"), said.split("\n"), n=0, lineterm=""))
        if changes:
            differs = True
            print(f"## {title}", *changes[2:], sep="\n")
    for name in sorted(kept) if compare else []:
        differs = True
        print(f"## {name}: no longer said")
    return int(differs)


def main(arguments: list[str]) -> int:
    compare = "--compare" in arguments
    (folder,) = (argument for argument in arguments if argument != "--compare")
    return golden(Path(folder), compare)
