"""Find the step size at which each method becomes unstable, in theory and as measured.

--section draws the phase portrait of one method instead, with the orbit of the scene's start.
"""

import argparse

from pendu_tui.engine.stability import LOST
from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.options import LIST, angle, count, number, values
from pendu_tui.tui.cli.report import add_report_options, publish, warn
from pendu_tui.tui.cli.scene import add_scene_options, general_scene_of
from pendu_tui.tui.cli.workers import add_worker_options
from pendu_tui.tui.commands.studies import figures

EXAMPLES = f"""\
examples:
  pendu-tui stability --theta 120deg --h 0.3
  pendu-tui stability --json | jq '.pendulum[] | select(.method == "velocity_verlet")'
  pendu-tui stability --z-values 0.005:3:600 --theta-values 1deg:179deg:300 --workers 8 -o map.npz
  pendu-tui stability --section --theta 1.25 --h 0.348 --methods rk4 -o section.svg

{LOST}
"""

STEPS = 10_000
SECTION_STEPS = 4000


def add_options(parser: argparse.ArgumentParser) -> None:
    add_scene_options(parser)
    add = parser.add_argument
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--map", action="store_true", help="draw the map: z on x, amplitude on y")
    portrait = "draw the phase portrait of the first method"
    what.add_argument("--section", action="store_true", help=portrait)
    thetas = f"amplitudes: 0.5,1,120deg or {LIST} (0.1,0.5,1,2,3 and the scene's; for a map 100)"
    add("--theta-values", metavar="LIST", type=values(angle), help=thetas)
    zs = f"z = h·w0: 0.5,1 or {LIST} (up to 3.2 in steps of 1 %%; for a map 200 up to 3)"
    add("--z-values", metavar="LIST", type=values(number), help=zs)
    steps = f"steps for each amplitude ({STEPS}) or orbit ({SECTION_STEPS})"
    add("--steps", metavar="N", type=count, help=steps)
    add(
        "--starts",
        metavar="N",
        type=count,
        default=300,
        help="orbits to draw with --section (%(default)s)",
    )
    add_report_options(parser, csv=True, files=(".npz", ".csv", ".json", *figures.SUFFIXES))
    add_worker_options(parser)


def run(options: argparse.Namespace) -> int:
    scene = general_scene_of(options)
    options.steps = options.steps or (SECTION_STEPS if options.section else STEPS)
    suffix = options.output and options.output.suffix.lower()
    is_figure = figures.check_output(options)
    from pendu_tui.tui.commands.studies.stability import (
        compute,
        grids_of,
        report,
        show_section,
        write_map,
    )

    if options.section:
        if options.csv or suffix in (".npz", ".csv"):
            raise UserError("--section is a picture: write an .svg, .pdf or .png, or use --json.")
        show_section(scene, options, is_figure)
        return Exit.FINE

    is_map = is_figure or suffix == ".npz"
    computed, ended = compute(grids_of(scene, options, is_map), options)
    if is_figure:
        figures.draw_map(options, *computed[0])
    elif is_map:
        write_map(options, *computed[0])
    else:
        publish(report(scene, options.steps, computed, is_whole=ended is None), options)
    if ended is None:
        return Exit.FINE
    warn(str(ended))
    return ended.code
