"""What people script against: every JSON field with its kind, and every exit code."""

import json
from pathlib import Path
from typing import Any

import pytest

from engine.run.stepping import Stepping
from tests.recordings.examples import record, two_runs
from tests.tui.command_line import pendu
from tests.tui.harness import recorded
from tui.playback.live import Live

FIELDS = Path(__file__).with_name("json_fields.json")

COMMANDS = {
    "accuracy": ["accuracy", "--time", "2", "--h-values", "0.1:0.01:3", "--target", "1e-2", "--json"],
    "accuracy --cost seconds --budget": [
        "accuracy", "--time", "2", "--h-values", "0.1:0.01:2", "--cost", "seconds", "--budget", "1e3", "--json",
    ],
    "accuracy --all": [
        "accuracy", "--all", "--time", "2", "--h-values", "0.4:0.01:4", "--target", "1e-3", "--json",
    ],
    "stability": ["stability", "--steps", "30", "--z-values", "0.5,2.5", "--theta-values", "1,2", "--json"],
    "stability --scene linear": ["stability", "--scene", "linear", "--json"],
    "stability --map": ["stability", "--steps", "9", "--z-values", "0.5,2.5", "--theta-values", "1", "--map", "--json"],
    "stability --section": ["stability", "--section", "--theta", "1.25", "--h", "0.348", "--steps", "3000", "--json"],
    "run": ["run", "--time", "2", "--json"],
    "run of a method that diverges": ["run", "--h", "2", "--length", "0.1", "--time", "4000", "--json"],
    "run of a list": ["run", "--h", "0.05,0.1", "--time", "2", "--json"],
    "judge": ["judge", "energies.csv", "--time", "t", "--energy", "E", "--json"],
    "judge of a few energies": ["judge", "few.csv", "--time", "1", "--energy", "2", "--json"],
    "verify": ["verify", "whole.mcap", "cut.mcap", "--json"],
    "recordings show": ["recordings", "show", "whole.mcap", "--json"],
    "recordings show of a cut recording": ["recordings", "show", "cut.mcap", "--json"],
    "diff": ["diff", "whole.mcap", "other.mcap", "--json"],
    "diff of the same": ["diff", "whole.mcap", "whole.mcap", "--json"],
    "recordings recover": ["recordings", "recover", "cut.mcap", "-o", "saved.mcap", "--json"],
    "recordings": ["recordings", "--json"],
    "recordings prune": ["recordings", "prune", "--keep", "1", "--json"],
    "scenes": ["scenes", "--json"],
    "methods": ["methods", "--json"],
    "methods --method": ["methods", "--methods", "mine", "--method", "mine.py:mine", "--json"],
    "doctor": ["doctor", "--json"],
}  # fmt: skip


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """A folder with a whole recording, one that was cut, and a method; it has a library, too."""
    whole = record(tmp_path / "whole.mcap", two_runs())
    (tmp_path / "cut.mcap").write_bytes(whole.read_bytes()[:-700])
    rows = [f"{n},{10 + (-1) ** n}\n" for n in range(200)]
    (tmp_path / "energies.csv").write_text("t,E\n" + "".join(rows), encoding="utf-8")
    (tmp_path / "few.csv").write_text("t,E\n0,1\n1,2\n2,nan\n", encoding="utf-8")
    recorded(
        tmp_path / "other.mcap", 1.0, Live.mark, lambda live: live.set_stepping(Stepping(0.1)), 0.5
    )
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path / "library"))
    (tmp_path / "library").mkdir()
    (tmp_path / "library" / "one.mcap").write_bytes(whole.read_bytes())
    (tmp_path / "mine.py").write_text(
        "def mine(force, phase, h):\n    theta, omega = phase\n    while True:\n"
        "        theta, omega = theta + h * omega, omega + h * force(theta)\n        yield theta, omega\n"
    )


def kinds(value: Any, path: str = "") -> dict[str, set[str]]:
    """Every path in a JSON value with the kinds of value that stand there."""
    found: dict[str, set[str]] = {path: {type(value).__name__}} if path else {}
    inner = (
        [(f"{path}.{key}".lstrip("."), each) for key, each in value.items()]
        if isinstance(value, dict)
        else []
    )
    inner += [(f"{path}[]", each) for each in value] if isinstance(value, list) else []
    for where, each in inner:
        for name, kind in kinds(each, where).items():
            found.setdefault(name, set()).update(kind)
    return found


@pytest.mark.parametrize("name", COMMANDS)
def test_every_json_field_is_there_with_its_kind(name, request):
    seen = {
        path: " or ".join(sorted(kind))
        for path, kind in sorted(kinds(pendu(*COMMANDS[name]).json).items())
    }
    stored = json.loads(FIELDS.read_text(encoding="utf-8")) if FIELDS.exists() else {}
    if request.config.getoption("--snapshot-update"):
        FIELDS.write_text(
            json.dumps(stored | {name: seen}, indent=1, sort_keys=True) + "\n", encoding="utf-8"
        )
    else:
        assert seen == stored[name]


@pytest.mark.parametrize("name", COMMANDS)
def test_the_schema_is_that_of_the_command(name):
    command, verb, *_ = COMMANDS[name]
    schema = f"recordings-{verb}" if command == "recordings" and verb != "--json" else command
    schema = "runs" if name == "run of a list" else schema
    schema = "section" if "--section" in COMMANDS[name] else schema
    assert pendu(*COMMANDS[name]).json["schema"] == f"pendu.{schema}/1"


@pytest.mark.parametrize(
    ("code", "arguments"),
    [
        (0, ["run", "--time", "2"]),
        (0, ["verify", "whole.mcap"]),
        (1, ["run", "--time", "2", "--fail-if", "rk4.max_energy_error >= 0"]),
        (1, ["verify", "cut.mcap"]),
        (1, ["run", "--time", "2", "--fail-if", "rk4.verdict == grows or rk4.verdict != grows"]),
        (
            0,
            [
                "judge",
                "energies.csv",
                "--time",
                "t",
                "--energy",
                "E",
                "--fail-if",
                "verdict != bounded",
            ],
        ),
        (
            1,
            [
                "judge",
                "energies.csv",
                "--time",
                "t",
                "--energy",
                "E",
                "--fail-if",
                "max_energy_error > 0.1",
            ],
        ),
        (2, ["judge", "energies.csv", "--time", "t", "--energy", "H"]),
        (3, ["judge", "absent.csv", "--time", "t", "--energy", "E"]),
        (
            5,
            [
                "judge",
                "energies.csv",
                "--time",
                "t",
                "--energy",
                "E",
                "--junit",
                "absent/judge.xml",
            ],
        ),
        (2, ["run", "--time", "0"]),
        (2, ["run", "--time", "2", "--fail-if", "rk5.max_energy_error > 0"]),
        (0, ["run", "--time", "2", "--methods", "rk4", "--method", "mine.py:mine"]),
        (2, ["run", "--time", "2", "--methods", "rk5"]),
        (2, ["run", "--time", "2", "--method", "mine.py:other"]),
        (3, ["run", "--time", "2", "--method", "absent.py:mine"]),
        (0, ["diff", "whole.mcap", "whole.mcap"]),
        (1, ["diff", "whole.mcap", "other.mcap"]),
        (2, ["diff", "whole.mcap"]),
        (3, ["diff", "whole.mcap", "absent.mcap"]),
        (2, ["serve", "--port", "x"]),
        (2, ["nothing"]),
        (2, ["--scene", "nothing"]),
        (3, ["recordings", "show", "absent.mcap"]),
        (2, ["info", "whole.mcap"]),
        (3, ["verify", "absent.mcap"]),
        (4, ["live", "--no-record"]),
        (4, ["tour", "--no-record"]),
        (5, ["run", "--time", "2", "--record", "whole.mcap"]),
        (5, ["export", "whole.mcap", "-o", "absent/whole.csv"]),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else str(value),
)
def test_the_exit_code_says_what_happened(code, arguments):
    assert pendu(*arguments).code == code
