"""Verify: re-simulation gives the recorded bits, or says where it does not."""

import math
from dataclasses import replace
from itertools import count

import pytest

from pendu_tui import recordings
from pendu_tui.engine.methods import VELOCITY_VERLET, method_of
from pendu_tui.engine.scenes import SCENES
from pendu_tui.recordings.events import Entry, Event, arithmetic_here
from pendu_tui.recordings.files import RecordingError
from pendu_tui.recordings.format import values_of
from pendu_tui.recordings.pytest import verify_recordings
from pendu_tui.recordings.recording import Recording
from pendu_tui.recordings.verification import verify
from tests.recordings.examples import SCENE, record, run_of, start, two_runs


def altered(entries, at, method, **numbers):
    """Return the entries with other numbers of a method in the sample at an index."""
    clock, sample = entries[at]
    readings = list(sample.readings)
    extra = {**readings[method].extra, **numbers}
    own = {name: extra.pop(name) for name in numbers if hasattr(readings[method], name)}
    readings[method] = readings[method]._replace(**own, extra=extra)
    changed = list(entries)
    changed[at] = Entry(clock, sample._replace(readings=tuple(readings)))
    return changed


@pytest.fixture
def verified(tmp_path):
    numbers = count()
    return lambda entries, *options: verify(
        record(tmp_path / f"{next(numbers)}.mcap", entries), *options
    )


def test_a_recording_of_several_runs_and_changes_of_h_verifies(verified):
    shares = []
    verification = verified(two_runs(), lambda *each: shares.append(each))
    assert (shares[0], shares[-1]) == ((0.0, 4.0), (4.0, 4.0))  # s, of those in all
    assert (verification.complete, verification.identical) == (True, True)
    assert (verification.reason, verification.first_difference) == (None, None)
    assert (verification.runs, verification.samples) == (2, 10)
    assert verification.methods == tuple(method.key for method in SCENE.cast)
    assert verification.other_functions == ()


def test_the_room_offers_what_programs_import_and_nothing_else():
    assert recordings.__all__ == ["Recording", "verify"]
    assert (recordings.Recording, recordings.verify) == (Recording, verify)
    with pytest.raises(AttributeError, match="no attribute 'verfy'"):
        recordings.verfy  # noqa: B018


def test_a_value_that_an_older_version_did_not_record_is_not_compared(verified):
    entries = run_of(SCENES["mean-field"], 10)
    older = altered(entries, 1, 0, max_invariant_error=None)
    assert verified(older).identical


def test_a_failure_that_was_not_recorded_is_found(verified):
    scene = replace(SCENE, theta=3.0, h=0.7, cast=(method_of("implicit_midpoint"), VELOCITY_VERLET))
    entries = run_of(scene, 10)
    for arithmetic in (None, arithmetic_here()._replace(sin="another")):
        entries[0] = Entry(0.0, start(scene=scene)._replace(arithmetic=arithmetic))
        assert verified(entries).identical
        found = verified(altered(entries, 1, 0, diverged_at=None)).first_difference
        assert (found.field, found.recorded, found.computed) == ("diverged_at", None, 0.7)
        found = verified(altered(entries, 1, 1, diverged_at=0.7)).first_difference
        assert (found.field, found.recorded, found.computed) == ("diverged_at", 0.7, None)


@pytest.mark.parametrize(
    ("entries", "at", "method", "key"),
    [
        (two_runs(), 3, 0, "explicit_euler"),
        (two_runs(), 3, 3, "rk4"),
        (run_of(SCENES["stiff-slow"], 0, 50), 2, 0, "velocity_verlet"),
    ],
)
def test_one_unit_in_the_last_place_is_found_and_reported_in_detail(
    verified, entries, at, method, key
):
    _, sample = entries[at]
    for field, right in values_of(sample.readings[method]).items():
        if right is None:
            continue
        wrong = math.nextafter(right, math.inf)
        verification = verified(altered(entries, at, method, **{field: wrong}))
        assert (verification.complete, verification.identical) == (True, False)
        found = verification.first_difference
        assert (found.run, found.step, found.t) == (1, sample.step, sample.t)
        assert (found.method, found.field) == (key, field)
        assert (found.recorded, found.computed) == (wrong, right)


def test_a_wrong_time_is_found_and_a_folder_with_it_fails_as_a_test(verified, tmp_path):
    entries = two_runs()
    clock, sample = entries[3]
    entries[3] = Entry(clock, sample._replace(t=0.61))
    entries[4] = Entry(entries[4].clock, entries[4].value._replace(t=0.91))
    found = verified(entries).first_difference
    assert (found.method, found.field, found.recorded) == ("", "t", 0.61)
    (tmp_path / "in").mkdir()
    record(tmp_path / "in" / "whole.mcap", two_runs())
    (tmp_path / "in" / "cut.mcap").write_bytes((tmp_path / "in" / "whole.mcap").read_bytes()[:-9])
    (tmp_path / "odd.mcap").touch()
    test = verify_recordings(tmp_path)
    (names,) = (mark.args[1] for mark in test.pytestmark)
    assert names == ["0.mcap", "in/cut.mcap", "in/whole.mcap", "odd.mcap"]
    test("in/whole.mcap")
    reasons = {
        "0.mcap": "0.mcap: run 1, step 6, t = 0.61 s, .*t is 0.6000.*, recorded 0.61",
        "in/cut.mcap": "cut.mcap: its end is missing",
        "odd.mcap": "odd.mcap: its end is missing",
    }
    for name, reason in reasons.items():
        with pytest.raises(pytest.fail.Exception, match=reason) as failed:
            test(name)
        assert not failed.value.pytrace
    ((empty,),) = (mark.args[1] for mark in verify_recordings(tmp_path / "none").pytestmark)
    with pytest.raises(pytest.fail.Exception, match="no recording below"):
        test(empty)


def test_minus_zero_differs_from_zero(verified):
    entries = run_of(replace(SCENE, theta=0.0), 0)
    assert verified(entries).identical
    assert verified(altered(entries, 1, 0, omega=-0.0)).first_difference.field == "omega"


@pytest.mark.parametrize(
    ("kept", "more", "why"),
    [
        (1, [], "it has no samples"),
        (4, [Event("set_h", 1, 2, 0.2, h=0.2), two_runs()[4].value], "not in order"),
        (
            4,
            [two_runs()[3].value._replace(step=1_000_001)],
            r"limit of 1000000; .* use --max-steps 1000001\.$",
        ),
    ],
)
def test_an_impossible_recording_is_refused_in_a_sentence(verified, kept, more, why):
    entries = [*two_runs()[:kept], *(Entry(1.0, value) for value in more)]
    with pytest.raises(RecordingError, match=rf"0\.mcap: .*{why}"):
        verified(entries)


def test_where_sin_differs_numbers_may_differ_within_a_tolerance(verified):
    entries = two_runs()
    right = entries[7].value.readings[2].energy
    small = entries[7].value.readings[2].energy_error
    assert 0 < abs(small) < 0.1
    assert right > 3
    elsewhere = arithmetic_here()._replace(numerics=1, sin="another", sqrt="too")
    entries[0] = Entry(0.0, start()._replace(arithmetic=elsewhere))
    for field, wrong, is_close in (
        ("energy_error", small + 5e-7, True),
        ("energy_error", small + 5e-6, False),
        ("energy", right * (1 + 5e-7), True),
        ("energy", right * (1 + 5e-6), False),
    ):
        verification = verified(altered(entries[:8], 7, 2, **{field: wrong}))
        found = verification.first_difference
        assert (verification.numerics, verification.other_functions) == (1, ("sin", "sqrt"))
        assert verification.identical == (found is None) == is_close
    assert (found.method, found.field) == ("velocity_verlet", "energy")
    assert found.computed == right


@pytest.mark.parametrize(
    ("steps", "limit", "passes"),
    [(300, None, True), (301, None, False), (301, 301, True), (150, 149, False)],
)
def test_no_more_than_a_hundred_steps_a_sample_are_simulated_or_what_the_user_allows(
    verified, monkeypatch, steps, limit, passes
):
    monkeypatch.setattr("pendu_tui.recordings.verification.MAX_STEPS", 200)
    far = Entry(99.0, Event("set_h", 2, 10**15, 30.0, h=0.1))
    other = [value._replace(run=2) for _, value in run_of(SCENE, 9)]
    entries = [*run_of(SCENE, 0, steps - 9), *(Entry(99.0, each) for each in other), far]
    if passes:
        assert verified(entries, lambda *_: None, limit).identical
    else:
        with pytest.raises(RecordingError, match=f"claims {steps} steps"):
            verified(entries, lambda *_: None, limit)
