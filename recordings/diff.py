"""Diff: what was done differently in two recordings, and where their numbers diverge."""

from collections import Counter
from collections.abc import Iterator
from heapq import merge
from itertools import groupby
from operator import itemgetter
from typing import Any

from engine.run.lockstep import Sample
from recordings.events import NOT_INPUTS, name_of
from recordings.fields import EXTREMES, differences
from recordings.recording import Recording, Run

SAME_TIME = 9  # decimals of a second: multiples of h are rounded


def compare(a: Recording, b: Recording) -> dict[str, Any]:
    """Compare two open recordings, damaged ones as far as they are intact.

    Returns `done`: what was done differently; `first`: the first number that differs; the numbers
    of samples at equal times and in one recording only; `errors`: the largest of each method at
    equal times.
    """
    samples = 0
    only_in: Counter[str] = Counter()
    first: dict[str, Any] | None = None
    errors: dict[str, dict[str, float]] = {}
    both = merge(_timed(a, "a"), _timed(b, "b"), key=itemgetter(0))
    for _, group in groupby(both, itemgetter(0)):
        at_once = {side: sample for _, side, sample in group}
        if len(at_once) == 1:
            only_in.update(at_once.keys())
            continue
        samples += 1
        in_a = at_once["a"]
        in_b = at_once["b"]
        readings_of_b = dict(zip(b.methods_of(in_b.run), in_b.readings, strict=True))
        for method, reading_a in zip(a.methods_of(in_a.run), in_a.readings, strict=True):
            if method not in readings_of_b:
                continue
            reading_b = readings_of_b[method]
            largest = errors.setdefault(method, {"a": 0.0, "b": 0.0})
            largest["a"] = max(largest["a"], reading_a.max_energy_error)
            largest["b"] = max(largest["b"], reading_b.max_energy_error)
            for name, p, q in differences(reading_a, reading_b):
                if first is None and name not in EXTREMES:
                    first = {"run": in_a.run, "t": in_a.t}
                    first |= {"step_a": in_a.step, "step_b": in_b.step}
                    first |= {"method": method, "field": name, "a": p, "b": q}
    done = list(_done(a, b))
    return {
        "identical": not (done or first or only_in),
        "done": done,
        "first": first,
        "only_in_a": only_in["a"],
        "only_in_b": only_in["b"],
        "samples": samples,
        "errors": errors,
    }


def _done(a: Recording, b: Recording) -> Iterator[tuple[str, str, str]]:
    """Yield what was done differently: where, in a, in b."""
    for number in sorted({run.number for run in (*a.runs, *b.runs)}):
        in_a = _inputs(a.run_of(number))
        in_b = _inputs(b.run_of(number))
        for where in in_a | in_b:
            pair = in_a.get(where, "-"), in_b.get(where, "-")
            if pair[0] != pair[1]:
                yield f"run {number}, {where}", *pair


def _inputs(run: Run | None) -> dict[str, str]:
    """Return everything that determines a run, and what was done in it."""
    if run is None:
        return {}
    inputs = {name: str(value) for name, value in run.scene.numbers.items()}
    inputs["model"] = run.scene.model
    inputs["methods"] = ", ".join(map(name_of, run.scene.cast))
    for _, event in run.events:
        if event.kind in NOT_INPUTS:
            continue
        value = str(event.h or event.speed or event.text or event.kind)
        if event.equal_cost:
            value += " at equal cost"
        inputs[f"{event.kind} at step {event.step}, t = {event.t:g} s"] = value
    return inputs


def _timed(recording: Recording, side: str) -> Iterator[tuple[tuple[int, float], str, Sample]]:
    """Yield (run, simulated time since its start, in either direction [s]), side and sample."""
    run, elapsed, t = 0, 0.0, 0.0
    for _, sample in recording.samples_between():
        if sample.run != run:
            run, elapsed, t = sample.run, 0.0, 0.0
        elapsed += abs(sample.t - t)
        t = sample.t
        yield (run, round(elapsed, SAME_TIME)), side, sample
