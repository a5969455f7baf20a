"""The run in a few plain sentences, for those who cannot see the screen, or not all of it."""

import math

from engine.methods import METHODS
from tui.playback.source import Source
from tui.words.findings import about, failed, leaving, over_the_top
from tui.words.numbers import seconds


def description(source: Source) -> list[str]:
    """What runs and what each method does, a line a thought."""
    return [*_run(source), *(method_sentence(source, index) for index in range(len(METHODS))), *_tape(source)]


def _run(source: Source) -> list[str]:
    scene, playhead, sample = source.scene, source.playhead, source.sample
    kind = "The lab" if source.kind == "LIVE" else "The replay"
    state = "is paused" if playhead.paused else f"runs at {playhead.speed:.4g} times real time"
    regime = {"libration": "swings", "rotation": "turns over and over"}.get(source.exact.regime)
    motion = f"; it {regime}, once in {about(source.exact.period)}" if regime and source.exact.period else ""
    return [
        f"{kind} {state}, at {seconds(sample.t)} of run {sample.run}, scene {scene.name}.",
        f"The pendulum is {scene.length:.4g} m long and started at {math.degrees(scene.theta):.4g} degrees "
        f"with {scene.omega:.4g} radians per second{motion}.",
        f"The step size is {step_text(source)}.",
    ]


def step_text(source: Source) -> str:
    """The step in force: "0.2 s, z = 0.626; at equal cost, some take it in parts; time runs backwards"."""
    parts = "; at equal cost, some take it in parts" if source.stepping.equal_cost else ""
    backwards = "; time runs backwards" if source.stepping.h < 0 else ""
    return f"{abs(source.stepping.h):.4g} s, z = {abs(source.stepping.h) * source.scene.w0:.3g}{parts}{backwards}"


def method_sentence(source: Source, index: int) -> str:
    """What a method does: its end, its way over the top, its verdict, or its error so far."""
    method, reading = METHODS[index], source.sample.readings[index]
    happened = {each.kind: each for each in source.milestones if each.index == index}
    if "failed" in happened:
        return failed(happened["failed"])
    if "over the top" in happened:
        return over_the_top(happened["over the top"])
    if source.judgements[index].verdict == "bounded":
        return f"{method.label} stays within a band: its energy is off by {reading.max_energy_error:.2g} at most."
    return leaving(source, index) or (
        f"{method.label} is off by {reading.energy_error:+.2g} of its energy; it is too early for a verdict."
    )


def _tape(source: Source) -> list[str]:
    recording_status = source.recording_status
    if recording_status is None:
        return ["Nothing is recorded."]
    if recording_status.failed:
        return [f"Nothing is being recorded: {recording_status.failed}"]
    verb = "Recorded so far" if source.kind == "LIVE" else "The recording"
    return [f"{verb}: {seconds(recording_status.seconds)} in {recording_status.name}."]
