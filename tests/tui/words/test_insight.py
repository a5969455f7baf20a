"""Which insight is chosen, and its numbers, compared with what the methods do."""

import math
from types import SimpleNamespace

import pytest

from pendu_tui.engine.methods import RK4 as RK4_METHOD
from pendu_tui.engine.methods import USUAL_CAST
from pendu_tui.engine.run.lockstep import Lockstep
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.run.verdicts import Judgement
from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.drawing.picture import TEXT
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.words.insight import (
    FRESH,
    TURN,
    Insight,
    bounded,
    drift,
    forecast,
    insight,
    insight_text,
    irregular,
    lasting,
    milestone_insight,
    painted,
    sentence,
)
from tests.tui.harness import FPS, Lab, after

DRIFT = SCENES["drift"]
EXPLICIT, SYMPLECTIC, VERLET, RK4 = range(4)


def letters(found: Insight) -> str:
    return "".join(method.letter for method in found.methods)


def test_the_first_minute_of_the_default_scene():
    lab = Lab(DRIFT)
    chosen = []
    for _ in range(46):
        chosen.append((insight(lab.live).kind, letters(insight(lab.live))))
        lab.run(1)
    assert chosen[5] == ("watch", "")
    assert chosen[8] == ("over the top", "e")
    assert chosen[18] == ("bounded", "sv")
    # Explicit Euler, which the scene's sentence names, is gone
    assert {kind for kind, _ in chosen[20:]} <= {"bounded", "will pass", "over the top"}


@pytest.mark.parametrize("speed", [0.5, 16.0])
def test_news_stays_equally_long_at_any_speed(speed):
    lab = Lab(DRIFT, speed)
    seen = 0
    while lab.live.sample.t < 7.15 + FRESH * speed + 1:
        lab.run(1 / FPS)
        happened = any(each.kind == "over the top" for each in lab.live.milestones)
        seen += happened and insight(lab.live).kind == "over the top"
    # a frame at each end, and a step
    assert seen / FPS == pytest.approx(FRESH, abs=2 / FPS + 0.05 / speed)


def test_lasting_insights_take_turns():
    lab = Lab(DRIFT)
    lab.run(40)
    known = [each.kind for each in lasting(lab.live)]
    shown = []
    for _ in known:
        lab.run(TURN)
        shown.append(insight(lab.live).kind)
    assert sorted(shown) == sorted(known)


def test_the_energy_at_the_top_is_that_of_the_milestone():
    (top,) = (each for each in after(DRIFT, 8).milestones if each.kind == "over the top")
    lockstep = Lockstep(DRIFT)
    lockstep.advance(top.step)
    assert top.energy_error == lockstep.sample().readings[EXPLICIT].energy_error
    found = milestone_insight(top)
    assert (found.values["t"], found.values["ratio"]) == (top.t, 1 + top.energy_error)
    assert milestone_insight(top, conserved=False).values["ratio"] == math.exp(top.energy_error)
    assert "5.1" in found.values["energy"]
    assert milestone_insight(top._replace(energy_error=0.04)).values["energy"] == ""
    assert "1.1" in milestone_insight(top._replace(energy_error=0.06)).values["energy"]


@pytest.mark.parametrize(
    ("name", "h", "seconds"),
    [
        ("drift", 0.05, 20),
        ("drift", 0.1, 40),
        ("gentle", 0.1, 40),
        ("spin", 0.05, 20),
    ],
)
def test_a_forecast_comes_true_in_a_long_run(name, h, seconds):
    scene = SCENES[name].altered(h=h)
    live = after(scene, seconds)
    wait, other = forecast(live, RK4)
    band = live.sample.readings[USUAL_CAST.index(other)].max_energy_error
    assert abs(live.sample.readings[RK4].energy_error) < band
    lockstep = Lockstep(scene)
    while (sample := lockstep.sample()).readings[RK4].max_energy_error <= band:
        lockstep.advance(round(0.01 * wait / h))
        assert lockstep.t < seconds + 2 * wait
    assert sample.t - seconds == pytest.approx(wait, rel=0.08)  # the drift changes with the energy


@pytest.mark.parametrize(
    ("scene", "seconds", "index"),
    [
        ("drift", 5, RK4),  # undecided for a verdict
        ("drift", 40, EXPLICIT),  # grows ever faster
        ("drift", 40, VERLET),  # stays
        ("near-separatrix", 200, RK4),  # the period depends on the energy
    ],
)
def test_there_is_no_forecast_where_it_would_be_a_guess(scene, seconds, index):
    assert forecast(after(SCENES[scene], seconds), index) is None
    live = after(DRIFT, 20)
    live.change(Stepping(0.1))
    live.step(400)
    assert live.judgements[RK4].verdict == "loses"
    assert forecast(live, RK4) is None  # the band of this h is not known


def judged(live: Live, index: int, error: float | None = None, **changes) -> SimpleNamespace:
    """A lab, with another judgement on a method and perhaps another energy error of it."""
    judgements, readings = [*live.judgements], [*live.sample.readings]
    judgements[index] = judgements[index]._replace(**changes)
    if error is not None:
        readings[index] = readings[index]._replace(energy_error=error)
    sample = live.sample._replace(readings=tuple(readings))
    kept = {name: getattr(live, name) for name in ("scene", "exact", "changes")}
    return SimpleNamespace(**kept, sample=sample, judgements=judgements)


def test_a_forecast_needs_a_slope_that_is_certain_to_a_tenth():
    live = after(DRIFT, 20)
    slope = live.judgements[RK4].slope
    assert forecast(judged(live, RK4, uncertainty=-slope / 10.1), RK4)
    assert forecast(judged(live, RK4, uncertainty=-slope / 9.9), RK4) is None


def test_a_loss_is_a_rate_up_to_half_of_the_energy_and_then_a_share():
    live = after(DRIFT, 20)
    for error, kind in ((-0.49, "loses"), (-0.51, "lost")):
        found = drift(judged(live, RK4, error), RK4)
        assert found.kind == kind
    assert "51 %" in sentence(found)


def test_growth_is_a_rate_of_the_first_or_of_the_true_energy_or_a_time_for_tenfold():
    live = after(DRIFT, 20)
    grows = {"verdict": "grows", "slope": 0.02}
    assert "gains 2.0 % of E0 per s" in sentence(drift(judged(live, RK4, **grows), RK4))
    found = drift(judged(live, RK4, growth=0.5, **grows), RK4)
    assert "tenfold every 4.6 s" in sentence(found)
    damped = judged(after(SCENES["damped"], 1), 0, **grows)
    assert "of the true energy per s" in sentence(drift(damped, 0))


@pytest.mark.parametrize(
    ("judgement", "words"),
    [
        (Judgement("chaotic", lyapunov=0.2), "every 12 s"),
        (Judgement("chaotic"), "exponentially"),
        (Judgement("grows", rests=True), "+29"),
    ],
)
def test_a_chaotic_or_resting_method_has_an_insight(judgement, words):
    found = irregular(RK4_METHOD, judgement, 29.0)
    assert found.kind == ("rests" if judgement.rests else judgement.verdict)
    assert words in sentence(found)
    assert irregular(RK4_METHOD, Judgement("loses", -1e-3, 1e-4), 29.0) is None


def test_an_error_past_anothers_maximum_is_news():
    lab = Lab(SCENES["crossover"])
    lab.run(36)
    assert (insight(lab.live).kind, insight(lab.live).values) == ("errors cross", {"t": 33.4})
    assert "33.40 s" in insight_text(lab.live)


def test_names_of_methods_are_painted_in_their_inks_and_nothing_else():
    text = "RK4's error passed Verlet's; explicit Euler is gone, implicit midpoint unknown."
    pieces = painted(text, USUAL_CAST, TEXT)
    assert "".join(piece for piece, _ in pieces) == text
    own = [(piece, ink) for piece, ink in pieces if ink != TEXT]
    inks = [method.hue for method in USUAL_CAST]
    assert own == [("RK4", inks[3]), ("Verlet", inks[2]), ("explicit Euler", inks[0])]


def test_bounded_methods_have_the_time_behind_the_verdict():
    live = after(DRIFT, 40)
    found = bounded(live)
    assert letters(found) == "sv"
    assert 40 - live.exact.period < found.values["seconds"] <= 40
    assert sentence(found).startswith("Symplectic Euler and Verlet stay bounded")
    assert sentence(bounded(live, {"symplectic_euler"})).startswith("Verlet stays bounded")
    assert bounded(after(DRIFT, 5)) is None


def test_before_any_verdict_the_largest_errors_so_far_are_compared():
    live = after(DRIFT.altered(theta=1.1), 5)
    errors = [reading.max_energy_error for reading in live.sample.readings]
    found = insight(live)
    assert (found.kind, letters(found)) == ("so far", "re")
    least = f"{100 * errors[RK4]:.2g} % (RK4)"
    most = f"{100 * errors[EXPLICIT]:.0f} % (Explicit Euler)"
    assert found.values["errors"] == f"{least} to {most}"
    assert insight(after(DRIFT.altered(theta=0.0), 30)).kind == "at rest"


def test_a_failure_comes_first_and_is_the_only_insight_on_its_method():
    # any growth overflows a relative error
    live = Live(DRIFT.altered(theta=1e-150, h=0.3), clock=lambda: 0.0)
    while live.sample.readings[EXPLICIT].diverged_at is None:
        live.step(1000)
    found, *others = lasting(live)
    assert (found.kind, found.values["t"]) == ("failed", live.sample.readings[EXPLICIT].diverged_at)
    assert not any(found.methods[0] in each.methods for each in others)


def test_what_to_watch_comes_first_and_only_with_its_own_step():
    live = after(SCENES["crossover"], 1)
    assert insight(live).kind == "watch"
    live.change(Stepping(0.1))
    assert (insight(live).kind, insight(live).values) == ("new step", {"h": 0.1})
    live.step(70)
    assert insight(live).kind not in ("watch", "new step")


def test_of_hidden_methods_it_says_nothing():
    live = after(DRIFT, 20)
    assert any(RK4_METHOD in each.methods for each in lasting(live))
    assert not any(RK4_METHOD in each.methods for each in lasting(live, hidden={"rk4"}))
    others = {method.key for method in live.scene.cast} - {"velocity_verlet"}
    assert set(map(letters, lasting(live, others))) == {"v"}


def there_and_back(name: str, steps: int) -> Live:
    live = Live(SCENES[name])
    live.step(steps)
    live.change(live.stepping.reversed())
    live.step(steps)
    return live


@pytest.mark.parametrize("scene", ["drift", "gentle"])
def test_ten_seconds_there_and_back_show_which_methods_are_reversible(scene):
    found = insight(there_and_back(scene, round(10 / SCENES[scene].h)))
    assert found.kind == "returned"
    missed = dict(each.split() for each in found.values["misses"].split(", "))
    assert float(missed["v"]) < 1e-12  # reversible but for rounding, 1e-16 a step
    assert 1e-9 < float(missed["r"]) < 1e-2  # h⁵
    assert float(missed["s"]) >= 1e-3  # not reversible, whatever the books say
    assert float(missed["e"]) > 1e-2


def test_the_distances_are_shown_at_the_start_and_for_a_while_only():
    live = there_and_back("drift", 40)
    live.step(-1)
    assert insight(live).kind != "returned"
    live.step(1)
    assert insight(live).kind == "returned"
    live.step(round(9 / 0.05))
    assert insight(live).kind != "returned"
