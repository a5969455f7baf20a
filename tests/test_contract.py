"""What scripts rely on: every JSON field with its type, and every exit code."""

import json
import shlex
from pathlib import Path
from typing import Any

import pytest

from pendu_tui.engine.run.loops import PlainLoops
from tests.recordings.examples import record, two_runs
from tests.tui.command_line import own_method, pendu

FIELDS = Path(__file__).with_name("json_fields.json")

COMMANDS = {
    "accuracy": "accuracy --time 2 --h-values 0.1:0.01:3 --target 1e-2",
    "accuracy --cost seconds": "accuracy --time 2 --h-values 0.1:0.01:2 --cost seconds --methods taylor,rk4",
    "accuracy --all": "accuracy --all --time 2 --h-values 0.4:0.01:4 --target 1e-3",
    "stability": "stability --steps 30 --z-values 0.5,2.5 --theta-values 1,2",
    "run": "run --time 2",
    "run of a method that diverges": "run --h 2 --length 0.1 --time 4000",
    "run of a list": "run --h 0.05,0.1 --time 2",
    "judge": "judge energies.csv --time t --energy E",
    "judge of a few energies": "judge few.csv --time 1 --energy 2",
    "verify": "verify whole.mcap cut.mcap",
    "recordings show": "recordings show whole.mcap",
    "recordings show of a cut recording": "recordings show cut.mcap",
    "recordings recover": "recordings recover cut.mcap -o saved.mcap",
    "recordings": "recordings",
    "scenes": "scenes",
    "methods": "methods",
    "methods --method": "methods mine --method mine.py:mine",
    "doctor": "doctor",
}
SCHEMAS = {
    **dict.fromkeys(("accuracy", "accuracy --cost seconds", "accuracy --all"), "accuracy/2"),
    "run of a list": "runs/1",
    "judge": "judge/2",
    "judge of a few energies": "judge/2",
    "recordings show": "recordings-show/1",
    "recordings show of a cut recording": "recordings-show/1",
    "recordings recover": "recordings-recover/1",
}
"""Schemas that are not of version 1 or not named after their command."""


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Recordings, one of them cut, energies, a method and a library."""
    monkeypatch.chdir(tmp_path)
    whole = record(tmp_path / "whole.mcap", two_runs()).read_bytes()
    (tmp_path / "cut.mcap").write_bytes(whole[:-700])
    (tmp_path / "library").mkdir()
    (tmp_path / "library/one.mcap").write_bytes(whole)
    rows = [f"{n},{10 + (-1) ** n}\n" for n in range(200)]
    (tmp_path / "energies.csv").write_text("t,E\n" + "".join(rows), encoding="utf-8")
    (tmp_path / "few.csv").write_text("t,E\n0,1\n1,2\n2,nan\n", encoding="utf-8")
    Path(own_method(tmp_path).removesuffix(":mine")).rename(tmp_path / "mine.py")
    monkeypatch.setenv("PENDU_RECORDINGS", "library")
    monkeypatch.setattr("pendu_tui.engine.run.loops.compiled", PlainLoops)  # that takes seconds
    monkeypatch.setattr("pendu_tui.engine.studies.accuracy.TIMED_STEPS", 100)


def kinds(value: Any, path: str = "") -> dict[str, set[str]]:
    """Return the types of the values at every path in a JSON value."""
    types: dict[str, set[str]] = {}
    if path:
        types[path] = {type(value).__name__}
    inner: list[tuple[str, Any]] = []
    if isinstance(value, dict):
        inner = [(f"{path}.{key}".lstrip("."), item) for key, item in value.items()]
    elif isinstance(value, list):
        inner = [(f"{path}[]", item) for item in value]
    for inner_path, item in inner:
        for name, kind in kinds(item, inner_path).items():
            types.setdefault(name, set()).update(kind)
    return types


@pytest.mark.parametrize("name", COMMANDS)
def test_every_json_field_is_there_with_its_type(name, request):
    answer = pendu(*COMMANDS[name].split(), "--json").json
    assert answer["schema"] == f"pendu.{SCHEMAS.get(name, f'{name.split()[0]}/1')}"
    seen = {path: " or ".join(sorted(kind)) for path, kind in sorted(kinds(answer).items())}
    stored = json.loads(FIELDS.read_text(encoding="utf-8"))
    if request.config.getoption("--snapshot-update"):
        text = json.dumps(stored | {name: seen}, indent=1, sort_keys=True)
        FIELDS.write_text(text + "\n", encoding="utf-8")
    else:
        assert seen == stored[name]


JUDGE = "judge energies.csv --time t --energy E"


@pytest.mark.parametrize(
    ("code", "command"),
    [
        (0, f"{JUDGE} --fail-if 'verdict != bounded'"),
        (1, f"{JUDGE} --fail-if 'max_energy_error > 0.1'"),
        (1, "verify cut.mcap"),
        (3, "run --time 2 --method mine.py:other"),
        (2, "diff whole.mcap other.mcap"),
        (2, "nothing"),
        (3, "replay absent.mcap"),
        (4, "replay whole.mcap"),
        (5, "export whole.mcap -o absent/whole.csv"),
    ],
)
def test_the_exit_code_says_what_happened(code, command):
    assert pendu(*shlex.split(command)).code == code
