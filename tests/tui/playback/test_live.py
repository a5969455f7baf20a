"""A live source, driven by a clock that the test moves and watched by a recorder that keeps everything."""

import functools
import itertools
import math
import threading
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.run import loops, rewindable
from pendu_tui.engine.run.lockstep import Lockstep, Sample
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import DEFAULT_SCENE, SCENES, Z_LIMITS
from pendu_tui.recordings.events import Event
from pendu_tui.recordings.verification import verify
from pendu_tui.tui.playback import live
from pendu_tui.tui.playback.source import doubled
from tests.own_methods import VERLET, load
from tests.tui.harness import FPS, Lab


class Keeper:
    """A recorder in memory, as strict as the real one."""

    path = Path("mine\a.mcap")
    failed = None

    def __init__(self):
        self.samples: list[Sample] = []
        self.events: list[Event] = []
        self.seconds = 0.0

    def add(self, value: Sample | Event, clock: float) -> None:
        assert clock >= self.seconds
        self.seconds = clock
        last = self.samples[-1:]
        if isinstance(value, Event):
            self.events.append(value)
        elif not last or last[0].run != value.run or last[0].step < value.step:
            self.samples.append(value)

    def close(self) -> None:
        pass


class Bench(Lab):
    """A lab recorded in memory, with a clock of its own work."""

    def __init__(self, scene=DEFAULT_SCENE, speed=1.0, second_per_look=0.0):
        self.keeper = Keeper()
        looks = itertools.count()
        super().__init__(scene, speed, self.keeper, lambda: second_per_look * next(looks))


def states(sample: Sample) -> list[tuple[float, float]]:
    return [(reading.theta, reading.omega) for reading in sample.readings]


def simulated(scene, step, changes=()) -> list[tuple[float, float]]:
    """The states at a step, simulated again without a lab."""
    lockstep = Lockstep(scene)
    for at, *stepping in changes:
        lockstep.advance(at - lockstep.step)
        lockstep.set_stepping(Stepping(*stepping, scene.cast))
    lockstep.advance(step - lockstep.step)
    return states(lockstep.sample())


def test_speeds_double_exactly_within_their_limits():
    for times, expected in ((0, 1.0), (3, 8.0), (-2, 0.25), (21, 2.0**20), (-11, 2.0**-10)):
        assert doubled(1.0, times) == -doubled(-1.0, times) == expected


def test_time_follows_the_clock_through_pauses_speeds_and_changes_of_h():
    bench = Bench()
    lab = bench.live
    bench.run(2)
    lab.pause(True)
    bench.run(60)
    lab.pause(False)
    lab.set_speed(4)
    bench.run(1)
    lab.change(Stepping(0.013))
    assert bench.run(1).t == pytest.approx(2 + 4 + 4, abs=0.05)  # one step of 0.05
    # the recording clock stands while paused and does not care for speed
    assert bench.keeper.seconds == pytest.approx(4.0, abs=1 / 30)  # from sample to sample
    here = lab.playhead.position
    lab.tick(0.0)  # a clock set back
    lab.tick(0.5)
    assert lab.playhead.position == here + 0.5 * 4


@pytest.mark.parametrize("speed", [1, 16])
def test_time_that_runs_back_to_its_start_is_sampled_there_and_goes_on(speed):
    bench = Bench(DEFAULT_SCENE.altered(h=0.011), speed=speed)
    turn = bench.run(3).t
    bench.live.change(Stepping(-0.011))
    backs = 0
    for _ in range(4 * FPS):
        end = bench.run(1 / FPS)
        backs += bench.live.is_back
    assert backs == 1
    # nothing is dropped: less than a step behind
    assert end.t == pytest.approx(turn - 4 * speed, abs=0.011 + 1e-9)


@pytest.mark.parametrize(("h", "samples"), [(0.001, 60), (0.05, 40)])
def test_thirty_samples_a_second_are_recorded_or_every_step_and_the_last_one(h, samples):
    bench = Bench(DEFAULT_SCENE.altered(h=h))
    bench.run(1)
    bench.live.change(Stepping(-h))  # both ways
    bench.run(1)
    assert len(bench.keeper.samples) == pytest.approx(samples, abs=2)
    bench.live.close()
    assert bench.keeper.samples[-1].t == pytest.approx(0.0, abs=1e-6)


def test_between_steps_the_end_moves_on():
    bench = Bench(DEFAULT_SCENE.altered(h=0.5))
    bench.run(0.8)
    assert (bench.live.sample.t, bench.live.length) == (0.5, pytest.approx(0.8))


def test_where_a_lab_is_among_its_runs_steps_and_events():
    bench = Bench()
    lab = bench.live
    bench.run(9)
    lab.mark()
    lab.start(DEFAULT_SCENE)
    bench.run(8)  # explicit Euler goes over the top at 7.15 s
    lab.change(lab.stepping.next(up=True))
    bench.run(1)
    lab.mark()
    lab.set_speed(2.0)
    assert lab.ticks == pytest.approx([0.0, 7.15, 8.0, 9.0])
    lab.step(-20)
    assert lab.counts == {"run": (2, 2), "step": (150, 170)}
    events = [(each.kind, each.run) for each in lab.events if each.kind != "noticed"]
    assert events == [("start", 1), ("mark", 1), ("start", 2)]  # those ahead are none yet
    for direction, position in ((1, 8.0), (-1, 7.15), (1, 8.0), (1, 9.0), (1, 9.0)):
        lab.seek_event(direction)
        assert lab.playhead.position == pytest.approx(position)
    known = [*bench.keeper.events]
    for position, step in ((-0.1, 0), (99.0, 170)):
        lab.seek(position)
        assert lab.sample.step == step
    assert bench.keeper.events == known


def test_time_that_the_processor_cannot_simulate_is_dropped_and_lowers_the_pace():
    bench = Bench(speed=2.0**20, second_per_look=0.006)
    lab = bench.live
    bench.run(1)
    # three blocks of 256 steps in 20 ms of a frame, and a row each 10 000 steps at least
    assert [sample.step for sample in bench.keeper.samples] == [0, 10_000, 20_000]
    assert lab.sample.step == pytest.approx(30 * 3 * 256, abs=2 * 256)
    share = lab.playhead.position / 2.0**20
    assert lab.pace == pytest.approx(share + (1 - share) / math.e, abs=0.03)  # after 1 s
    assert lab.playhead.position == pytest.approx(lab.sample.t)
    lab.set_speed(1)
    bench.run(1)
    assert lab.pace == pytest.approx(1.0)


def test_after_steps_it_is_paused_and_goes_on_with_the_same_bits_and_records_nothing_twice():
    bench = Bench()
    lab = bench.live
    before = bench.run(3).step
    assert lab.step(1).step == before + 1
    assert lab.step(-26).step == before - 25
    assert lab.playhead.paused
    lab.pause(False)
    sample = bench.run(4)
    assert states(sample) == simulated(DEFAULT_SCENE, sample.step)
    steps = [sample.step for sample in bench.keeper.samples]
    assert steps == sorted(set(steps))
    lab.set_speed(64.0)  # rows are many steps apart
    before = lab.sample.step
    assert lab.step(1501).step == before + 1501
    assert lab.step(-(10**6)).step == 0


def test_a_change_in_the_past_is_a_new_run_that_repeats_what_it_inherits():
    bench = Bench()
    lab = bench.live
    bench.run(1)
    lab.change(Stepping(0.1, equal_cost=True))
    bench.run(2)
    at = lab.step(-5).step
    lab.change(Stepping(0.02))
    lab.pause(False)
    bench.run(1)
    second = [each for each in bench.keeper.events if each.run == 2]
    assert second[0].scene == DEFAULT_SCENE
    changes = [(20, 0.1, True), (at, 0.02, False)]
    inputs = [(each.step, each.h, each.equal_cost) for each in second if each.kind == "set_h"]
    assert inputs == changes
    samples = [sample for sample in bench.keeper.samples if sample.run == 2]
    assert samples[0].step == at
    assert states(samples[-1]) == simulated(DEFAULT_SCENE, samples[-1].step, changes)


def test_every_change_is_an_event_at_its_step_with_a_sample_there():
    bench = Bench()
    lab = bench.live
    bench.run(1)
    lab.change(Stepping(-0.05, equal_cost=True))
    lab.mark("turned")
    lab.mark("turned")  # a moment has one mark
    for paused, speed in ((False, 1), (True, 1), (True, 1), (False, 2), (False, 2)):
        lab.pause(paused)
        lab.set_speed(speed)
    lab.start(SCENES["spin"])
    assert lab.stepping.equal_cost
    assert lab.stepping.smallest == SCENES["spin"].h
    told = [(event.kind, event.h or event.speed or event.text) for event in bench.keeper.events]
    assert told == [
        *(("start", None), ("set_h", -0.05), ("mark", "turned"), ("pause", None)),
        *(("resume", None), ("speed", 2), ("start", None), ("set_h", lab.stepping.h)),
    ]
    later = Keeper()
    lab.record(later)
    assert later.events == lab.events == bench.keeper.events
    assert lab.recording_status == ("mine\ufffd.mcap", later.seconds, None)
    steps = {(sample.run, sample.step) for sample in bench.keeper.samples}
    assert {(event.run, event.step) for event in bench.keeper.events} <= steps


def test_a_change_undone_before_the_next_step_takes_no_verdict_away(tmp_path):
    bench = Lab(record=tmp_path / "lab.mcap")
    lab = bench.live
    start = lab.run_state
    lab.change(lab.stepping.next(up=True))
    lab.return_to(start)
    assert (lab.stepping, lab.sample.run) == (start.stepping, 1)
    bench.run(10)
    before, judged = lab.run_state, lab.judgements
    assert [each.verdict for each in judged] != ["undecided"] * 4
    for _ in range(2):
        lab.change(lab.stepping.next(up=True))
    lab.return_to(before)
    assert (lab.stepping, lab.judgements) == (before.stepping, judged)
    assert lab.sample.run == 2
    bench.run(1)
    lab.change(lab.stepping.next(up=True))
    bench.run(1)
    lab.return_to(before)  # a step later it is a change from here on
    assert (lab.stepping, lab.sample.run) == (before.stepping, 2)
    assert lab.sample.t == pytest.approx(12.0, abs=0.11)
    lab.close()
    assert verify(tmp_path / "lab.mcap").identical


def test_going_back_to_behind_the_last_recorded_sample_spoils_no_later_one(tmp_path, monkeypatch):
    monkeypatch.setattr(rewindable, "COPY_EVERY", 1)  # also at steps that are recorded
    lab = Lab(speed=256.0, record=tmp_path / "lab.mcap")
    for _ in range(9):
        lab.run(0.1)
        lab.live.seek(lab.live.playhead.position - 1.0)  # less than from sample to sample
    lab.live.close()
    assert verify(tmp_path / "lab.mcap").identical


def test_an_absurd_step_size_is_refused_and_changes_nothing():
    bench = Bench()
    lab = bench.live
    bench.run(1)
    lab.step(-3)
    events = len(bench.keeper.events)
    with pytest.raises(InputError):
        lab.change(Stepping(0.0))
    assert (lab.stepping.h, lab.sample.run) == (0.05, 1)
    assert len(bench.keeper.events) == events
    lab.change(lab.stepping.toggled())
    before = lab.run_state
    with pytest.raises(InputError):  # RK4 would take four times the largest h
        lab.start(DEFAULT_SCENE.altered(h=0.9 * Z_LIMITS[1] / DEFAULT_SCENE.w0))
    assert lab.run_state == before


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


def test_a_users_method_takes_one_step_at_a_time_so_that_a_slow_one_leaves_frames():
    def steps(method):
        look = 0.6 * live.FRAME_BUDGET  # s, so that there is time for one look
        scene = DEFAULT_SCENE.with_cast((method,))
        return Bench(scene, speed=64.0, second_per_look=look).run(0.2).step

    assert steps(load(VERLET)) <= 0.2 * FPS + 1
    assert steps(DEFAULT_SCENE.cast[2]) > 100


@pytest.mark.parametrize(
    ("failure", "words"),
    [("time.sleep(0.1)", "takes more than 3 s"), ("sys.exit()", "raises SystemExit")],
)
def test_where_a_users_method_fails_the_run_stands_still_and_can_go_on(failure, words, monkeypatch):
    monkeypatch.setattr("pendu_tui.tui.cli.watchdog.LOOK_INTERVAL", 0.08)
    own = load(FAILING.format(failure))
    scene = DEFAULT_SCENE.with_cast((*DEFAULT_SCENE.cast, own))
    bench = Bench(scene)
    lab = bench.live
    here = bench.run(2)
    monkeypatch.setenv("FAIL", "")
    lab.step(-20)
    assert words in lab.failure
    assert (lab.sample.step, lab.playhead.paused) == (here.step, True)
    monkeypatch.delenv("FAIL")
    lab.pause(False)
    assert lab.failure is None
    sample = bench.run(2)
    assert states(sample) == simulated(scene, sample.step)
    lab.failure = words
    lab.start(scene)
    assert lab.failure is None


def test_a_method_that_fails_while_time_runs_is_tried_once(monkeypatch):
    looks = itertools.repeat(0.0, 3)  # two frames, and one step
    scene = DEFAULT_SCENE.with_cast((load(FAILING.format("sys.exit()")),))
    lab = Lab(scene, work_clock=lambda: next(looks))
    monkeypatch.setenv("FAIL", "")
    assert lab.run(0.2).step == 0
    assert "raises SystemExit" in lab.live.failure
    assert (lab.live.playhead.position, lab.live.playhead.paused) == (0.0, True)


def test_a_milestone_is_an_event_in_the_frame_that_shows_it():
    bench = Bench(speed=7.0)  # a frame is no row
    lab = bench.live
    for _ in range(2 * FPS):
        bench.run(1 / FPS)
        told = [each.step for each in lab.events if each.kind == "noticed"]
        assert told == [each.step for each in lab.milestones]
    assert told
    stepped = Bench(speed=7.0).live
    stepped.step(lab.sample.step)  # without frames
    highs = [each.history.window().high["energy_error"][:-1] for each in (lab, stepped)]
    np.testing.assert_array_equal(*highs)


def test_loops_stay_plain_until_another_thread_has_compiled_them(monkeypatch):
    method, model = DEFAULT_SCENE.cast[3], DEFAULT_SCENE.equations
    release = threading.Event()
    threads = []
    fast = SimpleNamespace(advance=lambda *_: threads.append(threading.current_thread()))

    def slowly(method, model):
        release.wait(10)
        return fast

    monkeypatch.setattr(loops, "COMPILED_FROM", 10)
    monkeypatch.setattr(live, "compiled", slowly)
    monkeypatch.setattr(live, "_compiling", functools.cache(live._compiling.__wrapped__))
    tiered = live.compiled_in_background(method, model)
    start = (1.0, 0.0), 0.05, 20, math.inf
    assert tiered.advance(*start).done == 20  # at once: `slowly` has not been let go
    release.set()
    live._compiling(method, model).result(10)
    tiered.advance(*start)
    main = threading.main_thread()
    assert [each is main for each in threads] == [False, True]  # Numba compiles at the first call


@pytest.mark.parametrize("what", ["theta", "omega", "h"])
def test_a_scene_whose_start_or_step_is_changed_keeps_its_name_and_says_so_once(what):
    lab = live.Live(replace(DEFAULT_SCENE, name="Verlet, then RK4"))
    lab.start(lab.scene)
    assert lab.scene.name == "Verlet, then RK4"
    for value in (0.3, 0.2):
        lab.start(lab.scene.altered(**{what: value}))
        assert lab.scene.name == "Verlet, then RK4 (altered)"
    lab.start(lab.scene.altered(length=2.0))
    assert lab.scene.name == "custom"
