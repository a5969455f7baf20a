"""Find where each method becomes unstable: theory next to measurement, for the linear oscillator and the pendulum."""

import argparse
import math
import os
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from engine.scenes import Z_LIMITS
from tui.cli.errors import Exit, UserError
from tui.cli.install import install_advice
from tui.cli.options import add_file, angle, count, number
from tui.cli.output import progress
from tui.cli.scene import add_scene_options, general_scene_of

if TYPE_CHECKING:
    from concurrent.futures import Executor

EXAMPLES = """\
examples:
  pendu-tui stability
  pendu-tui stability --theta 120deg --h 0.3
  pendu-tui stability --scene linear
  pendu-tui stability --method mine.py:my_step
  pendu-tui stability --map --workers 4
  pendu-tui stability --json | jq '.pendulum[] | select(.method == "velocity_verlet")'
  pendu-tui stability --z-values 0.005:3:600 --theta-values 1deg:179deg:300 --workers 8 -o map.npz
"""

LONGEST = 1_000_000  # values of an axis
MOST_ROWS = 10_000  # amplitudes of a table
LARGEST = 2_000_000  # swings of a map that is kept in memory


def add_options(parser: argparse.ArgumentParser) -> None:
    add_scene_options(parser)
    parser.add_argument(
        "--theta-values",
        metavar="LIST",
        type=values(angle),
        help="amplitudes in rad or deg: 0.5,1,2 or FIRST:LAST:HOW_MANY, for example 10deg:170deg:17"
        " (default: 0.1, 0.5, 1, 2, 3 and the scene's; with --map: 100)",
    )
    parser.add_argument(
        "--z-values",
        metavar="LIST",
        type=values(number),
        help="z = h·w0, for example 0.01:3:300 (default: one every 1 %% up to 3.2; with --map: 200 up to 3)",
    )
    parser.add_argument("--steps", metavar="N", type=count, default=10_000, help="steps of each swing (%(default)s)")
    parser.add_argument("--map", action="store_true", help="draw the map: z on x, amplitude on y")
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="one JSON object; with --map every swing of it")
    form.add_argument("--csv", action="store_true", help="a row for each amplitude; with --map for each swing")
    add_file(form, "-o", metavar="FILE.npz", dest="file", type=Path, help="write the map to a file (any size)")
    parser.add_argument("--force", action="store_true", help="overwrite FILE.npz")
    where = parser.add_mutually_exclusive_group()
    where.add_argument("--workers", metavar="N", type=count, default=1, help="processes on this machine (%(default)s)")
    where.add_argument("--dask", metavar="ADDRESS", help="a Dask scheduler, such as tcp://10.0.0.1:8786")


def values(element: Callable[[str], float]) -> Callable[[str], list[float]]:
    """A reader of values, `1,2,3` or FIRST:LAST:HOW_MANY, each read by `element`."""

    def read(text: str) -> list[float]:
        match text.split(":"):
            case [_]:
                return sorted({element(part) for part in text.split(",")})
            case [first, last, many] if 2 <= count(many) <= LONGEST and element(first) < element(last):
                low, high, gaps = element(first), element(last), count(many) - 1
                return [low + (high - low) * i / gaps for i in range(gaps)] + [high]
        raise argparse.ArgumentTypeError(
            f"{text!r} is not a list of values; use for example 0.5,1,2 or 0.1:3:30 (FIRST:LAST:HOW_MANY)"
        )

    return read


def run(options: argparse.Namespace) -> int:
    scene = general_scene_of(options)
    asked = {"--map": options.map, "--csv": options.csv, "-o": options.file}
    asked |= {"--theta-values": options.theta_values, "--z-values": options.z_values}
    if scene.model == "linear" and (given := [name for name, value in asked.items() if value]):
        raise UserError(
            f"{given[0]} is about a pendulum, and this scene is the linear oscillator, whose limit is the same at every"
            f" amplitude; leave out {given[0]}, or choose another --scene."
        )
    _check("amplitude", options.theta_values, 0, math.pi)
    if len(options.theta_values or ()) > MOST_ROWS and not options.file:
        raise UserError(
            f"{len(options.theta_values)} amplitudes are too many to show; use at most {MOST_ROWS}, or -o FILE.npz."
        )
    _check("z", options.z_values, *Z_LIMITS)
    _check("number of steps", [options.steps], 0, 2**31)
    from concurrent.futures import BrokenExecutor

    from engine.stability.study import StabilityStudy
    from tui.commands.studies.reports.stability import print_csv, print_json, print_text, write_file

    bar = partial(progress, "stability")
    with _workers(options) as executor:
        study = StabilityStudy(scene, options.theta_values, options.z_values, options.steps, executor, bar)
        if options.map and not options.file and (swings := math.prod(study.grid().shape)) > LARGEST:
            raise UserError(f"a map of {swings} swings is too large to show; write it with -o FILE.npz.")
        try:
            if options.file:
                return write_file(study, options.file, options.force)
            return (print_json if options.json else print_csv if options.csv else print_text)(study, options.map)
        except BrokenExecutor as error:
            raise UserError(f"a worker process died ({error}); use fewer --workers.", Exit.CHECK_FAILED) from None


def _check(what: str, given: list[float] | None, low: float, high: float) -> None:
    for value in given or ():
        if not low < value < high:  # also refuses nan
            raise UserError(f"{what} {value:g} is out of range; it must lie between {low:g} and {high:g}.")


@contextmanager
def _workers(options: argparse.Namespace) -> "Iterator[Executor | None]":
    """What computes the strips; None: this process.  Only this process sees Ctrl+C, the workers do not."""
    if options.dask:
        with _dask(options.dask) as client:
            yield client.get_executor()
    elif options.workers > 1:
        from concurrent.futures import ProcessPoolExecutor
        from multiprocessing import get_context

        os.environ["PYTHONSAFEPATH"] = "1"  # workers import no module from the current folder
        most = min(options.workers, os.cpu_count() or 1)
        ignore = (signal.SIGINT, signal.SIG_IGN)
        with ProcessPoolExecutor(most, get_context("spawn"), signal.signal, ignore) as executor:
            yield executor
    else:
        yield None


def _dask(address: str) -> Any:
    try:
        import distributed

        return distributed.Client(address, timeout="10s")
    except ImportError:
        raise UserError(f"--dask needs the package distributed: {install_advice('distributed', 'cluster')}.") from None
    except (OSError, ValueError) as error:
        raise UserError(f"no Dask scheduler answers at {address!r}: {type(error).__name__}; is it running?") from None
