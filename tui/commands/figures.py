"""Figures by Matplotlib, one column wide; the same input gives the same bytes."""

import math
from argparse import Namespace
from collections.abc import Sequence
from itertools import cycle

import numpy as np
from matplotlib import style
from matplotlib.figure import Figure

from pendu_tui.engine.methods import Cast
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.scenes import Scene
from pendu_tui.tui.cli.files import whole_file
from pendu_tui.tui.drawing.loglog import Series as Series
from pendu_tui.tui.drawing.picture import PALETTES, inks

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


def draw(
    options: Namespace, cast: Cast, series: Sequence[Series], labels: tuple[str, str], log: str
) -> None:
    """Draw the series of a chart and write the -o file.

    `labels` are those of x and y, `log` names the logarithmic axes: "xy", "y" or "".  Methods
    differ in colour and in line style; references are dotted.
    """
    colours = map(PALETTES["light"].colour, inks(cast))
    looks = {
        method.letter: {"color": colour, "linestyle": line, "label": method.label, "marker": "."}
        for method, colour, line in zip(cast, colours, cycle(LINES))
    }
    suffix = options.output.suffix.lower()
    with (
        style.context(STYLE, after_reset=True),
        whole_file(options.output, options.force) as part,
    ):
        figure = Figure((8.5 * CM, 6 * CM))  # a column of a journal
        axes = figure.add_subplot(xlabel=labels[0], ylabel=labels[1])
        axes.set(**{f"{axis}scale": "log" for axis in log})
        for each in series:
            reference = {"color": "grey", "linestyle": ":", "linewidth": 0.5}
            axes.plot(each.x, each.y, **looks.get(each.mark, reference))
        figure.legend(loc="outside upper center", ncols=2)
        figure.savefig(part, format=suffix[1:], metadata=NO_DATE[suffix])


def draw_run(options: Namespace, scene: Scene, samples: Sequence[Sample]) -> None:
    """Draw the largest energy error of each half swing, or of longer parts of a long run."""
    t = np.array([sample.t for sample in samples])
    error = scene.equations.error.name
    errors = np.array([[getattr(each, error) for each in sample.readings] for sample in samples]).T
    swing = scene.exact().period or math.tau / scene.w0
    parts = max(1, min(MAX_PARTS, len(t), round(2 * t[-1] / swing)))
    first = np.linspace(0, len(t), parts + 1).astype(int)[:-1]
    series = [
        Series(0, method.letter, t[first], np.fmax.reduceat(np.abs(row), first))
        for method, row in zip(scene.cast, errors, strict=True)
    ]
    draw(options, scene.cast, series, ("time / s", "largest |ΔE / E₀| of a half swing"), log="y")
