"""Find where each method becomes unstable: theory next to measurement.

--section draws the phase portrait of a method's own map, with the orbit of the scene's start.
"""

import argparse
import math
from typing import TYPE_CHECKING

from engine.scenes import Z_LIMITS, Scene
from tui.cli.errors import Exit, UserError
from tui.cli.files import check_free
from tui.cli.options import LIST, angle, count, number, values
from tui.cli.output import progress, warn
from tui.cli.report import add_report_options, publish
from tui.cli.scene import add_scene_options, general_scene_of
from tui.cli.workers import Workers, add_worker_options, workers_of
from tui.commands.studies.reports import figures
from tui.terminal.options import add_picture_options, cells

if TYPE_CHECKING:
    from engine.stability.grid import Grid
    from engine.stability.outcomes import Cells

EXAMPLES = """\
examples:
  pendu-tui stability --theta 120deg --h 0.3
  pendu-tui stability --method mine.py:my_step
  pendu-tui stability --json | jq '.pendulum[] | select(.method == "velocity_verlet")'
  pendu-tui stability --map --workers 4
  pendu-tui stability --z-values 0.005:3:600 --theta-values 1deg:179deg:300 --workers 8 -o map.npz
  pendu-tui stability --section --theta 1.25 --h 0.348 --methods rk4 -o section.svg
"""

MAX_SWINGS = 20_000_000  # of a grid: 320 MB in memory
STEPS = 10_000
SECTION_STEPS = 4000


def add_options(parser: argparse.ArgumentParser) -> None:
    add_scene_options(parser)
    add = parser.add_argument
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--map", action="store_true", help="draw the map: z on x, amplitude on y")
    what.add_argument(
        "--section", action="store_true", help="draw the phase portrait of the first of the methods"
    )
    thetas = f"amplitudes: 0.5,1,120deg or {LIST} (0.1, 0.5, 1, 2, 3 and the scene's; of a map 100)"
    add("--theta-values", metavar="LIST", type=values(angle), help=thetas)
    zs = f"z = h·w0: 0.5,1 or {LIST} (one every 1 %% up to 3.2; of a map 200 up to 3)"
    add("--z-values", metavar="LIST", type=values(number), help=zs)
    add(
        "--steps",
        metavar="N",
        type=count,
        help=f"steps of each swing ({STEPS}), or orbit ({SECTION_STEPS})",
    )
    add("--starts", metavar="N", type=count, default=300, help="orbits of --section (%(default)s)")
    add("--size", metavar="CxR", type=cells, help="columns x rows of --section (the terminal's)")
    add_report_options(parser, csv=True, files=(".npz", ".csv", ".json", ".txt", *figures.SUFFIXES))
    add_worker_options(parser)
    add_picture_options(parser, "auto", "auto")


def run(options: argparse.Namespace) -> int:
    scene = general_scene_of(options)
    suffix = "" if options.output is None else options.output.suffix.lower()
    if options.section:
        return _section(scene, options, suffix)
    if suffix == ".txt":
        raise UserError("only --section writes .txt files; use .npz, .csv, .json or .svg.")
    steps = options.steps or STEPS
    _check(scene, options, steps)
    grids = _grids(scene, options, steps, suffix)
    computed = []
    ended = None
    with workers_of(options) as workers:
        for grid in grids:
            if ended is None:
                swings, ended = compute(grid, workers)
                computed.append((grid, swings))
    from tui.commands.studies.reports.stability import report, write_map

    if suffix in figures.SUFFIXES:
        figures.draw_map(options.output, options.force, *computed[0])
    elif suffix == ".npz":
        write_map(options.output, options.force, *computed[0])
    else:
        publish(report(scene, steps, computed, is_whole=ended is None), options)
    if ended is None:
        return Exit.FINE
    warn(str(ended))
    return ended.code


def _section(scene: Scene, options: argparse.Namespace, suffix: str) -> int:
    if options.csv or suffix in (".npz", ".csv"):
        raise UserError(
            "--section is a picture; write it to a file that ends in .svg, .pdf, .png or .txt, or "
            "use --json."
        )
    from tui.commands.studies.reports import section

    return section.run(scene, options, options.steps or SECTION_STEPS)


def _grids(scene: Scene, options: argparse.Namespace, steps: int, suffix: str) -> "list[Grid]":
    """Return the grids of the table and the map, each if it is wanted."""
    from engine.stability.study import ladder_of, map_of

    is_map = suffix in (".npz", *figures.SUFFIXES)
    grids = []
    if scene.equations.turns and not is_map:
        grids.append(ladder_of(scene, options.theta_values, options.z_values, steps))
    if options.map or is_map:
        grids.append(map_of(scene, options.theta_values, options.z_values, steps))
    for grid in grids:
        if math.prod(grid.shape) > MAX_SWINGS:
            raise UserError(
                f"{math.prod(grid.shape)} swings are too many; use at most {MAX_SWINGS}."
            )
    if suffix in figures.SUFFIXES:
        figures.check(options.output, options.force)
    elif options.output:
        check_free(options.output, options.force)
    return grids


def compute(grid: "Grid", workers: Workers) -> "tuple[Cells, UserError | None]":
    """Return the cells of a grid, and why some of them are unknown.

    Raises UserError if all are.
    """
    from engine.stability.grid import Grid

    computed = grid.unknown()
    done = 0
    try:
        with progress("stability") as show:
            for strip in workers.map(Grid.cells, grid.strips()):
                computed[done : done + len(strip)] = strip
                done += len(strip)
                show(done, len(grid.z))
        return computed, None
    except KeyboardInterrupt:
        ended = UserError("interrupted.", Exit.INTERRUPTED)
    except UserError as error:
        ended = error
    if not done:
        raise ended
    kept = f"{done} of {len(grid.z)} z are computed and kept"
    return computed, UserError(f"{str(ended).rstrip('.')}; {kept}.", ended.code)


def _check(scene: Scene, options: argparse.Namespace, steps: int) -> None:
    """Refuse what is not about this scene, or out of range."""
    asked = {"--map": options.map, "--csv": options.csv, "-o": options.output}
    asked |= {"--theta-values": options.theta_values, "--z-values": options.z_values}
    given = next((name for name, value in asked.items() if value), None)
    if given and not scene.equations.turns:
        raise UserError(
            f"{given} is about a pendulum, and limits of the linear oscillator hold everywhere; "
            "leave it out."
        )
    for what, numbers, (low, high) in (
        ("amplitude", options.theta_values or (), (0, math.pi)),
        ("z", options.z_values or (), Z_LIMITS),
        ("number of steps", [steps], (0, 2**31)),
    ):
        for value in numbers:
            if not low < value < high:  # also refuses nan
                raise UserError(
                    f"{what} {value:g} is out of range; it must lie between {low:g} and {high:g}."
                )
