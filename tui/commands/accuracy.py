"""Chart speed against accuracy over a ladder of h; find the cheapest method and h."""

import argparse

from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.files import keep_older
from pendu_tui.tui.cli.report import publish, warn
from pendu_tui.tui.cli.scene import general_scene_of
from pendu_tui.tui.commands.studies import figures


def run(options: argparse.Namespace) -> int:
    if options.all and options.methods is not None:
        raise UserError("--all and --methods exclude each other; choose one of them.")
    if options.cost == "seconds" and (options.workers > 1 or options.dask):
        raise UserError("seconds are measured in this process; use workers for evaluations only.")
    is_figure = figures.check_output(options)
    scene = general_scene_of(options)
    if scene.theta == scene.omega == 0:
        raise UserError(
            "the pendulum hangs at rest, so there is no error to measure; use another --theta or "
            "--omega."
        )
    from pendu_tui.tui.commands.studies.accuracy import Results, measure, report

    results = Results(scene, options)
    interrupted = False
    try:
        measure(results)
    except KeyboardInterrupt:
        interrupted = True
        keep_older(options.output)
    if is_figure:
        figures.draw_accuracy(options, results.scene.cast, results.points)
    else:
        publish(report(results, interrupted), options)
    if interrupted:
        warn("interrupted; partial results are kept.")
        return Exit.INTERRUPTED
    if results.advice and results.advice.point is None:
        warn(f"no method reaches the target over {results.time:g} s.")
        return Exit.CHECK_FAILED
    return Exit.FINE
