"""What commands print: sentences and CSV on stdout; warnings and progress on stderr."""

import shutil
import sys
import textwrap
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import monotonic
from typing import TYPE_CHECKING, Any

from engine.models import DEFAULT_MODEL
from engine.scenes import LIMITS, Scene

if TYPE_CHECKING:
    from rich.console import Console, RenderableType


def warn(sentence: str) -> None:
    """Print a sentence besides the data, on stderr."""
    text = f"pendu-tui: {sentence}"
    print(_wrapped(text) if sys.stderr.isatty() else text, file=sys.stderr)


def _wrapped(text: str) -> str:
    """Return a text in lines that fit the terminal; no word or path is broken."""
    columns = shutil.get_terminal_size().columns
    return "\n".join(
        textwrap.fill(line, columns, break_long_words=False, break_on_hyphens=False)
        for line in text.split("\n")
    )


def fields_of(value: object, *names: str) -> dict[str, Any]:
    """Return some attributes by name, as in JSON."""
    return {name: getattr(value, name) for name in names}


def scene_line(scene: Scene, *more: str) -> str:
    """Return the scene's name and numbers, and `more` of its attributes."""
    numbers = fields_of(scene, *LIMITS, *more)
    model = "" if scene.model == DEFAULT_MODEL else f" ({scene.equations.equation})"
    listed = ", ".join(f"{name} {value:g}" for name, value in numbers.items())
    return f"{scene.name}{model}: {listed} (SI units)"


def print_lines(*lines: str) -> None:
    """Print sentences, wrapped between words where the terminal is narrower."""
    for line in lines:
        print(_wrapped(line) if sys.stdout.isatty() else line)


def console(piped_width: int | None = None) -> "Console":
    """Return where to draw: as wide as the terminal, or `piped_width` where there is none."""
    from rich.console import Console

    width = None if sys.stdout.isatty() else piped_width
    return Console(width=width, markup=False, emoji=False, highlight=False)


def draw(renderable: "RenderableType") -> None:
    """Print what Rich draws, in 240 columns where the output is no terminal."""
    on = console(240)
    with on.capture() as drawn:  # or Rich ends the process when the reader of a pipe is gone
        on.print(renderable, no_wrap=True, overflow="crop")
    print(drawn.get(), end="")


@contextmanager
def progress(what: str) -> Iterator[Callable[[float, float], None]]:
    """Yield a function to call with how much is done and how much there is in all.

    A terminal shows a bar and the time left once the work takes over a second.
    """
    began = monotonic()
    bar: Any = None

    def show(done: float, total: float) -> None:
        nonlocal bar
        is_long = monotonic() > began + 1 and 0 < done < total
        if bar is None and is_long and sys.stderr.isatty():
            from rich.console import Console
            from rich.progress import Progress

            columns = Progress.get_default_columns()
            bar = Progress(*columns, "left", console=Console(file=sys.stderr), transient=True)
            bar.add_task(what)
            bar.start()
        if bar is not None:
            bar.update(0, completed=done, total=total)

    try:
        yield show
    finally:
        if bar is not None:
            bar.stop()
