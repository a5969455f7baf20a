"""Diff: what was done differently in two recordings, and where their numbers part."""

from collections.abc import Iterator
from heapq import merge
from itertools import groupby
from operator import itemgetter
from typing import Any

from engine.run.lockstep import Sample
from recordings.events import NOT_DONE, name_of
from recordings.fields import EXTREMES, differences
from recordings.recording import Recording, Run

SAME_TIME = 9  # decimals of a second: multiples of h are rounded


def compare(a: Recording, b: Recording) -> dict[str, Any]:
    """Compare two open recordings, damaged ones as far as they are intact.

    Returns `done`: what was done differently; `first`: the first number that differs; how many
    samples are at equal times, or in one only; `errors`: the largest at equal times, by method.
    """
    samples = 0
    only_in = {"a": 0, "b": 0}
    first: dict[str, Any] | None = None
    errors: dict[str, dict[str, float]] = {}
    both = merge(_timed(a, "a"), _timed(b, "b"), key=itemgetter(0))
    for _, group in groupby(both, itemgetter(0)):
        at_once = {side: sample for _, side, sample in group}
        if len(at_once) == 1:
            only_in[min(at_once)] += 1
            continue
        one, other = at_once["a"], at_once["b"]
        samples += 1
        theirs = dict(zip(b.methods_of(other.run), other.readings, strict=True))
        for method, x in zip(a.methods_of(one.run), one.readings, strict=True):
            if (y := theirs.get(method)) is None:
                continue
            known = errors.setdefault(method, {"a": 0.0, "b": 0.0})
            known["a"] = max(known["a"], x.max_energy_error)
            known["b"] = max(known["b"], y.max_energy_error)
            for name, p, q in differences(x, y):
                if first is None and name not in EXTREMES:
                    first = {"run": one.run, "t": one.t, "step_a": one.step, "step_b": other.step}
                    first |= {"method": method, "field": name, "a": p, "b": q}
    found: dict[str, Any] = {"done": list(_done(a, b)), "first": first}
    found |= {f"only_in_{side}": count for side, count in only_in.items()}
    return {"identical": not any(found.values()), **found, "samples": samples, "errors": errors}


def _done(a: Recording, b: Recording) -> Iterator[tuple[str, str, str]]:
    """Yield what was done differently: where, in a, in b."""
    for number in sorted({run.number for run in (*a.runs, *b.runs)}):
        in_a, in_b = _inputs(a.run_of(number)), _inputs(b.run_of(number))
        for where in in_a | in_b:
            pair = in_a.get(where, "-"), in_b.get(where, "-")
            if pair[0] != pair[1]:
                yield f"run {number}, {where}", *pair


def _inputs(run: Run | None) -> dict[str, str]:
    """Return all that determines a run, and what was done in it."""
    if run is None:
        return {}
    inputs = {name: str(value) for name, value in run.scene.numbers.items()}
    inputs["model"] = run.scene.model
    inputs["methods"] = ", ".join(map(name_of, run.scene.cast))
    for _, event in run.events:
        if event.kind not in NOT_DONE:
            value = event.h or event.speed or event.text or event.kind
            where = f"{event.kind} at step {event.step}, t = {event.t:g} s"
            inputs[where] = f"{value} at equal cost" if event.equal_cost else str(value)
    return inputs


def _timed(recording: Recording, side: str) -> Iterator[tuple[tuple[int, float], str, Sample]]:
    """Yield (run, time simulated since its start, forwards or backwards [s]), side and sample."""
    run, elapsed, t = 0, 0.0, 0.0
    for _, sample in recording.samples_between():
        if sample.run != run:
            run, elapsed, t = sample.run, 0.0, 0.0
        elapsed += abs(sample.t - t)
        t = sample.t
        yield (run, round(elapsed, SAME_TIME)), side, sample
