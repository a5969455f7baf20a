"""Write down what the program says, so that a move can be seen to change nothing.

python -m tests.bench golden OUT             write a file for each command line and bundled recording
python -m tests.bench golden OUT --compare   say the same again and print what differs

Wall times, dates, versions and paths are masked.  Pictures are stored in tests/tui/snapshots.
"""

import os
import re
import shlex
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory

from pendu_tui.engine.scenes import SCENES
from pendu_tui.recordings.files import GOLDEN
from pendu_tui.tui.cli.dispatch import COMMANDS
from tests import test_contract
from tests.tui.command_line import PENDU, ROOT

LINES = [
    *(f"{command} --help" for command in ("", *COMMANDS)),
    *(f"run {scene} --time 20" for scene in SCENES),
    *(f"export {path.stem}" for path in sorted(GOLDEN.glob("*.mcap"))),
    *(
        line + form
        for line in test_contract.COMMANDS.values()
        for form in ("", " --json", " --csv", " -o table.csv")
    ),
    "run --theta 10deg:170deg:5 --h 0.01:0.5:4 --time 5 --csv",
    "run --time 5 --workers 2 --theta 1,2 --json",
    "run --time 60 --fail-if 'rk4.max_energy_error > 1e-9'",
    "live --plain --time 3 --no-record",
    "accuracy --time 5 --error energy --csv",
    "accuracy --target 1e-6 --time 5 --methods verlet,bm4",
    "stability --theta 1 --z-values 0.5:3:12 --steps 300",
    "methods rk4",
    "scenes crossover",
    "judge energies.csv --time t --energy E --scale std --fail-if 'verdict != bounded'",
    "verify golden",
    "replay --plain drift",
    "snapshot --time 3 --size 80x24 -o lab.svg",
    "tour --plain",
    "--print-completion bash",
    # wrong input
    "rum",
    "run",
    "run nowhere --time 1",
    "run --time 1 --h 0",
    "run --time 1 --theta east",
    "run --time 1 --methods rk5",
    "run --time 1 --fail-if 'rk4.speed > 1'",
    "run --time 1 --method mine.py:other",
    "run --time 1 --record energies.csv",
    "accuracy --target 10",
    "accuracy -o table.xyz",
    "stability --z-values 3:1:x",
    "judge absent.csv --time t --energy E",
    "judge energies.csv --time t --energy F",
    "judge energies.csv --time t --energy E --fail-if verdict",
    "verify energies.csv",
    "recordings show nothing",
    "snapshot --size 10x10",
]

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


def said_by(line: str) -> str:
    """Return what a command line prints, its exit code and the text files that it writes."""
    with TemporaryDirectory() as name:
        folder = Path(name).resolve()
        test_contract.prepare(folder)
        given = set(folder.iterdir())
        environment = {"PENDU_RECORDINGS": "library", "COLUMNS": "100", "LINES": "40"}
        done = subprocess.run(
            [*PENDU, *shlex.split(line)],
            cwd=folder,
            env={**os.environ, **environment},
            capture_output=True,
            text=True,
            check=False,
            timeout=300,
        )
        parts = [line, f"exit code {done.returncode}", done.stdout, "stderr:", done.stderr]
        for path in sorted(set(folder.iterdir()) - given):
            content = path.read_text("utf-8") if path.suffix in (".csv", ".svg", ".json") else ""
            parts += [f"file {path.name}:", content]
    text = "\n".join(parts).replace(str(folder), "<folder>").replace(str(ROOT), "<checkout>")
    for pattern, mask in MASKS:
        text = re.sub(pattern, mask, text)
    return text


def write(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for line, said in zip(LINES, pool.map(said_by, LINES), strict=True):
            name = re.sub(r"[^\w.=-]+", "_", line)[:120]
            (folder / f"{name}.txt").write_text(said, encoding="utf-8")


def main(folder: str, *options: str) -> int:
    """Return 1 if the program says something else than what stands in the folder."""
    if options != ("--compare",):
        write(Path(folder))
        return 0
    with TemporaryDirectory() as now:
        write(Path(now))
        return subprocess.run(["diff", "-rU0", folder, now], check=False).returncode
