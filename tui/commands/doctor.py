"""Say what the lab finds here: terminal, encoding, colours, recordings, versions; and what to do about it."""

import argparse
import os
import platform
import shutil
import sys
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from tui.errors import Exit, UserError
from tui.output import print_table, write_json

EXAMPLES = """\
examples:
  pendu-tui doctor
  pendu-tui doctor --json | jq '.findings[] | select(.advice != "")'
"""

PACKAGES = ("pendu-tui", "textual", "rich", "plotext", "numpy", "mcap")


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
    yield Finding("mouse", "not looked for", "every click has a key")
    yield folder(library.folder())
    yield unfinished(len(library.leftovers()))
    yield sine(library.resolve("drift"))
    yield Finding("python", f"{platform.python_version()}, {platform.system()} {platform.machine()}")
    yield Finding("versions", ", ".join(f"{package} {version(package)}" for package in PACKAGES))
    yield numba()


def lab() -> Finding:
    """Whether the lab starts here."""
    from tui.terminal import check_terminal

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


def folder(path: Path) -> Finding:
    """Whether recordings can be kept."""
    nearest = next(parent for parent in (path, *path.parents) if parent.exists())
    if os.access(nearest, os.W_OK | os.X_OK) and nearest.is_dir():
        return Finding("recordings", str(path))
    return Finding("recordings", str(path), "cannot be written: set PENDU_RECORDINGS to a folder that can")


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
