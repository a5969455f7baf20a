"""The state of the lab or replay in a few sentences, for readers who cannot see the screen."""

import math

from engine.methods import Cast
from tui.playback.source import Source
from tui.words.insight import drift, endings, irregular, milestone_insight, sentence
from tui.words.numbers import about, seconds


def description(source: Source, only: Cast | None = None) -> list[str]:
    """The run, each method, or `only` these, and the recording, one sentence each."""
    shown = [index for index, method in enumerate(source.scene.cast) if only is None or method in only]
    return [*_run(source), *(method_sentence(source, index) for index in shown), _recording(source)]


def _run(source: Source) -> list[str]:
    scene, playhead, sample = source.scene, source.playhead, source.sample
    kind = "The lab" if source.kind == "LIVE" else "The replay"
    speed = "in real time" if playhead.speed == 1 else f"at {playhead.speed:.4g} times real time"
    state = "is paused" if playhead.paused else f"runs {speed} and is"
    cycle = {"libration": "swing", "rotation": "turn"}.get(source.exact.regime)
    motion = f"; one {cycle} takes {about(source.exact.period)}" if cycle and source.exact.period else ""
    return [
        f'{kind} {state} at {seconds(sample.t)} of run {sample.run} of the scene "{scene.name}".',
        f"The pendulum is {scene.length:.4g} m long and started at {math.degrees(scene.theta):.4g} degrees "
        f"with {scene.omega:.4g} radians per second{motion}.",
        f"The step size is {step_text(source)}.",
        *([f"Under it, {source.ghost.label(60)}."] if source.ghost else []),
    ]


def step_text(source: Source) -> str:
    """The current step: "0.2 s, z = 0.626; at equal cost, the cheaper methods split it; time runs backwards"."""
    parts = "; at equal cost, the cheaper methods split it" if source.stepping.equal_cost else ""
    backwards = "; time runs backwards" if source.stepping.h < 0 else ""
    z = abs(source.stepping.h) * source.scene.equations.fastest
    return f"{abs(source.stepping.h):.4g} s, z = {z:.3g}{parts}{backwards}"


def method_sentence(source: Source, index: int) -> str:
    """Whether a method failed or went over the top; if not, its verdict or its error so far."""
    method, reading = source.scene.cast[index], source.sample.readings[index]
    if milestone := endings(source).get(index):
        conserved = source.scene.equations.energy_error.conserved
        judgement = source.judgements[index]
        parts = [
            milestone_insight(milestone, conserved),
            irregular(method, judgement, reading.energy_error),
        ]
        return " ".join(sentence(each) for each in parts if each)
    if source.judgements[index].verdict == "bounded":
        return f"{method.label} stays bounded: its largest energy error is {reading.max_energy_error:.2g}."
    judgement = source.judgements[index]
    verdict = str(judgement) if judgement.verdict == "too early" else f"verdict: {judgement.verdict}"
    if found := drift(source, index):
        return sentence(found)
    return f"{method.label} has an energy error of {reading.energy_error:+.2g}; {verdict}."


def _recording(source: Source) -> str:
    status = source.recording_status
    if status is None:
        return "Not recording."
    if status.failed:
        return f"Not recording: {status.failed}"
    if source.kind == "LIVE":
        return f"Recorded so far: {seconds(status.seconds)} in {status.name}."
    return f"The recording {status.name} is {seconds(status.seconds)} long."
