"""`pendu-tui stability`: tables and maps."""

import csv
import io

import numpy as np
import pytest

from pendu_tui.engine.methods import USUAL_CAST
from pendu_tui.engine.studies.stability import FATES, Grid
from tests.tui.command_line import pendu

SMALL = ("stability", "--steps", 300, "--z-values", "0.1:3:12", "--theta-values", "0.5,2")
KEYS = [method.key for method in USUAL_CAST]


def line_of(out, *words):
    (line,) = (line for line in out.splitlines() if all(word in line for word in words))
    return line.split()


def test_a_swing_that_is_never_lost_has_null_and_a_hyphen():
    few = ("stability", "--steps", 5, "--z-values", "0.01,0.02", "--theta-values", 1, "--h", 0.005)
    answer = pendu(*few, "--json").json
    assert answer["steps"] == 5
    rows = answer["pendulum"]
    assert {row["first_failure_z"] for row in rows} == {None}
    assert pendu(*few).out.splitlines()[-1].split()[2:] == [*"----"]


def rows_of(text):
    return list(csv.DictReader(io.StringIO(text)))


def test_csv_repeats_the_engine_with_a_line_for_each_swing(tmp_path):
    file = tmp_path / "map.csv"
    assert pendu(*SMALL, "-o", file).code == 0
    rows = rows_of(file.read_text(encoding="utf-8"))
    assert pendu(*SMALL, "--csv").out == file.read_text(encoding="utf-8")
    zs = np.unique([float(row["z"]) for row in rows])
    assert zs == pytest.approx(np.linspace(0.1, 3, 12))
    cells = Grid(np.array([0.5, 2.0]), zs, 300).cells().transpose(1, 0, 2)
    places = [(key, z, theta) for key in KEYS for z in zs for theta in (0.5, 2.0)]
    assert places == [(row["method"], float(row["z"]), float(row["theta"])) for row in rows]
    assert [row["fate"] for row in rows] == [FATES[fate] for fate in cells["fate"].flat]
    assert [int(row["steps_survived"]) for row in rows] == cells["steps"].ravel().tolist()
    assert [float(row["max_energy_error"]) for row in rows] == cells["error"].ravel().tolist()
    survived = {(row["method"], row["z"], row["theta"]): row["steps_survived"] for row in rows}
    for row in pendu(*SMALL, "--json").json["pendulum"]:
        place = (row["method"], str(row["first_failure_z"]), str(row["theta"]))
        if place in survived:
            assert str(row["steps_survived"]) == survived.pop(place)
    assert len(survived) < len(rows)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--theta-values", "4"), ("--theta-values", "3.14159")),
        (("--z-values", "nan"), ("--z-values",)),
        (("--steps", "3000000000"), ("--steps", "2.14748e+09")),
        (("--scene", "linear"), ("linear oscillator", "pendu-tui methods")),
    ],
)
def test_impossible_values_are_refused_in_one_sentence(arguments, words):
    assert pendu("stability", *arguments).refused(2, *words)


def test_a_start_that_is_no_amplitude_is_given_one():
    def out(*start):
        return pendu("stability", *start, "--methods", "verlet", "--steps", 20).out

    row = line_of(out("--theta", "200deg"), " 160° ")
    assert float(row[-1]) == pytest.approx(float(row[3]) / 0.1566, rel=2e-3)  # the margin
    # omega²/2 = w0² (1 - cos amplitude)
    assert line_of(out("--theta", "0", "--omega", "2"), " 37.24° ")
    assert line_of(out("--theta", "5.73deg"), " 5.73° ")
    amplitudes = [out(*start).count("°") for start in (("--theta", "0"), ("--scene", "spin"))]
    assert amplitudes == [5, 5]
