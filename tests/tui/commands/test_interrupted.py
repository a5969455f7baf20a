"""Studies that are interrupted give what they have."""

from contextlib import nullcontext

import pytest

from tests.tui.command_line import pendu

STABILITY = ("stability", "--steps", 300, "--z-values", "0.1:3:12", "--theta-values", "0.5,2")
RUNS = ("run", "--theta", "10deg:170deg:3", "--h", "0.05,0.1", "--time", 2)
ACCURACY = ("accuracy", "--time", 5, "--h-values", "0.2:0.05:3")


@pytest.mark.parametrize(
    ("command", "rows", "share", "field", "count"),
    [
        (RUNS, 4, "17 % of the runs", "runs", 4),
        (STABILITY, 6, "6 % of the swings", "pendulum", 2),
        (ACCURACY, 1, "4 % of", "points", 1),
    ],
)
def test_an_interrupt_keeps_what_is_done(monkeypatch, command, rows, share, field, count):
    monkeypatch.setattr("pendu_tui.engine.studies.stability.PART", 6)

    def run(function, tasks):
        yield function(next(iter(tasks)))
        raise KeyboardInterrupt

    monkeypatch.setattr("pendu_tui.tui.cli.workers.workers_of", lambda _: nullcontext(run))
    outcome = pendu(*command, "--csv")
    assert (outcome.code, outcome.out.count("\n")) == (130, 1 + rows)
    assert share in outcome.err
    answer = pendu(*command, "--json").json
    assert (answer["interrupted"], len(answer[field])) == (True, count)


def test_the_search_for_a_target_counts_in_the_progress_but_is_not_kept(monkeypatch):
    def least_cost(*_, show, **more):
        show(0.5)
        raise KeyboardInterrupt

    shown = []
    bar = nullcontext(lambda *done: shown.append(done))
    monkeypatch.setattr("pendu_tui.tui.cli.workers.progress", lambda _: bar)
    monkeypatch.setattr("pendu_tui.tui.commands.accuracy.least_cost", least_cost)
    outcome = pendu(*ACCURACY, "--target", "1e-3", "--methods", "rk4,verlet", "--json")
    assert (outcome.code, outcome.json["recommendation"]) == (130, None)
    assert "50 % of the steps are done and kept" in outcome.err
    assert [done / whole for done, whole in shown[-2:]] == [0.5, 0.75]
