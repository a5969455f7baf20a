"""The numbers, the table and the sentences of run."""

import math
from typing import TYPE_CHECKING, Any

from engine.run.judgement import Judgement, Progress
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


def known(row: dict[str, Any]) -> dict[str, Any]:
    """Return a row for JSON, where only an irregular orbit has a Lyapunov number."""
    return {
        name: value
        for name, value in row.items()
        if name != "lyapunov_per_second" or value is not None
    }


def columns_of(scene: Scene, lockstep: "Lockstep | None" = None) -> list[Column]:
    """Return the columns of the table; with the trend where the lockstep of the run is given."""
    labels = {method.key: method.label for method in scene.cast}
    trends = []
    if lockstep is not None:
        judgements = dict(zip(labels, lockstep.judgements, strict=True))
        trends.append(Column("per second", lambda row: judgements[row["method"]].slope, "+.1e"))
    return [
        Column("method", lambda row: labels[row["method"]]),
        Column("verdict", verdict_of),
        *(Column(each.label, each.name, ".4g") for each in scene.equations.quantities()),
        Column(scene.equations.energy_error.name, "energy_error", "+.2e"),
        Column("largest", "max_energy_error", ".2e"),
        *trends,
        Column("theta error [rad]", "theta_error", ".2e"),
        Column("force evaluations", "force_evaluations", "d"),
    ]


def verdict_of(row: dict[str, Any]) -> str:
    """Return the verdict, how much of the evidence there is, or when the method diverged."""
    end = row["diverged_at"]
    if end is not None:
        return f"diverged at {end:g} s"
    progress = row["progress"]
    if progress is None:
        return str(row["verdict"])
    return str(Judgement(row["verdict"], progress=Progress(**progress)))


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
