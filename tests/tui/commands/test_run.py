import math
import os
import signal
import subprocess
import time
from pathlib import Path

import pytest

from engine.methods import USUAL_CAST
from engine.methods.adaptive import HALVING_VERLET
from engine.run.compiled import available
from engine.run.lockstep import Lockstep
from engine.run.loops import count_evaluations
from engine.scenes import DEFAULT_SCENE, SCENES
from recordings.fields import EXTRA_NAMES
from recordings.recording import Recording
from recordings.verification import verify
from tests.tui.command_line import pendu
from tests.tui.pty_lab import PENDU
from tui.cli.fail_if import FIELDS
from tui.commands.studies.run import SAMPLE_BYTES
from tui.words.numbers import about, file_size


def test_json_has_the_fields_of_the_design_and_the_numbers_of_the_engine():
    answer = pendu("run", "--time", 10, "--json").json
    assert answer.keys() == {"schema", "scene", "time", "steps", "wall_seconds", "methods"}
    assert (answer["schema"], answer["time"], answer["steps"]) == ("pendu.run/1", 10.0, 200)
    lockstep = Lockstep(DEFAULT_SCENE)
    lockstep.advance(200)
    plain = set(FIELDS) - {"log_energy_error", "max_invariant_error", *EXTRA_NAMES}
    for told, method, reading in zip(
        answer["methods"], USUAL_CAST, lockstep.sample().readings, strict=True
    ):
        assert told.keys() == {"method", "verdict", "progress", *plain}
        assert told["method"] == method.key
        assert (told["theta"], told["max_energy_error"]) == (
            reading.theta,
            reading.max_energy_error,
        )


def test_a_chaotic_method_has_its_lyapunov_number():
    chaos = ("run", "--theta", "0.3", "--h", "0.654514", "--time", 200)
    symplectic = pendu(*chaos, "--json").json["methods"][1]
    assert symplectic["verdict"] == "chaotic"
    assert 0.01 < symplectic["lyapunov_per_second"] * 0.654514 < 2
    seconds = about(math.log(10) / symplectic["lyapunov_per_second"])
    assert (
        f"Symplectic Euler is chaotic: nearby starts separate tenfold every {seconds}.\n"
        in pendu(*chaos).out
    )


def test_the_table_shows_which_method_gains_conserves_and_loses_energy():
    lines = pendu("run", "--time", 60).out.splitlines()
    for label, verdict in [
        ("Explicit Euler", "grows"),
        ("Symplectic Euler", "bounded"),
        ("Velocity Verlet", "bounded"),
        ("RK4", "loses"),
    ]:
        line = next(line for line in lines if line.startswith(label))
        assert verdict in line


@pytest.mark.parametrize("name", SCENES)
def test_every_scene_runs_and_its_json_has_no_nan(name):
    assert pendu("run", "--scene", name, "--time", 60, "--json").json["scene"]["name"] == name


@pytest.mark.parametrize(
    "start",
    [
        ("--omega", "1e8"),
        ("--theta", "1e6rad"),
        ("--h", "15.97"),
        ("--theta", "1e-300"),
        ("--theta", "0"),
    ],
)
def test_extreme_but_legal_starts_neither_crash_nor_print_nan(start):
    assert pendu("run", *start, "--time", "500", "--json").code == 0
    out = pendu("run", *start, "--time", "500").out
    assert "nan" not in out.replace("nance", "")
    assert "inf" not in out


def test_evaluations_that_vary_are_counted():
    rows = {
        row["method"]: row
        for row in pendu("run", "--scene", "halving", "--time", "20", "--json").json["methods"]
    }
    scene = SCENES["halving"]
    start = scene.theta, scene.omega
    for method in scene.cast:
        counted = count_evaluations(method, scene.equations, start, scene.h, 100)
        assert rows[method.key]["force_evaluations"] == counted
    assert rows["halving_verlet"]["force_evaluations"] != HALVING_VERLET.evaluations(100)


def test_a_diverged_method_is_reported_with_its_time():
    arguments = (
        "run",
        "--theta",
        "1e-150",
        "--time",
        "2000",
        "--methods",
        "explicit_euler",
    )  # so small that its growth overflows any relative error
    euler = pendu(*arguments, "--json").json["methods"][0]
    assert euler["theta_error"] is None
    assert 0 < euler["diverged_at"] < 2000
    assert euler["force_evaluations"] == round(euler["diverged_at"] / DEFAULT_SCENE.h)
    assert f"diverged at {euler['diverged_at']:g} s" in pendu(*arguments).out


def test_a_recording_has_the_same_bytes_each_time_and_verifies(tmp_path):
    one, two = tmp_path / "one.mcap", tmp_path / "two.mcap"
    for path in (one, two):
        assert pendu("run", "--scene", "spin", "--time", 5, "--record", path).code == 0
    assert one.read_bytes() == two.read_bytes()
    assert verify(one).identical
    assert verify(one).complete


def test_samples_are_as_far_apart_as_asked(tmp_path):
    pendu("run", "--time", 10, "--record", tmp_path / "run.mcap", "--sample-every", 50)
    with Recording.open(tmp_path / "run.mcap") as recording:
        assert recording.samples == 5  # at steps 0, 50, 100, 150, 200


def test_a_recording_is_not_overwritten_unless_by_force(tmp_path):
    path = tmp_path / "run.mcap"
    path.write_bytes(b"precious")
    assert pendu("run", "--time", 1, "--record", path).refused(5, "exists", "--force", str(path))
    assert path.read_bytes() == b"precious"
    assert pendu("run", "--time", 1, "--record", path, "--force").code == 0
    assert verify(path).identical


def test_the_size_of_a_large_recording_is_known_before_it_is_made(tmp_path):
    path, steps = tmp_path / "run.mcap", 4000
    told = pendu("run", "--time", steps * DEFAULT_SCENE.h, "--record", path).err  # it is not large
    assert told == f"pendu-tui: recorded 200 s, {file_size(path.stat().st_size)}: {path}\n"
    assert steps * SAMPLE_BYTES == pytest.approx(path.stat().st_size, rel=0.1)


@pytest.mark.parametrize("place", ["missing/run.mcap", "file/run.mcap"])
def test_a_folder_that_cannot_be_written_is_one_sentence_and_exit_5(tmp_path, place):
    (tmp_path / "file").touch()
    assert pendu("run", "--time", 1, "--record", tmp_path / place).refused(5, str(tmp_path))
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


@pytest.mark.parametrize(
    "arguments",
    [
        ("--h", "0"),
        ("--theta", "abc"),
        ("--scene", "drfit"),
        ("--time", "0"),
        ("--time", "nan"),
        ("--time", "0.01"),
        ("--time", "1e10"),
        ("--sample-every", "0"),
        ("--fail-if", "rk4.theta"),
        ("--fail-if", "rk5.theta > 1"),
    ],
)
def test_bad_input_is_one_sentence_and_exit_2_and_nothing_is_written(tmp_path, arguments):
    path = tmp_path / "run.mcap"
    assert pendu("run", "--time", "1", "--record", path, *arguments).refused(2)
    assert not list(tmp_path.iterdir())


def test_a_gate_that_holds_is_exit_1_and_the_numbers_are_printed():
    outcome = pendu(
        "run", "--time", 10, "--fail-if", "explicit_euler.max_energy_error > 1", "--json"
    )
    assert outcome.code == 1
    assert outcome.err.startswith(
        "pendu-tui: the check failed: explicit_euler.max_energy_error > 1 ("
    )
    assert outcome.err.endswith("is 5.54)\n")
    assert outcome.json["methods"][0]["max_energy_error"] > 1


def test_a_gate_may_ask_for_the_verdict():
    assert pendu("run", "--time", 100, "--fail-if", "rk4.verdict == loses").code == 1
    assert pendu("run", "--time", 100, "--fail-if", "velocity_verlet.verdict != bounded").code == 0
    assert pendu("run", "--time", 1, "--fail-if", "rk4.verdict == 'too early'").code == 1


@pytest.mark.skipif(not available(), reason="Numba is not installed")
def test_compiled_and_plain_runs_print_the_same_numbers(monkeypatch):
    monkeypatch.setattr("engine.run.compiled.COMPILED_FROM", 1)
    arguments = ("run", "--scene", "near-separatrix", "--time", 20, "--json")
    compiled, plain = pendu(*arguments).json, pendu(*arguments, "--no-compiled").json
    assert compiled["methods"] == plain["methods"]


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_run_that_is_stopped_finishes_its_recording(tmp_path, number):
    path = tmp_path / "run.mcap"
    arguments = ["run", "--time", "1e7", "--no-compiled", "--record", str(path)]
    process = subprocess.Popen(
        [*PENDU, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    part = Path(f"{path}.part")
    deadline = time.monotonic() + 60  # s; a second is usual
    while not (part.exists() and part.stat().st_size > 100_000) and time.monotonic() < deadline:
        time.sleep(0.02)
    os.kill(process.pid, number)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "--sample-every 320 would reduce it to 200 MB." in err
    assert "pendu-tui: interrupted at t = " in err
    assert "RK4" in out  # what was done is told
    result = verify(path)
    assert result.complete
    assert result.identical
    assert not part.exists()


def test_a_method_that_went_over_the_top_is_named_with_its_time():
    text = pendu("run", "--time", 10).out
    assert "Explicit Euler went over the top at 7.15 s" in text
    assert text.count("over the top") == 1


def test_a_bob_on_a_spring_has_the_energy_in_its_spring_and_nothing_else_has():
    rows = {
        row["method"]: row
        for row in pendu("run", "--scene", "stiff-slow", "--time", "5", "--json").json["methods"]
    }
    assert rows["imex_euler"]["spring_energy"] < 1e-4 < rows["rk4"]["spring_energy"] < 0.1
    assert rows["implicit_midpoint"]["spring_energy"] == pytest.approx(1, abs=0.1)
    others = pendu("run", "--time", "1", "--json").json["methods"]
    assert not {"spring_energy", "log_energy_error"} & set(others[0])


def test_with_friction_errors_are_logarithms_of_the_ratio_to_the_true_energy():
    rows = pendu("run", "--scene", "damped", "--time", "5", "--json").json["methods"]
    assert rows[0]["log_energy_error"] > 0.3 > abs(rows[3]["log_energy_error"])
    text = pendu("run", "--scene", "damped", "--time", "5").out
    assert "ln(E/E_true)" in text
    assert "energy error" not in text


def test_the_step_of_a_stiff_scene_is_given_in_units_of_its_springs_frequency():
    assert "z = h·omega_s = 1\n" in pendu("run", "--scene", "stiff-slow", "--time", "1").out


def test_other_mistakes_are_told_before_a_missing_time():
    assert pendu("run").refused(2, "--time is missing")
    assert pendu("run", "--fail-if", "rk5.verdict == grows").refused(2, "rk5")
    assert pendu("run", "--length", "-1").refused(2, "length")
