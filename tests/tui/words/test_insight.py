"""Which insight is chosen, and its numbers, compared with what the methods do."""

import math
import re
from dataclasses import replace
from types import SimpleNamespace

import pytest

from pendu_tui.engine.methods import USUAL_CAST
from pendu_tui.engine.run.lockstep import Lockstep
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.drawing.picture import TEXT
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.words.insight import (
    _returned,
    bounded,
    drift,
    forecast,
    insight,
    lasting,
    milestone_insight,
    painted,
)
from pendu_tui.tui.words.numbers import seconds
from tests.tui.harness import Lab, after

DRIFT = SCENES["drift"]
EXPLICIT, SYMPLECTIC, VERLET, RK4 = range(4)


@pytest.fixture(scope="module")
def judged() -> Live:
    """The default scene after 20 s: two bounded methods, RK4 loses."""
    return after(DRIFT, 20)


def changed(live, index: int, errors: dict[str, float] | None = None, **changes) -> SimpleNamespace:
    """A lab, with another judgement on a method and perhaps other energy errors of it."""
    judgements, readings = [*live.judgements], [*live.sample.readings]
    judgements[index] = judgements[index]._replace(**changes)
    readings[index] = readings[index]._replace(**(errors or {}))
    sample = live.sample._replace(readings=tuple(readings))
    kept = {
        name: getattr(live, name)
        for name in ("scene", "exact", "changes", "stepping", "milestones")
    }
    return SimpleNamespace(**kept, sample=sample, judgements=judgements)


def test_insights_as_they_are_stored(snapshot):
    texts = []
    for name, speed, clock in (
        ("drift", 0.25, 12),
        ("drift", 1, 48),
        ("crossover", 1, 55),
        ("halving", 4, 35),
        ("spin", 4, 25),
    ):
        texts += ["", name]
        lab = Lab(SCENES[name], speed)
        for second in range(clock):
            text = "{}: {}".format(*insight(lab.live))
            if re.sub(r"\d", "", text) != re.sub(r"\d", "", texts[-1].partition(" s ")[2]):
                texts.append(f"{second} s {text}")
            lab.run(1)
    snapshot("insights.txt", "\n".join(texts) + "\n")


def test_sentences_as_they_are_stored(judged, snapshot):
    (top,) = (each for each in judged.milestones if each.kind == "over the top")
    found = [
        milestone_insight(top._replace(energy_error=error), conserved)
        for error, conserved in (
            *((0.04, True), (0.06, True), (-0.06, True)),
            *((1.0, False), (1e3, False)),
        )
    ]
    damped = after(SCENES["damped"], 1)
    grows = {"verdict": "grows", "slope": 0.02}
    for live, changes in (
        (judged, {"errors": {"energy_error": -0.49}}),  # a rate, then a share
        (judged, {"errors": {"energy_error": -0.51}}),
        (judged, {"errors": {"energy_error": -0.51}, "verdict": "undecided"}),
        (judged, {"verdict": "grows"}),  # but its slope falls
        *((judged, grows | {"slope": slope}) for slope in (9.9, 1.1e-6, 0.9e-6)),
        (judged, grows | {"slope": 10.1, "errors": {"energy_error": 29.0}}),
        (damped, grows),
        (damped, {"verdict": "loses", "slope": -0.02, "errors": {"energy_error": -0.6}}),
        (judged, {"verdict": "chaotic", "lyapunov": 0.2}),
        (judged, {"verdict": "chaotic"}),
        (judged, {"verdict": "grows", "rests": True, "errors": {"energy_error": 29.0}}),
    ):
        found.append(drift(changed(live, RK4, **changes), RK4))
    found += [bounded(judged), bounded(judged, {"symplectic_euler"})]
    back = Live(DRIFT)
    back.change(Stepping(-DRIFT.h))
    back.step(200)
    found += [bounded(after(DRIFT, 5)), insight(back)]
    back.step(160)
    found.append(bounded(back))
    snapshot("sentences.txt", "".join(f"{each and ': '.join(each)}\n" for each in found))


def test_a_forecast_comes_true_in_a_long_run(judged):
    wait, other = forecast(judged, RK4)
    band = judged.sample.readings[USUAL_CAST.index(other)].max_energy_error
    assert abs(judged.sample.readings[RK4].energy_error) < band
    lockstep = Lockstep(DRIFT)
    while (sample := lockstep.sample()).readings[RK4].max_energy_error <= band:
        lockstep.advance(round(0.01 * wait / DRIFT.h))
        assert lockstep.t < 20 + 2 * wait
    assert sample.t - 20 == pytest.approx(wait, rel=0.08)  # the drift changes with the energy


def losing(live, band: float, days: float, certainty: float = 10.1) -> SimpleNamespace:
    """A lab in which the error of RK4 passes Verlet's band in some days."""
    live = changed(live, VERLET, {"max_energy_error": band})
    slope = -0.1 * band / days / 86400
    error = {"energy_error": -0.9 * band}
    return changed(live, RK4, error, slope=slope, uncertainty=-slope / certainty)


def test_there_is_no_forecast_where_it_would_be_a_guess(judged):
    wait, other = forecast(losing(judged, 0.19, 999), RK4)
    assert (wait, other) == (pytest.approx(999 * 86400), USUAL_CAST[VERLET])
    slow, altered, later = (changed(judged, RK4) for _ in range(3))
    now = judged.sample.step
    later.changes = [SimpleNamespace(step=n) for n in (0, now + 1)]  # in a replay that went back
    assert forecast(later, RK4) == forecast(judged, RK4)
    slow.exact = SimpleNamespace(period=2.1 * math.tau / DRIFT.w0)  # it depends on the energy
    # the band of this h is not known
    altered.changes = [SimpleNamespace(step=n) for n in (now, now + 1)]
    for guess in (
        losing(judged, 0.19, 999, certainty=9.9),
        losing(judged, 0.19, 1001),
        losing(judged, 0.21, 999),
        changed(judged, RK4, verdict="grows"),
        changed(judged, RK4, {"energy_error": -0.3}),  # beyond all bands
        slow,
        altered,
    ):
        assert forecast(guess, RK4) is None


def test_an_error_past_anothers_maximum_is_news_after_what_to_watch():
    scene = SCENES["crossover"]
    lab = Lab(scene)
    live = lab.live
    lab.run(1)
    assert insight(live, {"rk4"}).kind != "watch"  # which names it
    lab.run(35)
    (top,) = (each for each in live.milestones if each.kind == "over the top")
    live.milestones = [*live.milestones, top._replace(step=live.sample.step)]
    live.playhead.speed = -1.0
    assert insight(live).kind == "over the top"  # which matters more
    assert insight(live, {top.method.key}).kind == "errors cross"
    other = Live(scene, clock=lambda: 0.0)
    other.change(Stepping(2 * scene.h))
    assert insight(other).kind == "nothing"
    other.step(round(scene.shot.moment / scene.h / 2))
    assert insight(other).text != scene.shot.sentence
    for sentence in ("", "Now."):
        shot = replace(scene.shot, moment=0.3, sentence=sentence)
        other = Live(replace(scene, h=0.1, shot=shot), clock=lambda: 0.0)
        other.step(3)
        assert insight(other) == ("watch", sentence or scene.watch)
        other.pause(False)  # as when a lesson is left
        assert insight(other) == ("watch", scene.watch)


def test_names_of_methods_are_painted_in_their_inks_and_nothing_else():
    text = "RK4's error passed Verlet's; explicit Euler is gone, implicit midpoint unknown."
    pieces = painted(text, USUAL_CAST, TEXT)
    assert "".join(piece for piece, _ in pieces) == text
    own = [(piece, ink) for piece, ink in pieces if ink != TEXT]
    inks = [method.hue for method in USUAL_CAST]
    own_method = replace(USUAL_CAST[RK4], label="Verlet 2")
    named = painted("Verlet 2 fails.", (*USUAL_CAST[:RK4], own_method), TEXT)
    assert named[0] == ("Verlet 2", own_method.hue)
    assert own == [("RK4", inks[3]), ("Verlet", inks[2]), ("explicit Euler", inks[0])]


def test_at_rest_nothing_moves_and_before_any_verdict_nothing_is_said():
    assert insight(after(DRIFT.altered(theta=0.0), 1)).kind == "at rest"
    assert insight(after(DRIFT.altered(theta=1.1), 5)).text == ""


def test_a_failure_comes_first_and_is_the_only_insight_on_its_method():
    # any growth overflows a relative error
    live = Live(DRIFT.altered(theta=1e-150, h=0.3), clock=lambda: 0.0)
    while live.sample.readings[EXPLICIT].diverged_at is None:
        live.step(1000)
    failed = next(each for each in live.milestones if each.kind == "failed")
    failed = failed._replace(step=live.sample.step)
    over = failed._replace(kind="over the top", step=failed.step - 1, method=USUAL_CAST[RK4])
    later = over._replace(step=failed.step, method=USUAL_CAST[VERLET])
    live.milestones = [later, over, failed]
    assert insight(live).kind == "failed"
    found, *others = lasting(live)
    assert found.kind == "failed"
    assert [each.text.split()[0] for each in others] == ["RK4", "Verlet"]
    assert seconds(live.sample.readings[EXPLICIT].diverged_at) in found.text
    assert not any("Explicit Euler" in each.text for each in others)


def test_a_method_that_went_over_the_top_may_be_chaotic_too(judged):
    live = changed(judged, EXPLICIT, verdict="chaotic")
    assert "chaotic" in [each.kind for each in lasting(live)]


def test_time_is_back_at_0_but_for_rounding():
    live = Live(DRIFT.altered(h=0.1), clock=lambda: 0.0)
    live.step(3)
    live.change(live.stepping._replace(h=-0.03))
    live.step(9)
    assert not live.is_back
    live.step(1)
    assert live.sample.t != 0
    assert live.is_back


def test_there_and_back_shows_at_the_start_which_methods_are_reversible():
    scene = DRIFT.altered(omega=0.1)
    live = Live(scene, clock=lambda: 0.0)
    steps = round(10 / live.scene.h)
    live.step(steps)
    live.change(live.stepping.reversed())
    live.step(steps - 1)
    assert insight(live).kind != "returned"
    live.step(1)
    found = insight(live)
    assert found.kind == "returned"
    assert len(found.text) <= 58  # all of it on the smallest terminal
    missed = dict(each.split() for each in found.text.partition(": ")[2][:-1].split(", "))
    assert float(missed["v"]) < 1e-12  # reversible but for rounding, 1e-16 a step
    assert 1e-9 < float(missed["r"]) < 1e-2  # h⁵
    end = live.sample.readings[SYMPLECTIC]
    miss = math.hypot(end.theta - scene.theta, (end.omega - scene.omega) / scene.w0)
    assert missed["s"] == f"{miss:.1g}"  # not reversible, whatever the books say
    assert float(missed["e"]) > 1e-2
    explicit, *others = live.sample.readings
    sample = live.sample._replace(readings=(explicit._replace(diverged_at=1.0), *others))
    text = f"Back at 0, off by [rad]: e failed, s {missed['s']}, r {missed['r']}."
    assert _returned(scene, sample, {"velocity_verlet"}).text == text
    live.step(1)
    assert insight(live).kind != "returned"
    live.change(Stepping(0.0501))
    live.step(1)
    assert insight(live).kind != "returned"  # it goes past
