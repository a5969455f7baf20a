"""`pendu-tui accuracy`: a table, a recommendation, JSON and CSV with all digits."""

import csv
import re

import pytest

from pendu_tui.engine.methods import GENERAL, USUAL_CAST
from pendu_tui.engine.run.loops import PlainLoops
from pendu_tui.tui.views.accuracy import accuracy_chart
from tests.tui.command_line import own_method, pendu

QUICK = ("accuracy", "--time", "5", "--h-values", "0.2:0.01:4")


def test_all_methods_are_tried_for_a_target_and_points_are_the_same_in_every_process(tmp_path):
    answer = pendu(*QUICK, "--target", "1e-4", "--json").json
    points = answer["points"]
    assert [point["method"] for point in points] == [m.key for m in USUAL_CAST] * 4
    advice = answer["recommendation"]
    assert (advice["method"], answer["interrupted"]) == ("blanes_moan_4", False)
    assert len(advice["attempts"]) == len(GENERAL)
    file = tmp_path / "points.csv"
    assert pendu(*QUICK, "-o", file, "--workers", "2").code == 0
    rows = list(csv.DictReader(file.read_text(encoding="utf-8").splitlines()))
    assert [float(row["theta_error"]) for row in rows] == [point["theta_error"] for point in points]


@pytest.mark.parametrize(("terminal", "chart"), [(60, 60), (200, 100)])
def test_the_chart_is_as_wide_as_the_terminal_up_to_100_columns(terminal, chart, monkeypatch):
    monkeypatch.setenv("COLUMNS", str(terminal))
    axis = next(line for line in pendu(*QUICK).out.splitlines() if "└" in line)
    assert len(axis) == chart


def test_a_target_that_no_method_reaches_is_reported():
    asked = (*QUICK, "--target", "1e-17", "--methods", "euler-cromer,verlet")
    outcome = pendu(*asked, "--json")
    missed = "pendu-tui: no method reaches the target over 5 s.\n"
    assert (outcome.code, outcome.err) == (1, missed)
    answer = outcome.json["recommendation"]
    found = (answer["method"], answer["h"], answer["why_not"])
    assert found == (None, None, "no method reaches the target")
    assert "not within 20,000,000 evaluations" in pendu(*asked).out


@pytest.mark.parametrize(("ends", "word"), [("1e9:0.1", "1e+09"), ("0.1:1e-12", "1e-12")])
def test_an_absurd_step_size_is_refused_before_any_is_tried(ends, word, tmp_path, monkeypatch):
    monkeypatch.setattr("pendu_tui.tui.commands.accuracy.measured_point", None)
    (tmp_path / "taken.csv").touch()
    assert pendu("accuracy", "-o", tmp_path / "taken.csv").refused(5, "exists")
    assert pendu("accuracy", "--h-values", f"{ends}:3").refused(2, word)


@pytest.mark.parametrize(
    "start", ["--theta=1e-170", "--theta=1e6rad", "--theta=0 --omega=1e8", "--theta=180deg"]
)
def test_extreme_starts_print_numbers_and_no_nan(start):
    quick = ("accuracy", "--time", "1", "--h-values", "0.1:0.01:3", *start.split(), "--json")
    assert len(pendu(*quick).json["points"]) == 12  # its parser refuses nan


def test_over_seconds_the_series_is_one_of_the_methods_and_the_cheapest_takes_the_fewest(
    tmp_path, monkeypatch
):
    timed = []

    def compiled(method, model):
        timed.append(method.key)
        return PlainLoops(method, model)

    monkeypatch.setattr("pendu_tui.engine.run.loops.compiled", compiled)
    monkeypatch.setattr("pendu_tui.engine.studies.accuracy.TIMED_STEPS", 100)
    seconds = ("accuracy", "--cost", "seconds", "--time", "1", "--h-values", "0.1:0.05:2")
    asked = (*seconds, "--methods", "taylor_20,verlet,rk4", "--target", "1e-3")
    drawn = []

    def chart(series, *rest):
        drawn.extend(x for each in series if not each.dotted for x in each.x)
        return accuracy_chart(series, *rest)

    monkeypatch.setattr("pendu_tui.tui.commands.accuracy.accuracy_chart", chart)
    pendu(*seconds, "--methods", "rk4", "--method", own_method(tmp_path), "--csv")
    assert not timed  # all of them run without Numba, if one does
    out = pendu(*asked[:-2]).out
    assert "(0/step)" not in out
    assert all(0 < x < 1 for x in drawn)  # s, not evaluations
    assert timed == ["taylor_20", "velocity_verlet", "rk4"] * 2
    assert re.search(r" in \d+(\.\d+)? [µm]s +\d", out)
    assert re.search(r" evaluations +seconds +theta error +times the cheapest", pendu(*asked).out)
    answer = pendu(*asked, "--json").json
    series, _, rk4 = answer["points"][:3]
    assert (series["h"], series["force_evaluations"]) == (0.1, None)
    assert series["seconds"] > 0
    assert series["theta_error"] < 1e-14 < rk4["theta_error"]
    advice = answer["recommendation"]
    assert advice["seconds"] == min(attempt["seconds"] for attempt in advice["attempts"])
    rows = {row["method"]: row for row in advice["attempts"]}
    assert rows["taylor_20"]["force_evaluations"] is None
    steps = [rows[name]["steps_per_swing"] for name in ("taylor_20", "rk4", "velocity_verlet")]
    assert steps == sorted(steps)
    assert len(timed) == 6 + 2 * (6 + 3)  # points, and those of the search
