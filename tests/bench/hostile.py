"""What every command makes of hostile files: one JSON object, with processor time and peak memory.

python tests/bench/hostile.py [PART OF A FILE'S NAME]
"""

import json
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.tui.pty_lab import PtyLab

LIMIT = 60.0  # s of real time
COMMANDS = {
    "info": ("info",),
    "info --json": ("info", "--json"),
    "verify": ("verify",),
    "recover": ("recover", "-o", "out.mcap", "--force"),
    "export": ("export", "-o", "out.csv", "--force"),
}


def measured(folder: Path, command: tuple[str, ...], file: Path) -> dict[str, object]:
    """Run a command on a file; a replay is played for three seconds, sought in, and left."""
    replay = command == ("replay",)
    arguments = [str(folder / each) if each.startswith("out.") else each for each in command]
    with PtyLab(*arguments, str(file)) as lab:
        try:
            if replay:
                while lab.now < LIMIT and not any(text in lab.output for text in (b"recording", b"no samples")):
                    lab.read(0.1)
                for key in "n", "n", "\x1b[F", "p", "\x1b[H":
                    with suppress(OSError):  # it may have refused the file
                        lab.type(key)
                    lab.run(0.6)
                with suppress(OSError):
                    lab.type("q")
            code: int | None = lab.end(LIMIT)
        except TimeoutError:
            lab.signal(9)
            with suppress(TimeoutError):
                lab.end(10)
            code = None
        usage = lab.usage
        return {
            "code": code,  # None: it was not done within the limit
            "seconds": round(lab.now, 1),
            "processor_seconds": round(usage.ru_utime + usage.ru_stime, 1),
            "megabytes": round(usage.ru_maxrss / 1024),
        }


def main() -> None:
    """Make the files, measure, and print."""
    part = sys.argv[1] if len(sys.argv) > 1 else ""
    results = {}
    with TemporaryDirectory() as name:
        folder = Path(name)
        made = subprocess.run(
            [sys.executable, "-m", "tests.recordings.hostile", name], check=True, capture_output=True, text=True
        )
        for what, file in json.loads(made.stdout).items():
            if part not in what:
                continue
            results[what] = {
                "file_bytes": (folder / file).stat().st_size,
                **{label: measured(folder, command, folder / file) for label, command in COMMANDS.items()},
                "replay": measured(folder, ("replay",), folder / file),
            }
    print(json.dumps({"benchmark": "hostile", "limit_seconds": LIMIT, "files": results, "at": time.strftime("%F")}))


if __name__ == "__main__":
    main()
