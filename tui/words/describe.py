"""The state of the lab or replay in a few sentences, for readers who cannot see the screen."""

from engine.methods import Cast
from tui.playback.source import Source
from tui.words.insight import drift, endings, irregular, milestone_insight, sentence
from tui.words.numbers import about, seconds, start


def description(source: Source, only: Cast | None = None) -> list[str]:
    """Return sentences on the run, each method, or `only` these, and the recording."""
    shown = [
        index for index, method in enumerate(source.scene.cast) if only is None or method in only
    ]
    return [*_run(source), *(method_sentence(source, index) for index in shown), _recording(source)]


def _run(source: Source) -> list[str]:
    scene = source.scene
    playhead = source.playhead
    sample = source.sample
    kind = "The lab" if source.kind == "LIVE" else "The replay"
    speed = "in real time" if playhead.speed == 1 else f"at {playhead.speed:.4g} times real time"
    state = "is paused" if playhead.paused else f"runs {speed} and is"
    motion = ""
    if source.exact.period is not None:
        cycle = "turn" if source.exact.regime == "rotation" else "swing"
        motion = f"; one {cycle} takes {about(source.exact.period)}"
    lines = [
        f'{kind} {state} at {seconds(sample.t)} of run {sample.run} of the scene "{scene.name}".',
        f"The pendulum is {scene.length:.4g} m long and started at "
        f"{start(scene.theta, scene.omega)}{motion}.",
        f"The step size is {step_text(source)}.",
    ]
    if source.failure:
        lines.append(f"It stands still: {source.failure}")
    return [*lines, f"Under it, {source.ghost.label(60)}."] if source.ghost else lines


def step_text(source: Source) -> str:
    """Return the current step: "0.2 s, z = 0.626; at equal cost, the cheaper methods split it"."""
    h = source.stepping.h
    text = f"{abs(h):.4g} s, z = {abs(h) * source.scene.equations.fastest:.3g}"
    if source.stepping.equal_cost:
        text += "; at equal cost, the cheaper methods split it"
    return f"{text}; time runs backwards" if h < 0 else text


def method_sentence(source: Source, index: int) -> str:
    """Return how a method failed or went over the top, else its verdict or error so far."""
    method = source.scene.cast[index]
    reading = source.sample.readings[index]
    if milestone := endings(source).get(index):
        conserved = source.scene.equations.energy_error.conserved
        judgement = source.judgements[index]
        parts = [
            milestone_insight(milestone, conserved),
            irregular(method, judgement, reading.energy_error),
        ]
        return " ".join(sentence(each) for each in parts if each)
    if source.judgements[index].verdict == "bounded":
        error = reading.max_energy_error
        return f"{method.label} stays bounded: its largest energy error is {error:.2g}."
    judgement = source.judgements[index]
    verdict = (
        str(judgement) if judgement.verdict == "too early" else f"verdict: {judgement.verdict}"
    )
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
