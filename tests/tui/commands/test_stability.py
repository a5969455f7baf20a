import csv
import io
import math
import sys
import tracemalloc

import numpy as np
import pytest

from engine.methods import USUAL_CAST
from engine.scenes import SCENES, Scene
from engine.stability.grid import Grid
from engine.stability.outcomes import FATES, UNKNOWN
from engine.stability.study import StabilityStudy, amplitude
from tests.tui.command_line import pendu

SMALL = ("--steps", 300, "--z-values", "0.1:3:12", "--theta-values", "0.5,2")
KEYS = [method.key for method in USUAL_CAST]


@pytest.fixture
def interrupted(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ctrl+C is pressed when 5 of the map's z are done."""

    def compute(grid: Grid, executor: object = None):
        yield Grid(grid.theta, grid.z[:5], grid.steps).cells()
        raise KeyboardInterrupt

    monkeypatch.setattr(Grid, "compute", compute)


def test_the_tables_show_theory_next_to_measurement():
    out = pendu("stability", *SMALL).out
    assert "RK4                         2.828427125  2.828427125" in out
    assert "Explicit Euler                     none         none" in out
    (row,) = (line for line in out.splitlines() if line.startswith("Velocity Verlet") and "28.65 deg" in line)
    # The scene's z = 0.1566 holds; the first rung beyond the limit is 2.209, 14.1 times that.
    expected = "Velocity Verlet 28.65 deg 2.473 2.209 0.705 over the top 59 held 14.1"  # 59: steps survived
    assert " ".join(row.split()) == expected


def test_the_limit_for_a_tenth_of_the_steps_shows_how_it_moves_with_them():
    asked = ("stability", "--methods", "velocity_verlet,rk4", "--theta-values", "2")
    long, short = (pendu(*asked, "--steps", steps, "--json").json["pendulum"] for steps in (2000, 200))
    assert [row["first_failure_z_early"] for row in long] == [row["first_failure_z"] for row in short]
    assert long[1]["first_failure_z"] < long[1]["first_failure_z_early"]  # RK4 loses more in more steps
    out = pendu(*asked, "--steps", 2000).out
    assert "within 2,000 steps it goes over the top" in out
    assert "lost from z, 200 steps  2,000 steps" in out


def test_json_has_the_fields_of_the_design():
    answer = pendu("stability", *SMALL, "--json").json
    assert answer["schema"] == "pendu.stability/1"
    assert answer["map"] is None
    for linear, method in zip(answer["linear"], USUAL_CAST, strict=True):
        assert linear["method"] == method.key
        assert linear["limit_z"] == pytest.approx(linear["theory_z"], abs=1e-9)
    assert [(row["method"], row["theta"]) for row in answer["pendulum"]] == [(k, t) for k in KEYS for t in (0.5, 2.0)]
    for row in answer["pendulum"]:
        assert row["reason"] in ("over the top", "grows", "loses", "chaotic")
        assert row["first_failure_z"] > 0
        assert row["at_scene"]["fate"] in FATES


def test_the_scenes_own_swing_and_step_are_tried():
    answer = pendu("stability", "--scene", "large-swing", "--h", "0.5", "--steps", 50, "--json").json
    (row,) = (r for r in answer["pendulum"] if r["method"] == "velocity_verlet" and r["theta"] == 2.5)
    assert answer["z"] == pytest.approx(0.5 * math.sqrt(9.81))
    assert row["at_scene"]["fate"] == "over the top"
    assert row["first_failure_z"] < answer["z"]


def test_a_swing_that_is_never_lost_has_null_and_a_hyphen():
    few = ("--steps", 5, "--z-values", "0.01,0.02", "--theta-values", "1", "--h", "0.005")
    assert {row["first_failure_z"] for row in pendu("stability", *few, "--json").json["pendulum"]} == {None}
    assert pendu("stability", *few).out.splitlines()[-1].split()[2:] == ["deg", *"-----", "held", "-"]


def test_the_map_as_json_repeats_the_engine():
    grid = Grid(np.array([0.5, 2.0]), np.linspace(0.1, 3, 12), 300)
    expected = grid.cells()
    answer = pendu("stability", *SMALL, "--json", "--map").json["map"]
    assert answer["theta"] == [0.5, 2.0]
    assert answer["z"] == pytest.approx(grid.z.tolist(), rel=1e-15)
    for index, told in enumerate(answer["methods"]):
        assert told["method"] == KEYS[index]
        assert told["steps_survived"] == expected["steps"][:, index].tolist()
        assert [[FATES.index(fate) for fate in row] for row in told["fate"]] == expected["fate"][:, index].tolist()


def test_csv_has_a_line_for_each_amplitude_or_with_the_map_for_each_swing():
    rows = list(csv.DictReader(io.StringIO(pendu("stability", *SMALL, "--csv").out)))
    assert len(rows) == 4 * 2
    rows = list(csv.DictReader(io.StringIO(pendu("stability", *SMALL, "--csv", "--map").out)))
    assert len(rows) == 4 * 12 * 2
    assert {row["fate"] for row in rows} <= set(FATES)
    assert rows[0]["method"] == "explicit_euler"


def test_the_map_is_drawn_in_characters_where_there_is_no_colour():
    out = pendu("stability", *SMALL, "--map").out
    assert "\x1b" not in out
    assert max(map(len, out.splitlines())) <= 120
    assert all(title in out for title in ("1 e Explicit Euler", "3 v Velocity Verlet", "4 r RK4"))
    assert "| linear limit" in out


def test_the_map_is_drawn_in_half_blocks_where_there_is(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("COLORTERM", "truecolor")
    monkeypatch.delenv("NO_COLOR", raising=False)
    out = pendu("stability", *SMALL, "--map").out
    assert "▀" in out
    assert "\x1b[" in out


def test_worker_processes_print_the_same_to_the_last_bit():
    arguments = ("stability", *SMALL, "--json", "--map")
    assert pendu(*arguments, "--workers", 2).out == pendu(*arguments).out


def test_a_dask_cluster_prints_the_same_to_the_last_bit():
    distributed = pytest.importorskip("distributed")
    arguments = ("stability", *SMALL, "--json", "--map")
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, host="127.0.0.1", dashboard_address=None
    ) as cluster:
        assert pendu(*arguments, "--dask", cluster.scheduler_address).out == pendu(*arguments).out


def test_a_map_in_a_file_is_the_map(tmp_path):
    file = tmp_path / "map.npz"
    assert pendu("stability", *SMALL, "-o", file).code == 0
    with np.load(file) as map_:
        assert map_["methods"].tolist() == KEYS
        assert map_["fates"].tolist() == list(FATES)
        expected = Grid(map_["theta"], map_["z"], int(map_["steps"])).cells()
        assert map_["cells"].tobytes() == expected.tobytes()
    assert list(tmp_path.iterdir()) == [file]


def test_ctrl_c_keeps_the_part_of_a_map_that_is_done(interrupted, tmp_path):
    file = tmp_path / "map.npz"
    outcome = pendu("stability", *SMALL, "-o", file)
    assert outcome.code == 130
    assert "5 of the map's 12 z" in outcome.err
    with np.load(file) as map_:
        assert (map_["cells"]["fate"][:5] != UNKNOWN).all()
        assert (map_["cells"]["fate"][5:] == UNKNOWN).all()
    outcome = pendu("stability", *SMALL, "--csv", "--map")
    assert outcome.code == 130
    assert len(outcome.out.splitlines()) == 1 + 4 * 5 * 2


def test_ctrl_c_during_the_tables_keeps_the_swings_already_lost(interrupted):
    outcome = pendu("stability", *SMALL, "--json")
    assert outcome.code == 130
    assert "interrupted; swings already found lost are kept." in outcome.err
    assert outcome.json["interrupted"]
    rows = outcome.json["pendulum"]
    assert {(row["method"], row["theta"]) for row in rows} >= {("explicit_euler", 0.5), ("explicit_euler", 2.0)}
    assert all(row["first_failure_z"] < 1 for row in rows)
    assert all(row["at_scene"]["fate"] in FATES for row in rows)
    table = pendu("stability", *SMALL)
    assert (table.code, table.err) == (130, outcome.err)
    assert table.out.count(" deg ") == len(rows)
    listed = pendu("stability", *SMALL, "--csv")
    assert (listed.code, len(listed.out.splitlines())) == (130, 1 + len(rows))


def test_interrupted_before_the_scenes_z_its_cell_is_null(interrupted):
    late = ("--h", "0.9", *SMALL)
    assert {row["at_scene"] for row in pendu("stability", *late, "--json").json["pendulum"]} == {None}
    assert pendu("stability", *late).out.splitlines()[-1].split()[-2] == "-"


def test_a_table_of_many_amplitudes_takes_the_memory_of_a_strip():
    tracemalloc.start()
    rows, whole = StabilityStudy(Scene(), np.linspace(0.1, 3, 1000).tolist(), steps=1).table()
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert whole
    assert len(rows) == 4000
    # The cells of all 813 z would be 813 * 4 * 1000 * 16 bytes = 52 MB, and twice that when they are joined.
    assert peak < 12e6


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--theta-values", "4"), ("amplitude 4", "3.14159")),
        (("--theta-values", "0"), ("amplitude 0",)),
        (("--theta-values", "abc"), ("abc", "angle")),
        (("--z-values", "0"), ("z 0",)),
        (("--z-values", "nan"), ("z nan",)),
        (("--z-values", "3:1:10"), ("3:1:10", "FIRST:LAST:HOW_MANY")),
        (("--z-values", "1:2:1"), ("1:2:1",)),
        (("--z-values", "1:2"), ("1:2",)),
        (("--z-values", ""), ("number",)),
        (("--steps", "0"), ("count",)),
        (("--steps", "3000000000"), ("steps",)),
        (("--workers", "0"), ("count",)),
        (("--json", "--csv"), ("not allowed",)),
        (("--workers", "2", "--dask", "tcp://x:1"), ("not allowed",)),
        (("--map", "--z-values", "0.1:3:2000", "--theta-values", "0.1:3:2000"), ("16000000", "-o FILE.npz")),
        (("--theta-values", "0.1:3:10001"), ("10001 amplitudes", "-o FILE.npz")),
        (("--h", "0"), ("h = 0",)),
    ],
)
def test_impossible_values_are_refused_in_one_sentence(arguments, words):
    assert pendu("stability", *arguments).refused(2, *words)


def test_dask_without_its_package_says_what_to_install(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert pendu("stability", "--dask", "tcp://127.0.0.1:1").refused(2, ".[cluster]")


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
    assert "the linear oscillator itself: these limits hold at every amplitude" in out
    assert "Pendulum:" not in out
    answer = pendu("stability", "--scene", "linear", "--json").json
    assert (answer["pendulum"], answer["map"]) == ([], None)
    assert [row["limit_z"] for row in answer["linear"]] == pytest.approx([m.linear_limit for m in USUAL_CAST], abs=1e-9)


@pytest.mark.parametrize(
    "words", [("--map",), ("--csv",), ("-o", "map.npz"), ("--theta-values", "1"), ("--z-values", "1")], ids=" ".join
)
def test_what_is_only_about_a_pendulum_says_so_of_the_linear_oscillator(words):
    assert pendu("stability", "--scene", "linear", *words).refused(2, f"{words[0]} is about a pendulum", "leave out")


def test_the_words_above_the_table_say_what_a_margin_is_and_which_amplitude_a_start_has():
    out = pendu("stability", "--theta", "200deg", "--methods", "verlet", "--steps", 20).out
    assert "The start at 200 deg swings as far as one from rest at 160 deg: its amplitude." in out
    assert "Margin: the limit over the scene's z, 0.1566; below 1 a swing of that amplitude is past its limit." in out
    (row,) = (line.split() for line in out.splitlines() if " 160 deg " in line)
    assert float(row[-1]) == pytest.approx(float(row[5]) / 0.1566, rel=2e-3)
    assert "as far as" not in pendu("stability", "--methods", "verlet", "--steps", 20).out
