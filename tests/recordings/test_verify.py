"""Verify: re-simulation gives the recorded bits, or says where it does not."""

import math
from dataclasses import replace
from functools import partial
from itertools import count

import pytest

from pendu_tui.engine.methods import VELOCITY_VERLET, method_of
from pendu_tui.engine.run import loops
from pendu_tui.engine.run.lockstep import Lockstep
from pendu_tui.engine.run.loops import CompiledLoops
from pendu_tui.engine.scenes import SCENES
from pendu_tui.recordings.events import Entry, Event, arithmetic_here, simulate
from pendu_tui.recordings.files import RecordingError
from pendu_tui.recordings.recorder import Recorder
from pendu_tui.recordings.verification import verify
from tests.recordings.examples import SCENE, record, start, two_runs, with_changes


def altered(entries, at, method, **numbers):
    """Return the entries with other numbers of a method in the sample at an index."""
    clock, sample = entries[at]
    readings = list(sample.readings)
    readings[method] = readings[method]._replace(**numbers)
    changed = list(entries)
    changed[at] = Entry(clock, sample._replace(readings=tuple(readings)))
    return changed


def reading_of(entries, at, method):
    return entries[at].value.readings[method]


def test_a_recording_of_several_runs_and_changes_of_h_verifies(tmp_path):
    verification = verify(record(tmp_path / "a.mcap", two_runs()))
    assert (verification.complete, verification.identical) == (True, True)
    assert (verification.reason, verification.first_difference) == (None, None)
    assert (verification.runs, verification.samples) == (2, 10)
    assert verification.other_functions == ()


def test_a_value_that_an_older_version_did_not_record_is_not_compared(tmp_path):
    lockstep = Lockstep(SCENES["mean-field"])
    lockstep.advance(10)
    sample = lockstep.sample()
    older = tuple(reading._replace(max_invariant_error=None) for reading in sample.readings)
    assert older != sample.readings
    entries = [
        Entry(0.0, start(scene=SCENES["mean-field"])),
        Entry(0.1, sample._replace(readings=older)),
    ]
    assert verify(record(tmp_path / "a.mcap", entries)).identical


def test_a_failure_that_was_not_recorded_is_found(tmp_path):
    scene = replace(SCENE, theta=3.0, h=0.7, cast=(method_of("implicit_midpoint"), VELOCITY_VERLET))
    *_, last = simulate(scene, 7.0)
    entries = [Entry(0.0, start(scene=scene)), Entry(7.0, last)]
    assert verify(record(tmp_path / "a.mcap", entries)).identical
    path = record(tmp_path / "b.mcap", altered(entries, 1, 0, diverged_at=None))
    found = verify(path).first_difference
    assert (found.field, found.recorded, found.computed) == ("diverged_at", None, 0.7)


@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize(("sample_every", "change"), [(1, (40, -0.05)), (7, (0, 1e-3))])
def test_every_scene_verifies_however_it_is_sampled(tmp_path, scene, sample_every, change):
    time = min(3.0, 100 * SCENES[scene].h)
    with Recorder(tmp_path / "a.mcap") as recorder:
        list(with_changes(SCENES[scene], time, recorder, [change], sample_every))
    assert verify(tmp_path / "a.mcap").identical


FIELDS = ["theta", "omega", "energy", "energy_error", "max_energy_error", "energy_error_low"]


@pytest.mark.parametrize("field", FIELDS)
@pytest.mark.parametrize(("index", "method"), [(0, "explicit_euler"), (3, "rk4")])
def test_one_unit_in_the_last_place_is_found_and_reported_in_detail(tmp_path, field, index, method):
    entries, at = two_runs(), 3
    right = getattr(reading_of(entries, at, index), field)
    wrong = math.nextafter(right, math.inf)
    path = record(tmp_path / "a.mcap", altered(entries, at, index, **{field: wrong}))
    verification = verify(path)
    assert (verification.complete, verification.identical) == (True, False)
    found = verification.first_difference
    assert (found.run, found.step, found.t) == (1, 6, entries[at].value.t)
    assert (found.method, found.field) == (method, field)
    assert (found.recorded, found.computed) == (wrong, right)


def test_a_wrong_time_is_found(tmp_path):
    entries = two_runs()
    clock, sample = entries[3]
    entries[3] = Entry(clock, sample._replace(t=0.61))
    difference = verify(record(tmp_path / "a.mcap", entries)).first_difference
    assert (difference.method, difference.field, difference.recorded) == ("", "t", 0.61)


def test_minus_zero_differs_from_zero(tmp_path):
    scene = replace(SCENE, theta=0.0)
    entries = [Entry(0.0, start(scene=scene)), Entry(0.0, Lockstep(scene).sample())]
    assert verify(record(tmp_path / "a.mcap", entries)).identical
    path = record(tmp_path / "b.mcap", altered(entries, 1, 0, omega=-0.0))
    assert verify(path).first_difference.field == "omega"


@pytest.mark.parametrize(
    ("kept", "more", "why"),
    [
        (1, [], "it has no samples"),
        (4, [Event("set_h", 1, 2, 0.2, h=0.2), two_runs()[4].value], "not in order"),
        (4, [two_runs()[3].value._replace(step=10**15)], r"use --max-steps \d+\.$"),
    ],
)
def test_an_impossible_recording_is_refused_in_a_sentence(tmp_path, kept, more, why):
    entries = [*two_runs()[:kept], *(Entry(1.0, value) for value in more)]
    path = record(tmp_path / "a.mcap", entries)
    with pytest.raises(RecordingError, match=why) as caught:
        verify(path)
    assert str(caught.value).startswith(str(path))


def of_another_machine(monkeypatch):
    """Change the fingerprint of this machine's sin."""
    here = arithmetic_here()._replace(sin="another")
    monkeypatch.setattr("pendu_tui.recordings.events.fingerprint", lambda name: getattr(here, name))


def foreign_loops(monkeypatch, every):
    """Return loops with the sin of another libm, which differs at one in `every` calls."""
    calls = count(1)

    def sin(x):
        if next(calls) % every == 0:
            return math.nextafter(math.sin(x), math.inf)
        return math.sin(x)

    def loops_of(method, model):
        def take(phase, h, n, limit):
            return loops.take(method.on(model, sin)(phase, h), model.energy(sin), n, limit)

        return CompiledLoops(
            loops.PlainLoops(method, model).propagate, partial(loops.advance, take)
        )

    of_another_machine(monkeypatch)
    return loops_of


@pytest.mark.parametrize("scene", ["crossover", "near-separatrix", "spin", "stiff-slow"])
def test_a_recording_from_a_machine_with_another_sin_verifies_within_the_tolerance(
    tmp_path, monkeypatch, scene
):
    path, time = tmp_path / "a.mcap", 1500 * SCENES[scene].h
    with monkeypatch.context() as elsewhere, Recorder(path) as recorder:
        foreign = foreign_loops(elsewhere, every=2)  # much worse than any libm
        list(simulate(SCENES[scene], time, recorder, sample_every=5, loops=foreign))
    verification = verify(path)
    assert verification.other_functions == ("sin",)
    assert verification.identical
    of_another_machine(monkeypatch)
    assert verify(path).identical == (scene == "stiff-slow")  # the only one without a sine


def test_a_difference_beyond_the_tolerance_is_found_even_if_sin_differs(tmp_path, monkeypatch):
    entries = two_runs()
    right = reading_of(entries, 7, 2).theta
    with monkeypatch.context() as elsewhere:
        of_another_machine(elsewhere)
        wrong = altered(entries, 7, 2, theta=right * (1 + 5e-6))
        record(tmp_path / "a.mcap", wrong)
    difference = verify(tmp_path / "a.mcap").first_difference
    assert (difference.method, difference.field) == ("velocity_verlet", "theta")
    assert difference.computed == right


def test_no_more_steps_are_simulated_than_samples_need(tmp_path):
    far = Entry(1.0, Event("set_h", 1, 10**15, 0.6, h=0.1))
    assert verify(record(tmp_path / "a.mcap", [*two_runs()[:4], far]), max_steps=6).identical
    with pytest.raises(RecordingError, match="claims 6 steps"):
        verify(tmp_path / "a.mcap", max_steps=5)


@pytest.mark.parametrize(("last", "is_refused"), [(300, False), (301, True)])
def test_without_a_limit_a_hundred_steps_a_sample_are_simulated(
    tmp_path, monkeypatch, last, is_refused
):
    monkeypatch.setattr("pendu_tui.recordings.verification.MAX_STEPS", 1)
    lockstep = Lockstep(SCENE)
    entries = [Entry(0.0, start())]
    for step in (0, 1, last):
        lockstep.advance(step - lockstep.step)
        entries.append(Entry(0.0, lockstep.sample()))
    path = record(tmp_path / "a.mcap", entries)
    if is_refused:
        with pytest.raises(RecordingError, match="claims 301 steps"):
            verify(path)
    else:
        assert verify(path).identical
