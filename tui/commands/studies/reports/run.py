"""The numbers, the table and the sentences of run."""

import math
from typing import TYPE_CHECKING, Any

from engine.scenes import Scene
from tui.cli.output import fields_of, scene_line
from tui.cli.report import Column
from tui.words.numbers import z_text

if TYPE_CHECKING:
    from engine.run.lockstep import Lockstep, Sample


def rows_of(
    scene: Scene, sample: "Sample", lockstep: "Lockstep", stopped: bool
) -> list[dict[str, Any]]:
    """Return the results by method, as in --json.  A method that diverged has no theta to compare.

    Where evaluations vary they are counted, by running again, unless somebody waits for the end.
    """
    from engine.run.loops import count_evaluations
    from recordings.fields import NUMBERS, OPTIONAL

    model = scene.equations
    exact = scene.exact().at(sample.t).theta
    rows = []
    for method, reading, judgement in zip(
        scene.cast, sample.readings, lockstep.judgements, strict=True
    ):
        end = reading.diverged_at
        error = model.theta_error(reading.theta, exact)
        steps = sample.step if end is None else round(end / scene.h)
        evaluations = method.evaluations(steps)
        if method.varies and end is None and steps and not stopped:
            start = model.start(scene.theta, scene.omega)
            evaluations = count_evaluations(method, model, start, scene.h, steps)
        row = {"method": method.key, **fields_of(reading, *NUMBERS)}
        if not model.energy_error.conserved:
            row["log_energy_error"] = reading.energy_error
        for name in OPTIONAL:
            if (value := getattr(reading, name)) is not None:
                row[name] = value
        for variable in model.variables:
            row[variable.name] = reading.extra.get(variable.name)
        rows.append(
            row
            | {
                "theta_error": None if math.isnan(error) or end is not None else abs(error),
                "drift_per_second": judgement.slope,
                "verdict": judgement.verdict,
                "progress": judgement.progress and judgement.progress._asdict(),
                "lyapunov_per_second": judgement.lyapunov,
                "force_evaluations": evaluations,
                "diverged_at": end,
            }
        )
    return rows


def title_of(scene: Scene, sample: "Sample", wall_seconds: float) -> str:
    million = sample.step / max(wall_seconds, 1e-9) / 1e6
    pace = f", {million:.3g} million a second" if wall_seconds > 1 else ""
    return (
        f"{scene_line(scene, 'h')}, {z_text(scene)}\n"
        f"{sample.step} steps to t = {sample.t:g} s in {wall_seconds:.2f} s{pace}\n"
    )


def columns_of(scene: Scene, lockstep: "Lockstep") -> list[Column]:
    """Return the columns of the table."""
    labels = {method.key: method.label for method in scene.cast}
    judgements = dict(zip(labels, lockstep.judgements, strict=True))

    def verdict(row: dict[str, Any]) -> str:
        end = row["diverged_at"]
        if end is not None:
            return f"diverged at {end:g} s"
        progress = row["progress"]
        text = str(row["verdict"])
        return (
            f"{text}: {progress['have']} of {progress['need']} {progress['unit']}"
            if progress
            else text
        )

    def trend(row: dict[str, Any]) -> str | None:
        value = judgements[row["method"]].trend
        return None if value is None else f"{value:+.1e}"

    return [
        Column("method", lambda row: labels[row["method"]]),
        Column("verdict", verdict),
        *(Column(each.label, each.name, ".4g") for each in scene.equations.quantities()),
        Column(scene.equations.energy_error.name, "energy_error", "+.2e"),
        Column("largest", "max_energy_error", ".2e"),
        Column("per second", trend, right=True),
        Column("theta error [rad]", "theta_error", ".2e"),
        Column("force evaluations", "force_evaluations", "d"),
    ]


def notes_of(scene: Scene, lockstep: "Lockstep") -> list[str]:
    """Return the sentences about what happened on the way."""
    from tui.words.insight import irregular, milestone_insight, sentence

    notes = [
        sentence(milestone_insight(each, scene.equations.energy_error.conserved))
        for each in lockstep.milestones
        if each.kind in ("over the top", "errors cross")
    ]
    for method, judgement in zip(scene.cast, lockstep.judgements, strict=True):
        if judgement.lyapunov and (found := irregular(method, judgement, 0.0)):
            notes.append(sentence(found))
    return notes
