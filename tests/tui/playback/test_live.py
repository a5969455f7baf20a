"""A live source, driven by a clock that the test moves and watched by a recorder that keeps everything."""

from pathlib import Path

import pytest

from engine.methods.examine import load
from engine.run.lockstep import Lockstep, Sample
from engine.run.stepping import Stepping
from engine.scenes import DEFAULT_SCENE, SCENES, SceneError
from recordings.events import Event
from tests.tui.harness import FPS, Lab
from tui.playback.live import FRAME_BUDGET, Live


class Keeper:
    """A recorder in memory, as strict as the real one."""

    path, bytes, failed = Path("kept.mcap"), 0, None

    def __init__(self):
        self.samples: list[Sample] = []
        self.events: list[Event] = []
        self.seconds = 0.0
        self.closed = False

    def event(self, event: Event, clock: float) -> None:
        assert clock >= self.seconds
        self.seconds = clock
        self.events.append(event)

    def sample(self, sample: Sample, clock: float) -> None:
        assert clock >= self.seconds
        self.seconds = clock
        if self.samples and self.samples[-1].run == sample.run:
            assert sample.step >= self.samples[-1].step
            if sample.step == self.samples[-1].step:
                return
        self.samples.append(sample)

    def close(self) -> None:
        self.closed = True


class Bench(Lab):
    """A lab recorded in memory, with a clock of its own work."""

    def __init__(self, scene=DEFAULT_SCENE, speed=1.0, second_per_look=0.0):
        self.work, self.second_per_look, self.keeper = 0.0, second_per_look, Keeper()
        super().__init__(scene, speed, self.keeper, self.shown)

    def shown(self) -> float:
        self.work += self.second_per_look
        return self.work

    @property
    def kinds(self) -> list[str]:
        return [event.kind for event in self.keeper.events]


@pytest.mark.parametrize("h", [0.05, 0.013, 1 / 30])
def test_after_a_minute_simulated_and_running_time_differ_by_less_than_a_frame(h):
    bench = Bench(DEFAULT_SCENE.altered(h=h))
    sample = bench.run(60)
    assert abs(sample.t - 60) < max(1 / FPS, h)


def test_time_follows_the_clock_through_pauses_speeds_and_changes_of_h():
    bench = Bench()
    bench.run(2)
    bench.live.pause(True)
    bench.run(5)
    bench.live.pause(False)
    bench.live.set_speed(4)
    bench.run(1)
    bench.live.set_stepping(Stepping(0.01))
    assert bench.run(1).t == pytest.approx(2 + 4 + 4, abs=0.05)  # one step of 0.05


@pytest.mark.parametrize("speed", [1, 8, 64])
def test_time_that_runs_back_to_its_start_is_sampled_there_and_goes_on(speed):
    bench = Bench(DEFAULT_SCENE.altered(h=0.011), speed=speed)
    turn = bench.run(3).t
    bench.live.set_stepping(Stepping(-0.011))
    end = bench.run(4)
    returned = bench.live.history.returned
    assert returned is not None
    assert returned.t == pytest.approx(0.0, abs=1e-10)  # t_base + n·h, rounded
    assert end.t == pytest.approx(
        turn - 4 * speed, abs=0.011 + 1e-9
    )  # nothing is dropped: less than a step behind


def test_time_that_the_processor_cannot_simulate_is_dropped_and_lowers_the_pace():
    bench = Bench(speed=4096, second_per_look=FRAME_BUDGET / 4)
    bench.run(5)
    assert bench.live.pace.share < 0.9
    assert bench.live.playhead.position == pytest.approx(bench.live.sample.t)
    bench.live.set_speed(1)
    bench.run(5)
    assert bench.live.pace.share == pytest.approx(1.0)


def test_a_step_is_one_step_and_pauses():
    bench = Bench()
    bench.run(1)
    before = bench.live.sample.step
    assert bench.live.step(1).step == before + 1
    assert bench.live.playhead.paused
    assert bench.live.step(-1).step == before
    assert bench.live.step(-(10**6)).step == 0


def test_after_a_step_back_the_run_goes_on_with_the_same_bits_and_nothing_is_recorded_twice():
    bench = Bench()
    bench.run(3)
    bench.live.step(-25)
    bench.live.pause(False)
    sample = bench.run(4)
    lockstep = Lockstep(DEFAULT_SCENE)
    lockstep.advance(sample.step)
    expected = lockstep.sample()
    assert [reading.theta for reading in sample.readings] == [
        reading.theta for reading in expected.readings
    ]
    steps = [sample.step for sample in bench.keeper.samples]
    assert steps == sorted(set(steps))
    assert {sample.run for sample in bench.keeper.samples} == {1}


def test_a_change_in_the_past_is_a_new_run_that_repeats_what_it_inherits():
    bench = Bench()
    bench.run(1)
    bench.live.set_stepping(Stepping(0.1))
    bench.run(2)
    bench.live.step(-5)
    at = bench.live.sample.step
    bench.live.set_stepping(Stepping(0.02))
    bench.live.pause(False)
    bench.run(1)
    second = [
        event
        for event in bench.keeper.events
        if event.run == 2 and event.kind in ("start", "set_h")
    ]
    assert [(event.kind, event.step, event.h) for event in second] == [
        ("start", 0, None),
        ("set_h", 20, 0.1),
        ("set_h", at, 0.02),
    ]
    assert second[0].scene == DEFAULT_SCENE
    samples = [sample for sample in bench.keeper.samples if sample.run == 2]
    assert samples[0].step == at
    lockstep = Lockstep(DEFAULT_SCENE, run=2)
    for event in second[1:]:
        lockstep.advance(event.step - lockstep.step)
        lockstep.set_stepping(Stepping(event.h))
    lockstep.advance(samples[-1].step - lockstep.step)
    assert lockstep.sample().readings[3].theta == samples[-1].readings[3].theta


def test_every_change_is_an_event_at_its_step_with_a_sample_there():
    bench = Bench()
    bench.run(1)
    bench.live.set_stepping(Stepping(-0.05))
    bench.live.mark("turned")
    bench.live.pause(True)
    bench.live.pause(False)
    bench.live.set_speed(2)
    bench.live.start(SCENES["spin"])
    assert bench.kinds == ["start", "set_h", "mark", "pause", "resume", "speed", "start"]
    steps = {(sample.run, sample.step) for sample in bench.keeper.samples}
    assert {(event.run, event.step) for event in bench.keeper.events} <= steps


def test_the_recording_clock_stands_while_paused_and_does_not_care_for_speed():
    bench = Bench()
    bench.run(2)
    bench.live.pause(True)
    bench.run(60)
    bench.live.pause(False)
    bench.live.set_speed(100)
    bench.run(1)
    assert bench.keeper.seconds == pytest.approx(3.0, abs=1 / 30)  # from sample to sample


def test_a_restart_keeps_the_step_size_but_not_its_sign():
    bench = Bench()
    bench.run(1)
    bench.live.set_stepping(Stepping(-0.1))
    bench.live.restart()
    assert (bench.live.stepping.h, bench.live.sample.run, bench.live.sample.step) == (0.1, 2, 0)


def test_an_absurd_step_size_is_refused_and_changes_nothing():
    bench = Bench()
    bench.run(1)
    bench.live.step(-3)
    events = len(bench.keeper.events)
    for h in (0.0, float("nan"), 1e9):
        with pytest.raises(SceneError):
            bench.live.set_stepping(Stepping(h))
    assert (bench.live.stepping.h, len(bench.keeper.events), bench.live.sample.run) == (
        0.05,
        events,
        1,
    )


def test_the_events_are_those_up_to_the_sample_in_the_past_too():
    bench = Bench()
    bench.run(1)
    bench.live.set_stepping(Stepping(0.1))
    bench.run(1)
    bench.live.step(-20)
    assert [event.kind for event in bench.live.events] == ["start"]
    bench.live.step(20)
    assert [event.kind for event in bench.live.events] == ["start", "set_h", "pause"]


def test_a_recorder_that_comes_later_learns_how_the_run_began():
    live = Live(SCENES["spin"])
    keeper = Keeper()
    live.record(keeper)
    assert (keeper.events[0].kind, keeper.events[0].scene, keeper.samples[0].step) == (
        "start",
        SCENES["spin"],
        0,
    )


def test_closing_finishes_the_recording():
    bench = Bench()
    bench.live.close()
    assert bench.keeper.closed


FAILING = """
import os, sys, time
def mine(force, phase, h):
    theta, omega = phase
    while True:
        if "FAIL" in os.environ:
            {}
        omega = omega + h * force(theta)
        theta = theta + h * omega
        yield theta, omega
"""


@pytest.mark.parametrize(
    ("failure", "words"),
    [
        ("while True: pass", "takes more than 0.3 s"),
        ("time.sleep(60)", "takes more than 0.3 s"),
        ("time.sleep(0.05)", "takes more than 0.3 s"),
        ("1 / 0", "raises ZeroDivisionError"),
        ("sys.exit()", "raises SystemExit"),
    ],
)
def test_where_a_users_method_fails_the_run_stands_still_and_can_go_on(failure, words, monkeypatch):
    monkeypatch.setattr("tui.cli.time_limit.MAX_STEP_TIME", 0.3)
    monkeypatch.setattr("tui.cli.time_limit.LOOK_INTERVAL", 0.05)
    own = load(FAILING.format(failure), "mine", "m", "mine.py")
    scene = DEFAULT_SCENE.with_cast((*DEFAULT_SCENE.cast, own))
    bench = Bench(scene)
    bench.run(2)
    here = bench.live.sample
    monkeypatch.setenv("FAIL", "")
    bench.live.step(-20)
    assert words in bench.live.failure
    assert (bench.live.sample.step, bench.live.playhead.paused) == (here.step, True)
    monkeypatch.delenv("FAIL")
    bench.live.pause(False)
    assert bench.live.failure is None
    bench.run(2)
    whole = Lockstep(scene)
    whole.advance(bench.live.sample.step)
    for mine, other in zip(bench.live.sample.readings, whole.sample().readings, strict=True):
        assert (mine.theta, mine.omega) == (other.theta, other.omega)


@pytest.mark.parametrize("change", [{"omega": 1e8}, {"theta": 1e6}, {"length": 9.81, "h": 50.0}])
def test_extreme_starts_neither_crash_nor_read_anything_but_finite_numbers(change):
    bench = Bench(DEFAULT_SCENE.altered(**change), speed=64)
    bench.run(10)
    for sample in bench.keeper.samples:
        for reading in sample.readings:
            assert abs(reading.energy_error) < float("inf")
            assert abs(reading.theta) < float("inf")
