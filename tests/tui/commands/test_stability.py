"""`pendu-tui stability`: tables, maps, and --section, a method's own map."""

import csv
import io

import numpy as np
import pytest

from pendu_tui.engine.methods import USUAL_CAST
from pendu_tui.engine.stability.grid import Grid
from pendu_tui.engine.stability.outcomes import FATES, UNKNOWN
from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.workers import Workers
from tests.tui.command_line import own_method, pendu

SMALL = ("stability", "--steps", 300, "--z-values", "0.1:3:12", "--theta-values", "0.5,2")
KEYS = [method.key for method in USUAL_CAST]


def stops_after_5_z(monkeypatch, error):
    def map_(self, function, tasks):
        yield Grid(tasks[0].theta, tasks[0].z[:5], tasks[0].steps).cells()
        raise error

    monkeypatch.setattr(Workers, "map", map_)


def line_of(out, *words):
    (line,) = (line for line in out.splitlines() if all(word in line for word in words))
    return line.split()


def test_the_tables_show_theory_next_to_measurement():
    out = pendu(*SMALL).out
    assert line_of(out, "RK4", "2.82")[1:3] == ["2.828427125", "2.828427125"]
    # The scene's z = 0.1566 holds; the first rung beyond the limit is 2.209, 14.1 times that.
    row = "28.65° 2.473 2.209 0.705 over the top 14.1"
    assert " ".join(line_of(out, "Velocity Verlet", "28.65°")[2:]) == row


def test_a_swing_that_is_never_lost_has_null_and_a_hyphen():
    few = ("stability", "--steps", 5, "--z-values", "0.01,0.02", "--theta-values", 1, "--h", 0.005)
    rows = pendu(*few, "--json").json["pendulum"]
    assert {row["first_failure_z"] for row in rows} == {None}
    assert pendu(*few).out.splitlines()[-1].split()[2:] == [*"-----"]


def test_the_map_as_json_and_as_file_repeats_the_engine(tmp_path):
    file = tmp_path / "map.npz"
    assert pendu(*SMALL, "-o", file).code == 0
    with np.load(file) as map_:
        assert map_["methods"].tolist() == KEYS
        assert map_["fates"].tolist() == list(FATES)
        expected = Grid(map_["theta"], map_["z"], int(map_["steps"])).cells()
        assert map_["cells"].tobytes() == expected.tobytes()
        z = map_["z"].tolist()
    answer = pendu(*SMALL, "--json", "--map").json["map"]
    assert (answer["theta"], answer["z"]) == ([0.5, 2.0], z)
    for index, cells in enumerate(answer["methods"]):
        assert cells["method"] == KEYS[index]
        assert cells["steps_survived"] == expected["steps"][:, index].tolist()
        assert cells["fate"] == np.array(FATES)[expected["fate"][:, index]].tolist()


@pytest.mark.parametrize(("more", "lines"), [((), 4 * 2), (("--map",), 4 * 12 * 2)])
def test_csv_has_a_line_for_each_amplitude_or_with_the_map_for_each_swing(more, lines):
    out = pendu(*SMALL, *more, "--csv").out
    assert len(list(csv.DictReader(io.StringIO(out)))) == lines


def test_the_map_is_drawn_in_characters_where_there_is_no_colour():
    out = pendu(*SMALL, "--map").out
    assert "\x1b" not in out
    assert all(title in out for title in ("1 e Explicit Euler", "4 r RK4", "| linear limit"))


def test_ctrl_c_and_lost_workers_keep_the_part_that_is_done(monkeypatch, tmp_path):
    stops_after_5_z(monkeypatch, KeyboardInterrupt())
    outcome = pendu(*SMALL, "-o", tmp_path / "map.npz")
    assert outcome.code == 130
    assert "5 of 12 z" in outcome.err
    with np.load(tmp_path / "map.npz") as map_:
        known = (map_["cells"]["fate"] != UNKNOWN).all(axis=(1, 2))
        assert known.tolist() == [True] * 5 + [False] * 7
    stops_after_5_z(monkeypatch, UserError("the workers are lost.", Exit.INPUT_UNREADABLE))
    outcome = pendu(*SMALL, "--json")
    assert (outcome.code, outcome.json["interrupted"]) == (3, True)
    assert outcome.err == "pendu-tui: the workers are lost; 5 of 13 z are computed and kept.\n"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--theta-values", "4"), ("amplitude 4", "3.14159")),
        (("--z-values", "nan"), ("z nan",)),
        (("--steps", "3000000000"), ("steps",)),
        (("--map", "--z-values", "0.1:3:3000", "--theta-values", "0.1:3:2000"), ("24008000",)),
        (("--scene", "linear", "--map"), ("linear oscillator", "--map")),
        (("--section", "--csv"), (".svg",)),
        (("--section", "--starts", "200000"), ("too large", "1e+08")),
    ],
)
def test_impossible_values_are_refused_in_one_sentence(arguments, words):
    assert pendu("stability", *arguments).refused(2, *words)


def test_of_the_linear_oscillator_there_are_the_lines_of_theory_and_a_sentence():
    out = pendu("stability", "--scene", "linear").out
    for method in USUAL_CAST:
        limit = f"{method.linear_limit:.9f}" if method.linear_limit else "none"
        assert line_of(out, method.label)[-3:-1] == [limit, limit]
    assert "°" not in out


def test_a_start_that_is_no_amplitude_is_given_one():
    def out(*start):
        return pendu("stability", *start, "--methods", "verlet", "--steps", 20).out

    beyond = out("--theta", "200deg")
    assert "200 deg swings as far as one from rest at 160 deg" in beyond
    row = line_of(beyond, " 160° ")
    assert float(row[-1]) == pytest.approx(float(row[4]) / 0.1566, rel=2e-3)  # the margin
    # omega²/2 = w0² (1 - cos amplitude)
    assert "one from rest at 37.24 deg" in out("--theta", "0", "--omega", "2")
    assert line_of(out("--theta", "5.73deg"), " 5.73° ")
    assert "does not swing" in out("--theta", "0")
    assert "does not swing" in out("--scene", "spin")


def section(*arguments):
    return pendu("stability", "--section", *arguments)


ISLANDS = ("--theta", "1.25", "--h", "0.348011")  # at the 1:6 resonance of velocity Verlet


def test_the_portrait_is_as_wide_as_the_terminal_and_the_table_has_the_orbits(monkeypatch):
    monkeypatch.setenv("COLUMNS", "90")
    lines = section(*ISLANDS, "--starts", 40).out.splitlines()
    end = next(number for number, line in enumerate(lines) if line.startswith("-pi"))
    assert 80 < max(map(len, lines[1 : end + 1])) <= 90
    rows = {line[:17].strip(): line[17:].split() for line in lines[end + 3 : -2]}
    assert rows["Velocity Verlet"][:5] == ["islands", "1:6", "0.1666667", "6", "1:6"]
    assert rows["RK4"][:2] == ["spirals", "inwards"]
    assert rows["Explicit Euler"][:5] == ["spirals", "outwards", "-", "-", "-"]


def test_json_has_the_rotation_numbers_and_lyapunov_numbers_of_the_start():
    (islands,) = section(*ISLANDS, "--methods", "verlet", "--json").json["orbits"]
    assert islands["rotation"] == pytest.approx(1 / 6, abs=1e-9)
    assert (islands["fraction"], islands["island"], islands["chaotic"]) == ("1:6", True, False)
    assert 0 < islands["lyapunov"] < 0.01
    sea = ("--theta", "2.3", "--h", "0.351203")
    (chaotic,) = section(*sea, "--methods", "verlet", "--json").json["orbits"]
    assert (chaotic["rotation"], chaotic["fraction"], chaotic["chaotic"]) == (None, None, True)


def test_one_may_draw_a_method_of_ones_own(tmp_path):
    own = ("--method", own_method(tmp_path))
    theirs, mine = section(*ISLANDS, *own, "--methods", "symplectic_euler", "--json").json["orbits"]
    assert (theirs["method"], mine["method"]) == ("symplectic_euler", "mine")
    assert {**mine, "method": ""} == {**theirs, "method": ""}  # the same formulas
