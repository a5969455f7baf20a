"""Find the step size at which each method becomes unstable, in theory and as measured."""

import argparse

from pendu_tui.engine.stability import LOST
from pendu_tui.tui.cli.errors import Exit
from pendu_tui.tui.cli.files import keep_older
from pendu_tui.tui.cli.options import LIST, angle, count, number, values
from pendu_tui.tui.cli.report import add_report_options, form_of, publish, warn
from pendu_tui.tui.cli.scene import add_scene_options, general_scene_of
from pendu_tui.tui.cli.workers import add_worker_options
from pendu_tui.tui.commands.studies import figures

EXAMPLES = f"""\
examples:
  pendu-tui stability --theta 120deg --h 0.3
  pendu-tui stability --json | jq '.pendulum[] | select(.method == "velocity_verlet")'
  pendu-tui stability --steps 1000 -o map.svg
  pendu-tui stability --z-values 0.005:3:600 --theta-values 1deg:179deg:300 --workers 8 -o map.csv

CSV and figures are of the map, with every swing.

{LOST}
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    add_scene_options(parser)
    add = parser.add_argument
    thetas = f"amplitudes: 0.5,1,120deg or {LIST} (0.1,0.5,1,2,3 and the scene's; for a map 100)"
    add("--theta-values", metavar="LIST", type=values(angle), help=thetas)
    zs = f"z = h·w0: 0.5,1 or {LIST} (up to 3.2 in steps of 1 %%; for a map 200 up to 3)"
    add("--z-values", metavar="LIST", type=values(number), help=zs)
    steps = "steps for each swing (%(default)s)"
    add("--steps", metavar="N", type=count, default=10_000, help=steps)
    add_report_options(parser, csv=True, files=(".csv", ".json", *figures.SUFFIXES))
    add_worker_options(parser)


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
