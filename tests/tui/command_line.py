"""Run the command line in the test's process and capture its output."""

import io
import json
import re
import signal
import sys
from contextlib import redirect_stderr, redirect_stdout, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from pendu_tui.tui.cli.dispatch import main

PENDU = [
    sys.executable,
    "-c",
    "import sys; from pendu_tui.tui.cli.dispatch import main; sys.exit(main())",
]
EULER = """\
def {name}(force, phase, h):
    theta, omega = phase
    while True:
        omega = omega + h * force(theta)
        theta = theta + h * omega
        yield theta, omega
"""
ROOT = Path(__file__).parents[2]
IS_WINDOWS = sys.platform == "win32"
needs_signals = pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="needs POSIX signals")


@dataclass(frozen=True)
class Outcome:
    code: int
    out: str
    err: str

    @property
    def json(self) -> Any:
        return json.loads(self.out, parse_constant=_no_constant)

    def refused(self, code: int, *words: str) -> bool:
        """Check that it ended with this code and with one sentence on stderr with these words."""
        assert self.code == code, (self.code, self.err)
        assert self.err.count("\n") == 1, self.err
        assert self.err.startswith("pendu-tui: ")
        assert not self.out, self.out
        for word in words:
            assert word in self.err, (word, self.err)
        return True


def pendu(*arguments: object) -> Outcome:
    out = io.BytesIO()
    err = io.BytesIO()
    with (
        redirect_stdout(io.TextIOWrapper(out, encoding="utf-8", write_through=True)),
        redirect_stderr(io.TextIOWrapper(err, encoding="utf-8", write_through=True)),
    ):
        code = main([str(argument) for argument in arguments])
        return Outcome(code, out.getvalue().decode(), err.getvalue().decode())


def link(path: Path, target: Path | str) -> None:
    """Make a symbolic link, or skip the test where there are none."""
    with suppress(OSError):
        path.symlink_to(target)
    if not path.is_symlink():
        pytest.skip("needs symbolic links")


def shortened(text: str) -> str:
    """Round long numbers, of which the last digits depend on the machine."""
    digits = r"(?<!x)\b(?=[\d.]{14})\d+\.\d+(e[-+]\d+)?"
    return re.sub(digits, lambda found: f"{float(found[0]):.4g}", text)


def own_method(folder: Path) -> str:
    """Write symplectic Euler to a file, and return the argument of --method."""
    (folder / "my methods.py").write_text(EULER.format(name="mine"))
    return f"{folder}/my methods.py:mine"


def _no_constant(name: str) -> float:
    raise AssertionError(f"{name} is not JSON")
