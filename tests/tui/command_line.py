"""Run the command line within the test's process and keep what it printed."""

import io
import json
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tui.cli.dispatch import main


@dataclass(frozen=True)
class Outcome:
    code: int
    out: str
    err: str

    @property
    def json(self) -> Any:
        return json.loads(self.out, parse_constant=_no_constant)

    def refused(self, code: int, *words: str) -> bool:
        """Whether it ended with this code and one sentence on stderr that has all these words."""
        assert self.code == code, (self.code, self.err)
        assert self.err.count("\n") == 1, self.err
        assert self.err.startswith("pendu-tui: ")
        assert not self.out, self.out
        for word in words:
            assert word in self.err, (word, self.err)
        return True


def pendu(*arguments: object) -> Outcome:
    out, err = (
        io.TextIOWrapper(io.BytesIO(), encoding="utf-8", write_through=True) for _ in range(2)
    )
    with redirect_stdout(out), redirect_stderr(err):
        code = main([str(argument) for argument in arguments])
    return Outcome(code, *(stream.buffer.getvalue().decode() for stream in (out, err)))


def own_method(folder: Path) -> str:
    """A file with symplectic Euler in it as somebody's own method, for --method."""
    lines = [
        "def mine(force, phase, h):",
        "    theta, omega = phase",
        "    while True:",
        "        omega = omega + h * force(theta)",
        "        theta = theta + h * omega",
        "        yield theta, omega",
    ]
    (folder / "my methods.py").write_text("\n".join(lines))
    return f"{folder}/my methods.py:mine"


def _no_constant(name: str) -> float:
    raise AssertionError(f"{name} is not JSON")
