"""Figures by Matplotlib, one column wide; the same input gives the same bytes."""

from argparse import Namespace
from collections.abc import Sequence
from importlib.util import find_spec
from itertools import cycle

from rich.text import Text

from pendu_tui.engine.methods import Cast
from pendu_tui.tui.cli.errors import UserError
from pendu_tui.tui.cli.files import check_free, whole_file
from pendu_tui.tui.cli.report import FIGURES
from pendu_tui.tui.drawing.loglog import Series
from pendu_tui.tui.drawing.palette import PALETTES, Palette, inks
from pendu_tui.tui.drawing.picture import Picture

CM = 1 / 2.54  # inches
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


def lines_of(picture: Picture, palette: Palette | None) -> list[Text]:
    """Return a picture's lines for the terminal; without a palette, inks have no colour."""
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
    is_figure = path.suffix.lower() in FIGURES
    if is_figure and find_spec("matplotlib") is None:
        raise UserError(f"{path.suffix} files need an extra: pip install 'pendu-tui[plot]'.")
    return is_figure


def draw(
    options: Namespace, cast: Cast, series: Sequence[Series], labels: tuple[str, str], log: str
) -> None:
    """Draw the series of a chart and write the -o file.

    `labels` are those of x and y, `log` names the logarithmic axes: "xy", "y" or "".  Methods
    differ in colour and in line style; references are dotted.
    """
    from matplotlib import style
    from matplotlib.figure import Figure

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
