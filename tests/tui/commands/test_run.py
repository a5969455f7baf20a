"""`pendu-tui run`: one scene, or every combination of a list."""

import csv
import re
import signal
from contextlib import nullcontext
from pathlib import Path
from types import SimpleNamespace

import pytest

from pendu_tui.engine import quantities
from pendu_tui.engine.run.verdicts import Judgement, Progress
from pendu_tui.engine.scenes import DEFAULT_SCENE, SCENES
from pendu_tui.recordings.recording import Recording
from pendu_tui.recordings.verification import verify
from pendu_tui.tui.commands import run
from tests.recordings.examples import record, two_runs
from tests.tui.command_line import own_method, pendu


@pytest.mark.parametrize(
    ("command", "count", "first", "whole"),
    [
        ("run --time 2 --sample-every 10", 5, 0, 40),
        ("run --time 2 --method mine.py:mine", 4, 0, 40),  # which may be slow
        ("run --time 2 --h 0.001 --method mine.py:mine --record new.mcap", 126, 0, 2000),
        ("run --time 2 --h 0.1 --record new.mcap", 21, 0, 20),
        ("export a", 10, 0, 4.0),
        ("run --theta 1,2,3 --time 1", 3, 1, 3),
        ("accuracy --time 1 --h-values 0.2:0.1:2 --target 0.1 --methods rk4,heun", 6, 5, 60),
        ("stability --steps 9 --theta-values 1 --z-values 1,2 --methods rk4,heun", 2, 1, 2),
    ],
)
def test_the_progress_is_shown_to_the_end(command, count, first, whole, here, monkeypatch):
    Path(own_method(here).removesuffix(":mine")).rename("mine.py")
    record(here / "a.mcap", two_runs())
    shown = []
    show = nullcontext(lambda *done: shown.append(done))
    for module in ("commands.run", "commands.export", "cli.workers"):
        monkeypatch.setattr(f"pendu_tui.tui.{module}.progress", lambda _: show)
    kept = []
    monkeypatch.setattr(run, "_lines", lambda _, samples: kept.extend(samples))
    assert pendu(*command.split()).code == 0
    assert len(kept) == command.startswith("run --time")  # one unless a figure needs them all
    assert (len(shown), shown[0], shown[-1]) == (count, (first, whole), (whole, whole))


EXTREME = ["--omega=1e8", "--theta=1e6rad", "--h=4.5", "--theta=0"]


@pytest.mark.parametrize("start", [*(f"--scene={name}" for name in SCENES), *EXTREME])
def test_every_scene_and_extreme_start_runs_and_prints_no_nan(start):
    assert pendu("run", start, "--time", 5, "--json").json["steps"]  # its parser refuses nan


def test_a_recording_has_the_same_bytes_each_time_and_is_overwritten_by_force_only(tmp_path):
    path = tmp_path / "run.mcap"
    run = ("run", "--scene", "spin", "--time", 5, "--record", path)
    assert pendu(*run).err == f"pendu-tui: wrote {path}\n"
    recorded = path.read_bytes()
    assert verify(path).identical
    assert pendu(*run).refused(5, "exists", "--force", str(path))
    assert pendu(*run, "--force").code == 0
    assert path.read_bytes() == recorded
    assert pendu(*run, "--force", "--sample-every", 50).code == 0
    with Recording.open(path) as recording:
        assert recording.samples == 1 + 250 / 50


def test_notes_say_why_a_method_is_undecided_and_how_chaotic_it_is():
    judgements = (
        Judgement("undecided", reason="it beats"),
        Judgement("undecided", reason="2 of 8 cycles", progress=Progress(2, 8, "cycles")),
        Judgement("chaotic", lyapunov=0.2),
        Judgement("grows", rests=True),
    )
    lockstep = SimpleNamespace(scene=DEFAULT_SCENE, milestones=[], judgements=judgements)
    assert [*run._notes(lockstep)] == [
        "Explicit Euler is undecided: it beats.",
        "Verlet's motion is chaotic: nearby orbits diverge tenfold every 12 s.",
    ]
    (verlet,) = pendu("run", "chaos-loose", "--time", 300, "--methods", "v", "--json").json[
        "methods"
    ]
    assert verlet["lyapunov_per_second"] == pytest.approx(0.25, abs=0.05)


@pytest.mark.parametrize(
    ("options", "steps"),
    [("--theta 1,2 --omega 0,1 --h 0.1,0.2", 60), ("--length 1,2", 0)],
)
def test_the_steps_of_all_runs_of_a_list_decide_whether_to_compile(options, steps, monkeypatch):
    asked = []
    made = run.loops.TieredLoops

    def loops(*arguments, expected_steps):
        asked.append(expected_steps)
        return made(*arguments, expected_steps)

    monkeypatch.setattr(run.loops, "TieredLoops", loops)
    assert pendu("run", "--time", 1, *options.split()).code == 0
    assert {*asked} == {steps}


def test_a_worker_has_a_watchdog_of_its_own(monkeypatch):
    begun = []
    monkeypatch.setattr(run, "watchdog", lambda: begun.append("here"))
    assert len(run._rows_of_list(0.1, 0, DEFAULT_SCENE)) == 4
    assert begun == ["here"]


def test_a_run_that_is_stopped_gives_what_it_has_and_replaces_no_file(tmp_path, monkeypatch):
    def show(step, steps):
        if step == 10:
            signal.raise_signal(signal.SIGTERM)

    monkeypatch.setattr(run, "progress", lambda _: nullcontext(show))
    line = ("run", "halving", "--time", 4, "--sample-every", 5, "--force")
    older = tmp_path / "run.mcap"
    older.touch()
    outcome = pendu(*line, "--record", older)
    assert (outcome.code, outcome.out.splitlines()[1][:20]) == (130, "10 steps to t = 2 s ")
    assert re.search(r"Step doubling .* 80$", outcome.out, re.MULTILINE)  # on average
    recorded = verify(tmp_path / "run-2.mcap")
    assert (recorded.complete, recorded.identical) == (True, True)
    assert f"wrote {tmp_path / 'run-2.mcap'}\n" in outcome.err
    assert outcome.err.endswith("interrupted at t = 2 s, showing the results up to then.\n")
    assert pendu(*line, "-o", tmp_path / "new.csv").code == 130
    assert pendu(*line, "-o", tmp_path / "new.csv").refused(130, "is unchanged")


@pytest.mark.parametrize(
    ("command", "rows", "share", "field", "count"),
    [
        ("run --theta 10deg:170deg:3 --h 0.05,0.1 --time 2", 4, "17 %", "runs", 4),
        ("stability --steps 300 --z-values 0.1:3:12 --theta-values 0.5,2", 6, "6 %", "pendulum", 2),
        ("accuracy --time 5 --h-values 0.2:0.05:3", 1, "4 %", "points", 1),
    ],
)
def test_an_interrupt_keeps_what_is_done(monkeypatch, command, rows, share, field, count):
    monkeypatch.setattr("pendu_tui.engine.studies.stability.PART", 6)

    def run(function, tasks):
        yield function(next(iter(tasks)))
        raise KeyboardInterrupt

    monkeypatch.setattr("pendu_tui.tui.cli.workers.workers_of", lambda _: nullcontext(run))
    outcome = pendu(*command.split(), "--csv")
    assert (outcome.code, outcome.out.count("\n")) == (130, 1 + rows)
    assert share in outcome.err
    answer = pendu(*command.split(), "--json").json
    assert (answer["interrupted"], len(answer[field])) == (True, count)


def test_a_run_of_a_list_ends_after_whole_steps_as_one_alone_does():
    runs = pendu("run", "--time", 1, "--h", "0.3,0.4", "--methods", "rk4", "--json").json["runs"]
    for each in runs:
        alone = pendu("run", "--time", 1, "--h", each["h"], "--methods", "rk4", "--json").json
        assert each["time"] == alone["time"] == each["h"] * alone["steps"]


def test_of_a_repeated_gate_each_counts_and_a_bounded_energy_has_a_drift():
    command = ("run", "--time", 20, "--methods", "verlet")
    passing = ("--fail-if", "any.drift_per_second > 1e-3")
    assert pendu(*command, *passing, *passing).code == 0
    failing = ("--fail-if", "any.energy > 0")
    for gates in ((*passing, *failing), (*failing, *passing)):
        assert pendu(*command, *gates).code == 1


def test_csv_has_the_numbers_of_json_under_their_names_also_where_a_method_has_failed():
    one_fails = ("run", "--theta", 3, "--h", 0.7, "--time", 7, "--methods", "implicit_m,verlet")
    rows = list(csv.DictReader(pendu(*one_fails, "--csv").out.splitlines()))
    methods = pendu(*one_fails, "--json").json["methods"]
    assert [row["diverged_at"] for row in rows] == ["0.7", ""]
    # also what is recorded, except extremes and an invariant that a pendulum has not
    missing = [each.name for each in quantities.RECORDED if each.name not in rows[0]]
    assert missing == [*quantities.EXTREMES, "max_invariant_error"]
    for row, fields in zip(rows, methods, strict=True):
        del fields["progress"]
        assert row == {name: "" if fields[name] is None else str(fields[name]) for name in fields}
