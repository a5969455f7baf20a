"""What every command makes of hostile files: one JSON object with processor time and peak memory.

python tests/bench/hostile.py [HOW MANY ARE MANY]
"""

import json
import os
import subprocess
import sys
from multiprocessing import Process
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.recordings.hostile import FILES, write

MAIN = "import sys; from tui.cli import main; sys.exit(main())"
COMMANDS = {
    "verify": ("verify",),
    "show": ("recordings", "show"),
    "recover": ("recordings", "recover", "-o", "out.mcap", "--force"),
    "export": ("export", "-o", "out.csv", "--force"),
}


def measured(command: tuple[str, ...], file: Path) -> tuple[int, float, float]:
    """Return exit code, processor time [s] and peak memory [MB] of a command."""
    arguments = [sys.executable, "-c", MAIN, *command, str(file)]
    process = subprocess.Popen(
        arguments, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=file.parent
    )
    _, status, usage = os.wait4(process.pid, 0)
    return (
        os.waitstatus_to_exitcode(status),
        usage.ru_utime + usage.ru_stime,
        usage.ru_maxrss / 1000,
    )


def write_file(path: Path, name: str, many: int) -> None:
    """Write one of the hostile files."""
    write(path, FILES[name](many), chunk_size=1 << 28 if name == "a huge message" else 1 << 20)


def main() -> None:
    """Measure and print."""
    many = int(sys.argv[1]) if len(sys.argv) > 1 else 90_000
    worst = {"processor_seconds": 0.0, "memory_mb": 0.0}
    codes = set()
    with TemporaryDirectory() as folder:
        for name in FILES:
            path = Path(folder) / "hostile.mcap"
            writer = Process(
                target=write_file, args=(path, name, many)
            )  # or commands inherit its memory
            writer.start()
            writer.join()
            for command in COMMANDS.values():
                code, seconds, memory = measured(command, path)
                codes.add(code)
                print(
                    f"{name:<22} {' '.join(command):<40} {code} {seconds:.1f} s {memory:.0f} MB",
                    file=sys.stderr,
                )
                worst["processor_seconds"] = round(max(worst["processor_seconds"], seconds), 2)
                worst["memory_mb"] = round(max(worst["memory_mb"], memory))
    cases = len(FILES) * len(COMMANDS)
    print(json.dumps({"benchmark": "hostile", "cases": cases, "codes": sorted(codes), **worst}))


if __name__ == "__main__":
    main()
