"""The sentence of the moment, compared with what the methods do."""

import re

import pytest

from engine.methods import USUAL_CAST
from engine.run.lockstep import Lockstep
from engine.run.stepping import Stepping
from engine.run.verdict import Judgement
from engine.scenes import SCENES
from tests.tui.harness import FPS, Lab, after
from tui.playback.live import Live
from tui.words.events import event_lines
from tui.words.findings import astray, ending, forecast, leaving, short_name, so_far, staying
from tui.words.insight import FRESH, RESTING, TURN, insight, lasting
from tui.words.numbers import about, two_digits

EXPLICIT, SYMPLECTIC, VERLET, RK4 = range(4)
WIDTH = 79  # characters, of the smallest layout with everything in it


class Told(Lab):
    """A lab whose insight is read."""

    def run(self, seconds: float) -> str:
        super().run(seconds)
        return insight(self.live)


def test_the_first_minute_of_the_default_scene():
    lab = Told(SCENES["drift"])
    said = {5: "", 8: "", 18: "", 31: "", 45: ""}
    for second in range(1, 46):
        text = lab.run(1)
        said |= {second: text} if second in said else {}
    assert said[5] == SCENES["drift"].watch
    assert said[8].startswith("Explicit Euler went over the top at 7.15 s with ")
    assert said[18] == "Symplectic Euler and Verlet stay bounded; no trend over 18 s."
    assert said[31] == SCENES["drift"].watch
    assert re.fullmatch(r"Symplectic Euler and Verlet stay bounded; no trend over \d\d s\.", said[45])


def test_every_second_of_every_scene_has_a_sentence_that_fits_on_its_line_and_events_fit_the_smallest_pane():
    for scene in SCENES.values():
        lab = Told(scene)
        for _ in range(60):
            assert 10 < len(lab.run(1).removesuffix(".")) <= WIDTH
        assert all(len(str(line)) <= 46 for line in event_lines(lab.live))


@pytest.mark.parametrize("speed", [0.5, 1.0, 16.0])
def test_news_stays_equally_long_at_any_speed(speed):
    lab, seen = Told(SCENES["drift"], speed), 0
    while lab.live.sample.t < 7.15 + FRESH * speed + 1:
        lab.run(1 / FPS)
        happened = any(each.kind == "over the top" for each in lab.live.milestones)
        seen += happened and "went over the top" in insight(lab.live)
    assert seen / FPS == pytest.approx(FRESH, abs=2 / FPS + 0.05 / speed)  # a frame at each end, and a step of 0.05 s


def test_lasting_sentences_take_turns():
    lab = Told(SCENES["drift"])
    lab.run(40)
    told = {re.sub(r"[-\d.e+]+", "#", lab.run(TURN)) for _ in range(4)}
    assert told == {re.sub(r"[-\d.e+]+", "#", text) for text in lasting(lab.live)}
    assert len(told) == 4


def test_the_energy_at_the_top_is_that_of_the_milestone_and_does_not_change():
    lab = Told(SCENES["drift"])
    lab.run(8)
    (top,) = (each for each in lab.live.milestones if each.kind == "over the top")
    told = {lab.run(1) for _ in range(5)}
    assert told == {ending(top)} == {"Explicit Euler went over the top at 7.15 s with 5.1 times its initial energy."}
    lockstep = Lockstep(SCENES["drift"])
    lockstep.advance(top.step)
    assert top.energy_error == lockstep.sample().readings[EXPLICIT].energy_error
    assert any(line.text == "Explicit Euler over the top, 5.1 E0" for line in event_lines(lab.live))


@pytest.mark.parametrize(
    ("name", "h", "seconds"),
    [
        ("drift", 0.05, 20),
        ("drift", 0.05, 60),
        ("drift", 0.1, 40),
        ("gentle", 0.05, 20),
        ("gentle", 0.1, 40),
        ("large-swing", 0.1, 80),
        ("spin", 0.05, 20),
    ],
)
def test_a_forecast_comes_true_in_a_long_run(name, h, seconds):
    live = after(SCENES[name].altered(h=h), seconds)
    ahead = forecast(live, RK4)
    assert ahead is not None
    band = live.sample.readings[USUAL_CAST.index(ahead.other)].max_energy_error
    assert abs(live.sample.readings[RK4].energy_error) < band
    lockstep = Lockstep(SCENES[name].altered(h=h))
    while (sample := lockstep.sample()).readings[RK4].max_energy_error <= band:
        lockstep.advance(round(0.01 * ahead.seconds / h))
        assert lockstep.t < seconds + 2 * ahead.seconds
    # The drift itself changes with the energy, of which a tenth may be gone by then; 0.01 is how closely was looked.
    assert sample.t - seconds == pytest.approx(ahead.seconds, rel=0.08)


def test_there_is_no_forecast_where_the_period_hangs_on_the_energy():
    live = after(SCENES["near-separatrix"], 200)
    assert live.judgements[RK4].verdict == "loses"
    assert forecast(live, RK4) is None  # a straight line would be a third too late


@pytest.mark.parametrize(
    ("judgement", "text"),
    [
        (Judgement("chaotic", lyapunov=0.2), "RK4 is chaotic: two close starts part tenfold every 12 s."),
        (Judgement("chaotic"), "RK4 is chaotic: two close starts part exponentially."),
        (Judgement("wanders"), "RK4 wanders: its energy goes up and down, without a trend and in no band."),
        (Judgement("caught"), "RK4 is caught: its energy error stays in a band, now +29."),
        (Judgement("loses", -1e-3, 1e-4), ""),
    ],
)
def test_a_chaotic_wandering_or_caught_method_has_a_sentence(judgement, text):
    assert astray("RK4", judgement, 29.0) == text


def test_a_large_loss_of_energy_is_given_as_a_share_and_not_as_a_rate():
    assert leaving(after(SCENES["verlet-limit"], 127), RK4) == "RK4 has lost all of its energy."


def test_there_is_no_forecast_where_it_would_be_a_guess():
    assert forecast(after(SCENES["drift"], 5), RK4) is None  # too early for a verdict
    assert forecast(after(SCENES["drift"], 40), EXPLICIT) is None  # grows ever faster
    assert forecast(after(SCENES["drift"], 40), VERLET) is None  # stays
    live = after(SCENES["drift"], 20)
    live.set_stepping(Stepping(0.1))
    for _ in range(400):
        live.step(1)
    assert live.judgements[RK4].verdict == "loses"
    assert forecast(live, RK4) is None  # the band of this h is not known


def test_an_error_past_anothers_maximum_is_compared_with_it():
    live = after(SCENES["crossover"], 60)
    readings = live.sample.readings
    ratio = abs(readings[RK4].energy_error) / readings[VERLET].max_energy_error
    assert ratio > 1
    assert leaving(live, RK4).endswith(f"its error is {two_digits(ratio)} times Verlet's maximum.")


def test_bounded_methods_are_named_with_the_time_behind_the_verdict():
    live = after(SCENES["drift"], 40)
    text = staying(live)
    seconds = float(re.search(r"no trend over (\d+) s", text)[1])
    assert 40 - live.exact.period - 1 < seconds <= 40
    assert [name for name in map(short_name, USUAL_CAST) if name in text] == ["Symplectic Euler", "Verlet"]
    assert staying(after(SCENES["drift"], 5)) == ""


def test_before_any_verdict_the_largest_errors_so_far_are_compared():
    live = after(SCENES["drift"].altered(theta=1.1), 5)
    errors = [reading.max_energy_error for reading in live.sample.readings]
    assert insight(live) == so_far(live)
    assert so_far(live) == (
        f"Energy errors so far: {errors[RK4]:.2g} (RK4) to {errors[EXPLICIT]:.2g} (Explicit Euler)."
    )


def test_a_pendulum_in_equilibrium():
    live = after(SCENES["drift"].altered(theta=0.0), 30)
    assert insight(live) == RESTING
    assert {(reading.theta, reading.omega) for reading in live.sample.readings} == {(0.0, 0.0)}


def test_a_failure_comes_first_and_is_the_only_sentence_on_its_method():
    live = Live(SCENES["drift"].altered(theta=1e-150), clock=lambda: 0.0)  # any growth overflows a relative error
    while live.sample.readings[EXPLICIT].diverged_at is None:
        live.step(1000)
    when = live.sample.readings[EXPLICIT].diverged_at
    failure = f"Explicit Euler failed at {when:.4g} s: its energy error is no longer finite."
    assert insight(live) == failure
    assert [text for text in lasting(live) if "Explicit" in text] == [failure]


def test_a_run_begins_with_what_to_watch():
    assert insight(after(SCENES["crossover"], 1)) == SCENES["crossover"].watch


def test_with_another_step_size_what_to_watch_is_left_out():
    live = after(SCENES["crossover"], 1)
    live.set_stepping(Stepping(0.1))
    assert insight(live) == so_far(live)
    for _ in range(400):
        live.step(1)
    assert live.scene.watch not in lasting(live)


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        (3.21, "3.2 s"),
        (40, "40 s"),
        (119, "119 s"),
        (1893, "32 min"),
        (7200, "2 h"),
        (30_000, "8.3 h"),
        (1e6, "12 days"),
    ],
)
def test_durations_have_two_digits(seconds, text):
    assert about(seconds) == text


@pytest.mark.parametrize(
    ("ratio", "text"),
    [
        (0.00029, "0.00029"),
        (0.664, "0.66"),
        (1.0, "1.0"),
        (4.34, "4.3"),
        (9.97, "10"),
        (439.4, "439"),
        (1.3e6, "1.3e+06"),
    ],
)
def test_ratios_have_two_digits(ratio, text):
    assert two_digits(ratio) == text


def test_names_are_short_where_they_stay_different():
    names = [short_name(method) for method in USUAL_CAST]
    assert names == ["Explicit Euler", "Symplectic Euler", "Verlet", "RK4"]
    assert len(set(names)) == len(USUAL_CAST)


def test_of_hidden_methods_it_says_nothing():
    live = after(SCENES["drift"], 20)
    assert any("RK4" in sentence for sentence in lasting(live))
    assert not any("RK4" in sentence for sentence in lasting(live, hidden={"rk4"}))
    others = {method.key for method in live.scene.cast} - {"velocity_verlet"}
    assert "Verlet" in insight(live, others)
    assert "Euler" not in "".join(lasting(live, others)[:1])
