"""Matplotlib figures, one column wide; the same input gives the same bytes."""

import math
from argparse import Namespace
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.util import find_spec
from itertools import cycle
from typing import TYPE_CHECKING, Any

from pendu_tui.engine.methods import Cast
from pendu_tui.engine.scenes import Scene
from pendu_tui.tui.cli.errors import UserError
from pendu_tui.tui.cli.files import check_free, whole_file
from pendu_tui.tui.drawing.palette import PALETTES, Palette, inks

if TYPE_CHECKING:
    from rich.text import Text

    from pendu_tui.engine.accuracy.study import Point
    from pendu_tui.engine.run.lockstep import Sample
    from pendu_tui.engine.stability.grid import Grid
    from pendu_tui.engine.stability.outcomes import Cells
    from pendu_tui.tui.drawing.picture import Picture

SUFFIXES = (".svg", ".pdf", ".png")
CM = 1 / 2.54  # inches
MAX_PARTS = 400  # of a run, each drawn as its largest error
LINES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 2)))
STYLE = {
    "font.size": 7,
    "axes.titlesize": 7,
    "figure.labelsize": 7,
    "axes.linewidth": 0.5,
    "lines.linewidth": 0.9,
    "lines.markersize": 2.5,
    "legend.frameon": False,
    "legend.handlelength": 2.4,
    "figure.constrained_layout.use": True,
    "savefig.dpi": 600,
    "svg.fonttype": "path",  # outlines, which need no font
    "svg.hashsalt": "pendu-tui",
    "pdf.fonttype": 42,  # TrueType, which journals ask for
}
NO_DATE = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}, ".png": {"Software": None}}


def lines_of(picture: "Picture", palette: Palette | None) -> "list[Text]":
    """Return a picture's lines for the terminal; without a palette, inks have no colour."""
    from rich.text import Text

    lines = []
    for row in picture.rows:
        line = Text()
        for text, ink in row:
            if isinstance(ink, int):
                line.append(text, palette and palette.colour(ink))
            else:
                line.append(text, ink)
        line.rstrip()
        lines.append(line)
    return lines


def check_output(options: Namespace) -> bool:
    """Return whether the output is a figure.

    Raises DiskError if the name is taken, UserError without Matplotlib.
    """
    path = options.output
    if path is None:
        return False
    check_free(path, options.force)
    is_figure = path.suffix.lower() in SUFFIXES
    if is_figure and find_spec("matplotlib") is None:
        raise UserError(f"{path.suffix} files need an extra: pip install 'pendu-tui[plot]'.")
    return is_figure


@contextmanager
def _figure(options: Namespace, height: float = 6.0) -> Iterator[Any]:
    """Yield a Matplotlib figure of this height [cm], and write it to the output afterwards."""
    from matplotlib import style
    from matplotlib.figure import Figure

    suffix = options.output.suffix.lower()
    with (
        style.context(STYLE, after_reset=True),
        whole_file(options.output, options.force) as part,
    ):
        figure = Figure((8.5 * CM, height * CM))  # a column of a journal
        yield figure
        figure.savefig(part, format=suffix[1:], metadata=NO_DATE[suffix])


def _styles(cast: Cast) -> list[dict[str, Any]]:
    """Return colour, label and line style of each method, which differ without colour, too."""
    colours = map(PALETTES["light"].colour, inks(cast))
    return [
        {"color": colour, "linestyle": line, "label": method.label}
        for method, colour, line in zip(cast, colours, cycle(LINES))
    ]


def draw_run(options: Namespace, scene: Scene, samples: Sequence["Sample"]) -> None:
    """Draw the largest energy error of each half swing, or of longer parts of a long run."""
    import numpy as np

    t = np.array([sample.t for sample in samples])
    error = scene.equations.error.name
    errors = np.array([[getattr(each, error) for each in sample.readings] for sample in samples]).T
    swing = scene.exact().period or math.tau / scene.w0
    parts = max(1, min(MAX_PARTS, len(t), round(2 * t[-1] / swing)))
    first = np.linspace(0, len(t), parts + 1).astype(int)[:-1]
    with _figure(options) as figure:
        label = "largest |ΔE / E₀| of a half swing"
        axes = figure.add_subplot(xlabel="time / s", ylabel=label, yscale="log")
        for row, style in zip(errors, _styles(scene.cast), strict=True):
            axes.plot(t[first], np.fmax.reduceat(np.abs(row), first), **style)
        axes.set_xlim(0, t[-1])
        figure.legend(loc="outside upper center", ncols=2)


def draw_accuracy(options: Namespace, cast: Cast, points: Sequence["Point"]) -> None:
    from pendu_tui.engine.accuracy.front import cost_of

    errors = {
        "theta": "largest error of θ / rad",
        "energy": "largest |ΔE / E₀|",
        "final": "error of θ at the end / rad",
    }
    costs = {"evaluations": "force evaluations", "seconds": "time of computation / s"}
    with _figure(options) as figure:
        axes = figure.add_subplot(xlabel=costs[options.cost], ylabel=errors[options.error])
        axes.set(xscale="log", yscale="log")
        for method, style in zip(cast, _styles(cast), strict=True):
            line = sorted(
                (cost_of(point, options.cost), point.error(options.error))
                for point in points
                if point.method == method and point.flaw(options.error) is None
            )
            if line:
                axes.plot(*zip(*line, strict=True), marker="o", **style)
        figure.legend(loc="outside upper center", ncols=2)


def draw_map(options: Namespace, grid: "Grid", cells: "Cells") -> None:
    """Draw where each method holds a swing, by z and amplitude, with its largest energy error."""
    import numpy as np

    from pendu_tui.engine.stability.outcomes import is_lost

    rows = math.ceil(len(grid.methods) / 2)
    extent = (0, grid.z[-1] + grid.z[0], 0, np.degrees(grid.theta[-1] + grid.theta[0]))
    look = {"origin": "lower", "aspect": "auto", "cmap": "viridis_r", "interpolation": "none"}
    with _figure(options, height=1 + 3.6 * rows) as figure:
        panels = figure.subplots(rows, 2, sharex=True, sharey=True, squeeze=False).ravel()
        for panel in panels[len(grid.methods) :]:
            panel.set_axis_off()
        for index, method in enumerate(grid.methods):
            panel = panels[index]
            errors = np.where(is_lost(cells[:, index]), np.nan, cells["error"][:, index])
            with np.errstate(all="ignore"):
                digits = np.log10(errors).T
            image = panel.imshow(digits, extent=extent, vmin=-6, vmax=0, **look)
            panel.set(facecolor="#C8C8C8", title=method.label)
            if method.linear_limit and method.linear_limit < extent[1]:
                panel.axvline(method.linear_limit, color="black", linestyle="--", linewidth=0.5)
        figure.supxlabel("z = h ω₀   (grey: the swing is lost; dashed: linear limit)")
        figure.supylabel("amplitude / °")
        figure.colorbar(image, ax=list(panels), label="log₁₀ of the largest |ΔE / E₀|")
