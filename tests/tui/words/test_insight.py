"""Which insight is chosen, and its numbers, compared with what the methods do."""

import math

import pytest

from engine.methods import RK4 as RK4_METHOD
from engine.methods import USUAL_CAST
from engine.run.judgement import Judgement
from engine.run.lockstep import Lockstep
from engine.run.stepping import Stepping
from engine.scenes import SCENES
from tests.tui.harness import FPS, Lab, after
from tui.playback.live import Live
from tui.words.events import event_lines
from tui.words.insight import (
    FRESH,
    TURN,
    bounded,
    drift,
    forecast,
    insight,
    insight_text,
    irregular,
    lasting,
    milestone_insight,
    sentence,
    short_name,
)

EXPLICIT, SYMPLECTIC, VERLET, RK4 = range(4)


def kinds(live: Live) -> list[str]:
    return [each.kind for each in lasting(live)]


def test_the_first_minute_of_the_default_scene():
    lab = Lab(SCENES["drift"])
    chosen = {}
    for second in range(1, 46):
        lab.run(1)
        chosen[second] = insight(lab.live)
    assert chosen[5].kind == "watch"
    assert "watch" not in {
        chosen[second].kind for second in range(20, 46)
    }  # Explicit Euler, which it names, is gone
    assert (chosen[8].kind, chosen[8].methods[0].letter) == ("over the top with", "e")
    assert (chosen[18].kind, [each.letter for each in chosen[18].methods]) == (
        "bounded",
        ["s", "v"],
    )
    assert chosen[45].kind in ("bounded", "will pass", "over the top with")


def test_every_insight_of_every_scene_has_words_and_events_fit_the_smallest_pane():
    for scene in SCENES.values():
        lab = Lab(scene)
        for _ in range(10):
            lab.run(3)
            assert 10 < len(insight_text(lab.live)) <= 110
        assert all(len(str(line)) <= 46 for line in event_lines(lab.live))


@pytest.mark.parametrize("speed", [0.5, 16.0])
def test_news_stays_equally_long_at_any_speed(speed):
    lab = Lab(SCENES["drift"], speed)
    seen = 0
    while lab.live.sample.t < 7.15 + FRESH * speed + 1:
        lab.run(1 / FPS)
        happened = any(each.kind == "over the top" for each in lab.live.milestones)
        seen += happened and insight(lab.live).kind == "over the top with"
    assert seen / FPS == pytest.approx(
        FRESH, abs=2 / FPS + 0.05 / speed
    )  # a frame at each end, and a step


def test_lasting_insights_take_turns():
    lab = Lab(SCENES["drift"])
    lab.run(40)
    shown = []
    for _ in kinds(lab.live):
        lab.run(TURN)
        shown.append(insight(lab.live).kind)
    assert sorted(shown) == sorted(kinds(lab.live))


def test_the_energy_at_the_top_is_that_of_the_milestone():
    live = after(SCENES["drift"], 8)
    (top,) = (each for each in live.milestones if each.kind == "over the top")
    assert milestone_insight(top).values == {"t": top.t, "ratio": 1 + top.energy_error}
    lockstep = Lockstep(SCENES["drift"])
    lockstep.advance(top.step)
    assert top.energy_error == lockstep.sample().readings[EXPLICIT].energy_error
    assert milestone_insight(top._replace(energy_error=0.01)).kind == "over the top"
    assert milestone_insight(top, conserved=False).values["ratio"] == math.exp(top.energy_error)


@pytest.mark.parametrize(
    ("name", "h", "seconds"),
    [
        ("drift", 0.05, 20),
        ("drift", 0.05, 60),
        ("drift", 0.1, 40),
        ("gentle", 0.1, 40),
        ("spin", 0.05, 20),
    ],
)
def test_a_forecast_comes_true_in_a_long_run(name, h, seconds):
    live = after(SCENES[name].altered(h=h), seconds)
    ahead = forecast(live, RK4)
    assert ahead is not None
    wait, other = ahead
    band = live.sample.readings[USUAL_CAST.index(other)].max_energy_error
    assert abs(live.sample.readings[RK4].energy_error) < band
    lockstep = Lockstep(SCENES[name].altered(h=h))
    while (sample := lockstep.sample()).readings[RK4].max_energy_error <= band:
        lockstep.advance(round(0.01 * wait / h))
        assert lockstep.t < seconds + 2 * wait
    assert sample.t - seconds == pytest.approx(wait, rel=0.08)  # the drift changes with the energy


@pytest.mark.parametrize(
    ("scene", "seconds", "index"),
    [
        ("drift", 5, RK4),  # too early for a verdict
        ("drift", 40, EXPLICIT),  # grows ever faster
        ("drift", 40, VERLET),  # stays
        ("near-separatrix", 200, RK4),  # the period depends on the energy
    ],
)
def test_there_is_no_forecast_where_it_would_be_a_guess(scene, seconds, index):
    assert forecast(after(SCENES[scene], seconds), index) is None


def test_after_a_change_of_the_step_there_is_no_forecast():
    live = after(SCENES["drift"], 20)
    live.set_stepping(Stepping(0.1))
    for _ in range(400):
        live.step(1)
    assert live.judgements[RK4].verdict == "loses"
    assert forecast(live, RK4) is None  # the band of this h is not known


@pytest.mark.parametrize(
    ("judgement", "kind"),
    [
        (Judgement("chaotic", lyapunov=0.2), "chaotic at"),
        (Judgement("chaotic"), "chaotic"),
        (Judgement("wanders", lyapunov=0.2), "wanders at"),
        (Judgement("wanders"), "wanders"),
        (Judgement("caught"), "caught"),
        (Judgement("loses", -1e-3, 1e-4), None),
    ],
)
def test_a_chaotic_wandering_or_caught_method_has_an_insight(judgement, kind):
    found = irregular(RK4_METHOD, judgement, 29.0)
    assert (found and found.kind) == kind
    if judgement.lyapunov:
        assert found.values["seconds"] == pytest.approx(math.log(10) / 0.2)


def test_a_large_loss_of_energy_is_given_as_a_share_and_not_as_a_rate():
    found = drift(after(SCENES["verlet-limit"], 127), RK4)
    assert found.kind == "lost"
    assert found.values["share"] == pytest.approx(1)


def test_an_error_past_anothers_maximum_is_compared_with_it():
    live = after(SCENES["crossover"], 60)
    readings = live.sample.readings
    found = drift(live, RK4)
    assert (found.kind, [each.letter for each in found.methods]) == ("exceeds", ["r", "v"])
    assert (
        found.values["ratio"]
        == abs(readings[RK4].energy_error) / readings[VERLET].max_energy_error
        > 1
    )


def test_bounded_methods_have_the_time_behind_the_verdict():
    live = after(SCENES["drift"], 40)
    found = bounded(live)
    assert [each.letter for each in found.methods] == ["s", "v"]
    assert 40 - live.exact.period - 1 < found.values["seconds"] <= 40
    assert bounded(after(SCENES["drift"], 5)) is None


def test_before_any_verdict_the_largest_errors_so_far_are_compared():
    live = after(SCENES["drift"].altered(theta=1.1), 5)
    errors = [reading.max_energy_error for reading in live.sample.readings]
    found = insight(live)
    assert (found.kind, found.values) == (
        "so far",
        {"least": errors[RK4], "most": errors[EXPLICIT]},
    )


def test_a_pendulum_in_equilibrium():
    live = after(SCENES["drift"].altered(theta=0.0), 30)
    assert insight(live).kind == "at rest"
    assert {(reading.theta, reading.omega) for reading in live.sample.readings} == {(0.0, 0.0)}


def test_a_failure_comes_first_and_is_the_only_insight_on_its_method():
    live = Live(
        SCENES["drift"].altered(theta=1e-150), clock=lambda: 0.0
    )  # any growth overflows a relative error
    while live.sample.readings[EXPLICIT].diverged_at is None:
        live.step(1000)
    found = lasting(live)[0]
    assert (found.kind, found.values["t"]) == ("failed", live.sample.readings[EXPLICIT].diverged_at)
    assert [each for each in lasting(live) if found.methods[0] in each.methods] == [found]


def test_what_to_watch_comes_first_and_only_with_its_own_step():
    live = after(SCENES["crossover"], 1)
    assert insight(live).kind == "watch"
    live.set_stepping(Stepping(0.1))
    assert insight(live).kind == "new step"


def test_of_hidden_methods_it_says_nothing():
    live = after(SCENES["drift"], 20)
    assert any(RK4_METHOD in each.methods for each in lasting(live))
    assert not any(RK4_METHOD in each.methods for each in lasting(live, hidden={"rk4"}))
    others = {method.key for method in live.scene.cast} - {"velocity_verlet"}
    assert {method.letter for each in lasting(live, others) for method in each.methods} == {"v"}


def test_names_are_short_where_they_stay_different():
    names = [short_name(method) for method in USUAL_CAST]
    assert names == ["Explicit Euler", "Symplectic Euler", "Verlet", "RK4"]


def test_an_insight_in_words():
    live = after(SCENES["drift"], 40)
    assert sentence(bounded(live)).startswith(
        "Symplectic Euler and Verlet stay bounded; no trend over "
    )
    assert sentence(bounded(live, {"symplectic_euler"})).startswith("Verlet stays bounded")


def there_and_back(name: str, steps: int) -> Live:
    live = Live(SCENES[name])
    for h in (live.stepping.h, -live.stepping.h):
        if h != live.stepping.h:
            live.set_stepping(Stepping(h))
        for _ in range(steps):
            live.step(1)
    return live


@pytest.mark.parametrize("scene", ["drift", "large-swing", "gentle"])
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
    assert insight(live).kind == "returned"
    live.step(round(9 / live.stepping.h * -1))
    assert insight(live).kind != "returned"
    live = there_and_back("drift", 40)
    live.step(-1)
    assert insight(live).kind != "returned"
