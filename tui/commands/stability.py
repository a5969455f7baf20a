"""Find the step size at which each method becomes unstable, in theory and as measured."""

import argparse

from pendu_tui.tui.cli.errors import Exit
from pendu_tui.tui.cli.files import keep_older
from pendu_tui.tui.cli.report import form_of, publish, warn
from pendu_tui.tui.cli.scene import general_scene_of
from pendu_tui.tui.commands.studies import figures


def run(options: argparse.Namespace) -> int:
    scene = general_scene_of(options)
    is_figure = figures.check_output(options)
    is_map = is_figure or form_of(options) == "csv"
    from pendu_tui.engine.stability.study import table
    from pendu_tui.tui.commands.studies.stability import compute, grid_of, map_report, report

    grid = grid_of(scene, options, is_map)
    if grid is None:
        publish(report(scene, options.steps, []), options)
        return Exit.FINE
    cells, ended = compute(grid, options)
    if ended:
        keep_older(options.output)
    if is_figure:
        figures.draw_map(options, grid, cells)
    elif is_map:
        publish(map_report(grid, cells), options)
    else:
        rows = table(scene, grid, cells)
        if ended:  # the others may fail at a z not yet computed
            rows = [row for row in rows if row.failure]
        publish(report(scene, options.steps, rows, is_whole=ended is None), options)
    if ended is None:
        return Exit.FINE
    warn(str(ended))
    return ended.code
