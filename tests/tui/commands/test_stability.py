import csv
import io
import math

import numpy as np
import pytest

from engine.methods import USUAL_CAST
from engine.scenes import SCENES, Scene
from engine.stability.grid import Grid
from engine.stability.outcomes import FATES, UNKNOWN
from engine.stability.study import amplitude
from tests.tui.command_line import pendu
from tui.cli.errors import Exit, UserError
from tui.cli.workers import Workers

SMALL = ("--steps", 300, "--z-values", "0.1:3:12", "--theta-values", "0.5,2")
KEYS = [method.key for method in USUAL_CAST]


def stops_after_5_z(monkeypatch: pytest.MonkeyPatch, error: BaseException) -> None:
    """Let a grid end with an error when 5 of its z are done."""

    def map_(self: Workers, function: object, tasks: list[Grid]):
        yield Grid(tasks[0].theta, tasks[0].z[:5], tasks[0].steps).cells()
        raise error

    monkeypatch.setattr(Workers, "map", map_)


def test_the_tables_show_theory_next_to_measurement():
    lines = pendu("stability", *SMALL).out.splitlines()
    (linear,) = (line.split() for line in lines if line.startswith("RK4") and "°" not in line)
    assert linear[1:3] == ["2.828427125", "2.828427125"]
    (row,) = (
        line.split()[2:]
        for line in lines
        if line.startswith("Velocity Verlet") and "28.65°" in line
    )
    # The scene's z = 0.1566 holds; the first rung beyond the limit is 2.209, 14.1 times that.
    assert row == ["28.65°", "2.473", "2.209", "0.705", "over", "the", "top", "14.1"]


def test_the_limit_for_a_tenth_of_the_steps_shows_how_it_moves_with_them():
    asked = ("stability", "--methods", "velocity_verlet,rk4", "--theta-values", "2")
    long, short = (
        pendu(*asked, "--steps", steps, "--json").json["pendulum"] for steps in (2000, 200)
    )
    assert [row["first_failure_z_early"] for row in long] == [
        row["first_failure_z"] for row in short
    ]
    assert (
        long[1]["first_failure_z"] < long[1]["first_failure_z_early"]
    )  # RK4 loses more in more steps


def test_a_swing_that_is_never_lost_has_null_and_a_hyphen():
    few = ("--steps", 5, "--z-values", "0.01,0.02", "--theta-values", "1", "--h", "0.005")
    assert {
        row["first_failure_z"] for row in pendu("stability", *few, "--json").json["pendulum"]
    } == {None}
    assert pendu("stability", *few).out.splitlines()[-1].split()[2:] == [*"-----"]


def test_the_map_as_json_repeats_the_engine():
    grid = Grid(np.array([0.5, 2.0]), np.linspace(0.1, 3, 12), 300)
    expected = grid.cells()
    answer = pendu("stability", *SMALL, "--json", "--map").json["map"]
    assert answer["theta"] == [0.5, 2.0]
    assert answer["z"] == pytest.approx(grid.z.tolist(), rel=1e-15)
    for index, told in enumerate(answer["methods"]):
        assert told["method"] == KEYS[index]
        assert told["steps_survived"] == expected["steps"][:, index].tolist()
        assert [[FATES.index(fate) for fate in row] for row in told["fate"]] == expected["fate"][
            :, index
        ].tolist()


@pytest.mark.parametrize("to_file", [False, True])
def test_csv_has_a_line_for_each_amplitude_or_with_the_map_for_each_swing(to_file, tmp_path):
    def rows(*more: str) -> list[dict[str, str]]:
        file = tmp_path / f"rows{len(more)}.csv"
        out = pendu("stability", *SMALL, *more, *(("-o", file) if to_file else ("--csv",))).out
        return list(csv.DictReader(io.StringIO(file.read_text() if to_file else out)))

    assert len(rows()) == 4 * 2
    assert len(rows("--map")) == 4 * 12 * 2
    assert {row["fate"] for row in rows("--map", "--force")} <= set(FATES)


def test_the_map_is_drawn_in_characters_where_there_is_no_colour():
    out = pendu("stability", *SMALL, "--map").out
    assert "\x1b" not in out
    assert all(title in out for title in ("1 e Explicit Euler", "3 v Velocity Verlet", "4 r RK4"))
    assert "| linear limit" in out


def test_a_map_in_a_file_is_the_map(tmp_path):
    file = tmp_path / "map.npz"
    assert pendu("stability", *SMALL, "-o", file).code == 0
    with np.load(file) as map_:
        assert map_["methods"].tolist() == KEYS
        assert map_["fates"].tolist() == list(FATES)
        expected = Grid(map_["theta"], map_["z"], int(map_["steps"])).cells()
        assert map_["cells"].tobytes() == expected.tobytes()
    assert list(tmp_path.iterdir()) == [file]


def test_ctrl_c_keeps_the_part_of_a_map_that_is_done(monkeypatch, tmp_path):
    stops_after_5_z(monkeypatch, KeyboardInterrupt())
    file = tmp_path / "map.npz"
    outcome = pendu("stability", *SMALL, "-o", file)
    assert outcome.code == 130
    assert "5 of 12 z" in outcome.err
    with np.load(file) as map_:
        assert (map_["cells"]["fate"][:5] != UNKNOWN).all()
        assert (map_["cells"]["fate"][5:] == UNKNOWN).all()


def test_lost_workers_end_with_exit_3_and_what_is_done_is_kept(monkeypatch):
    stops_after_5_z(monkeypatch, UserError("the workers are lost.", Exit.INPUT_UNREADABLE))
    outcome = pendu("stability", *SMALL, "--json")
    assert (outcome.code, outcome.json["interrupted"]) == (3, True)
    assert outcome.err == "pendu-tui: the workers are lost; 5 of 13 z are computed and kept.\n"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--theta-values", "4"), ("amplitude 4", "3.14159")),
        (("--theta-values", "abc"), ("abc", "angle")),
        (("--z-values", "nan"), ("z nan",)),
        (("--z-values", "3:1:10"), ("3:1:10", "FIRST:LAST:HOW_MANY")),
        (("--steps", "3000000000"), ("steps",)),
        (("--json", "--csv"), ("not allowed",)),
        (("--workers", "2", "--dask", "tcp://x:1"), ("not allowed",)),
        (("--map", "--z-values", "0.1:3:3000", "--theta-values", "0.1:3:2000"), ("24008000",)),
        (("--theta-values", "0.1:3:10001"), ("32523252",)),
        (("--section", "--csv"), (".svg",)),
        (("-o", "map.txt"), ("--section",)),
        (("--map", "--section"), ("not allowed",)),
    ],
)
def test_impossible_values_are_refused_in_one_sentence(arguments, words):
    assert pendu("stability", *arguments).refused(2, *words)


def test_the_amplitude_of_a_scene_is_how_far_it_swings():
    assert amplitude(Scene(theta=1.0)) == 1.0
    assert amplitude(Scene(theta=-1.0)) == 1.0
    moving = Scene(theta=0.0, omega=2.0)  # omega²/2 = w0² (1 - cos amplitude)
    assert math.cos(amplitude(moving)) == pytest.approx(1 - 2 / moving.w0_squared, rel=1e-12)
    assert amplitude(SCENES["spin"]) is None
    assert amplitude(Scene(theta=0.0)) is None


def test_of_the_linear_oscillator_there_are_the_lines_of_theory_and_a_sentence():
    out = pendu("stability", "--scene", "linear").out
    for method in USUAL_CAST:
        (line,) = (line for line in out.splitlines() if line.startswith(method.label))
        limit = f"{method.linear_limit:.9f}" if method.linear_limit else "none"
        assert line.split()[-3:-1] == [limit, limit]
    assert "°" not in out
    answer = pendu("stability", "--scene", "linear", "--json").json
    assert (answer["pendulum"], answer["map"]) == ([], None)
    assert [row["limit_z"] for row in answer["linear"]] == pytest.approx(
        [m.linear_limit for m in USUAL_CAST], abs=1e-9
    )


def test_a_start_that_is_no_amplitude_is_given_one():
    out = pendu("stability", "--theta", "200deg", "--methods", "verlet", "--steps", 20).out
    assert "200 deg swings as far as one from rest at 160 deg" in out
    (row,) = (line.split() for line in out.splitlines() if " 160° " in line)
    assert float(row[-1]) == pytest.approx(float(row[4]) / 0.1566, rel=2e-3)  # the margin
