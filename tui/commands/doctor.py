"""Say what the lab finds here: terminal, encoding, colours, recordings, versions; and what to do about it."""

import argparse
import os
import platform
import shutil
import sys
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from tempfile import TemporaryFile

from tui.cli.errors import Exit, UserError
from tui.cli.output import print_table, write_json
from tui.words.numbers import file_size

EXAMPLES = """\
examples:
  pendu-tui doctor
  pendu-tui doctor --json | jq '.findings[] | select(.advice != "")'
"""

PACKAGES = ("pendu-tui", "textual", "rich", "plotext", "numpy", "mcap")
ROOMY = 1_000_000_000  # bytes free: a day of sittings


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing looked at.  No advice means that it is fine."""

    what: str
    found: str
    advice: str = ""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add this command's options."""
    parser.add_argument("--json", action="store_true", help="one JSON object")


def run(options: argparse.Namespace) -> int:
    """Look, and say what was found."""
    findings = list(_findings())
    if options.json:
        write_json("doctor", {"findings": [asdict(finding) for finding in findings]})
    else:
        print_table("lll", ("", "found", "advice"), ((f.what, f.found, f.advice or "fine") for f in findings))
    return Exit.FINE


def _findings() -> Iterator[Finding]:
    from recordings import library

    yield lab()
    columns, rows = shutil.get_terminal_size()
    yield size(columns, rows) if sys.stdout.isatty() else Finding("size", "unknown: the output is a file or a pipe")
    yield encoding(sys.stdout.encoding)
    yield colours(os.environ)
    yield mouse(os.environ)
    yield folder(library.folder())
    with suppress(OSError):  # which the finding before tells of
        yield unfinished(len(library.leftovers()))
    yield sine(library.resolve("drift"))
    yield Finding("python", f"{platform.python_version()}, {platform.system()} {platform.machine()}")
    yield Finding("versions", ", ".join(f"{package} {version(package)}" for package in PACKAGES))
    yield numba()


def lab() -> Finding:
    """Whether the lab starts here."""
    from tui.terminal.check import check_terminal

    try:
        check_terminal()
    except UserError as error:
        return Finding("lab", "does not start here", str(error))
    return Finding("lab", "starts here")


def size(columns: int, rows: int) -> Finding:
    """Whether the lab fits."""
    found = f"{columns}x{rows}"
    if columns < 60 or rows < 16:
        return Finding("size", found, "too small for the lab: enlarge it to 80x24 at least, 60x16 is the limit")
    if columns < 120 or rows < 40:
        return Finding("size", found, "120x40 shows more at once")
    return Finding("size", found)


def encoding(name: str) -> Finding:
    """Whether braille and Greek can be written."""
    if name.lower().replace("-", "") == "utf8":
        return Finding("encoding", name)
    return Finding("encoding", name, "braille needs UTF-8: set LANG=C.UTF-8, or PYTHONUTF8=1")


def colours(environment: Mapping[str, str]) -> Finding:
    """How many colours the terminal says it has."""
    term = environment.get("TERM", "")
    if environment.get("NO_COLOR"):
        return Finding("colours", f"TERM={term}, NO_COLOR", "none, as you asked; methods keep their digits and letters")
    if term in ("", "dumb"):
        return Finding("colours", f"TERM={term}, none", "set TERM to what the terminal is, such as xterm-256color")
    if environment.get("COLORTERM") in ("truecolor", "24bit"):
        return Finding("colours", f"TERM={term}, 16 million")
    advice = "if your terminal can do more, COLORTERM=truecolor says so"
    return Finding("colours", f"TERM={term}, {'256' if '256color' in term else '16'}", advice)


def mouse(environment: Mapping[str, str]) -> Finding:
    """Whether clicks can be expected: nothing tells it but the terminal's name."""
    if environment.get("TERM", "") in ("", "dumb", "linux", "vt100", "vt220"):
        return Finding("mouse", "none is known of this terminal", "every click has a key")
    return Finding("mouse", "used where the terminal reports it; --no-mouse leaves it to the terminal")


def folder(path: Path) -> Finding:
    """Whether recordings can be kept: tried out, since rights alone do not tell, and nothing is left of it."""
    made: list[Path] = []
    try:
        for each in (*reversed(path.parents), path):
            if not each.exists():
                each.mkdir()
                made.append(each)
        with TemporaryFile(dir=path):
            free = shutil.disk_usage(path).free
    except OSError as error:
        advice = f"cannot be written ({error.strerror}): set PENDU_RECORDINGS to a folder that can"
        return Finding("recordings", str(path), advice)
    finally:
        for each in reversed(made):
            with suppress(OSError):  # somebody has put something there
                each.rmdir()
    advice = "there is little room: pendu-tui recordings prune --keep 20 makes some" if free < ROOMY else ""
    return Finding("recordings", f"{path}, {file_size(free)} free", advice)


def unfinished(count: int) -> Finding:
    """What sittings that were killed have left."""
    if not count:
        return Finding("unfinished", "none")
    return Finding(
        "unfinished", str(count), "the lab recovers them when it starts next; pendu-tui recordings names them"
    )


def sine(golden: Path) -> Finding:
    """Whether this machine's sin is that of the recordings that come with the program."""
    from recordings.format import sin_fingerprint
    from recordings.recording import Recording

    with Recording.open(golden) as recording:
        same = recording.sin == sin_fingerprint()
    advice = "" if same else "another libm: recordings from elsewhere verify within a tolerance, not to the bit"
    return Finding("sin", sin_fingerprint(), advice)


def numba() -> Finding:
    """Whether compiled methods are at hand."""
    try:
        return Finding("numba", version("numba"))
    except PackageNotFoundError:
        return Finding("numba", "not installed", "the extra fast compiles long runs: pip install '.[fast]'")
