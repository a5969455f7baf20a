"""PenduApp: themes, signals, errors, and the screen of the lab."""

import asyncio
import os
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any, ClassVar

from rich.cells import cell_len
from textual.app import App, ScreenStackError
from textual.binding import Binding, BindingType
from textual.filter import LineFilter
from textual.screen import Screen
from textual.theme import BUILTIN_THEMES, Theme

from pendu_tui.recordings.files import printable
from pendu_tui.recordings.system import CAN_STOP, is_gone, stop, stop_as_usual
from pendu_tui.tui.cli.errors import Exit
from pendu_tui.tui.cli.watchdog import watchdog
from pendu_tui.tui.drawing.picture import PALETTES, Palette
from pendu_tui.tui.screens.lab import LabScreen
from pendu_tui.tui.terminal.driver import CharacterSetFilter, limit_pastes
from pendu_tui.tui.terminal.options import SMALLEST, USUAL, CharacterSet, TerminalOptions

WIDTHS = [(0, "-tiny"), (SMALLEST[0], "-narrow"), (120, "-wide")]
HEIGHTS = [(0, "-flat"), (SMALLEST[1], "-low"), (24, "-high")]
"""Classes for the style sheet, each from so many columns or rows on."""


class PenduApp(App[Exit | BaseException]):
    """Returns the exit code, the error that ended it, or None if the user quit."""

    HORIZONTAL_BREAKPOINTS = WIDTHS
    VERTICAL_BREAKPOINTS = HEIGHTS
    CSS_PATH = Path(__file__).with_name("app.tcss")  # subclasses use it, too
    TITLE = "pendu"
    ENABLE_COMMAND_PALETTE = False  # ctrl+p opens our own
    ALLOW_SELECT = False  # with selection, a click on a notice raises in Textual
    BINDINGS: ClassVar[list[BindingType]] = [
        # the terminal sends these keys as keys, not as signals
        Binding("ctrl+c", "interrupt", show=False, priority=True),
        Binding("ctrl+z", "suspend_process", show=False, priority=True),
    ]

    def __init__(self, screen: LabScreen, terminal: TerminalOptions = USUAL) -> None:
        if not os.environ.get("NO_COLOR", "?"):
            del os.environ["NO_COLOR"]  # no-color.org: empty means nothing
        # where there is no colour, Textual would use greys
        super().__init__(ansi_color="NO_COLOR" in os.environ or None)
        limit_pastes()
        for name, colours in PALETTES.items():
            self.register_theme(_theme(name, colours))
        self.theme = terminal.theme
        screen.fps = terminal.fps
        self.character_filter = CharacterSetFilter(terminal.character_set)
        self.lab = screen
        self._watchdog = watchdog()

    def export_screenshot(self, **options: Any) -> str:
        """Return the screen as an SVG picture for any viewer."""
        return portable(super().export_screenshot(**options))

    def get_default_screen(self) -> Screen[None]:
        return self.lab

    def on_mount(self) -> None:
        """Handle signals from now on, and repaint after Ctrl+Z.

        Textual's own handlers would run in the middle of whatever Python does.  If that is a write
        to the terminal, their own write would wait for it for ever.
        """
        self.app_resume_signal.subscribe(self, lambda _: self.refresh())
        if self.is_headless:
            return
        self._watchdog.guard(asyncio.get_running_loop(), self.action_interrupt, self.finish)
        stop_as_usual()

    def _handle_exception(self, error: Exception) -> None:
        """End with this error, in place of Textual's traceback; a test raises it."""
        if isinstance(error, ScreenStackError):
            return  # the screens are already gone
        if self.is_headless:
            super()._handle_exception(error)
        elif self.return_code is None:  # else it is ending already
            self.exit(error)

    def notify(self, message: str, **options: Any) -> None:
        """Show a notice in place of the last one, so that they cover no number.

        Notices have no markup, because units are in brackets, and name files as they are named.
        """
        self.call_later(self.clear_notifications)  # after the last one has come
        super().notify(printable(message, limit=1000), **{**options, "markup": False})

    def finish(self) -> None:
        for source in self.lab.sources:
            source.close()

    def action_interrupt(self) -> None:
        """Finish the recording and exit, even if the terminal is gone."""
        self.finish()
        if is_gone():
            os._exit(Exit.INTERRUPTED)
        self.exit(Exit.INTERRUPTED)

    def action_suspend_process(self) -> None:
        if CAN_STOP and not self.is_web:
            with self.suspend():
                stop()

    def action_use_theme(self, name: str) -> None:
        self.theme = name

    def action_use_pixels(self, name: CharacterSet) -> None:
        self.character_filter = CharacterSetFilter(name)
        self.refresh_css(animate=False)  # which redraws everything

    def refresh_css(self, animate: bool = True) -> None:
        """Apply the theme; before there is a screen, the sheet is read with it, and only once."""
        if self.screen_stack:
            super().refresh_css(animate=animate)
        else:
            self.stylesheet.set_variables(self.get_css_variables())

    def get_line_filters(self) -> Sequence[LineFilter]:
        filters = [*super().get_line_filters(), self.character_filter]
        return [each for each in filters if each.enabled]


def _theme(name: str, colours: Palette) -> Theme:
    def called(colour: str) -> str:
        if colour.startswith("#"):
            return colour
        return f"ansi_{colour}"  # as Textual calls the 16 colours

    background = called(colours.background)
    variables = {"frame": called(colours.frame)}
    if name == "ansi":
        variables |= BUILTIN_THEMES["ansi-dark"].variables  # for cursors and selections
    return Theme(
        name=name,
        dark=name != "light",
        ansi=name == "ansi",
        primary=called(colours.exact),
        foreground=called(colours.text),
        background=background,
        surface=background,
        panel=background,
        error=called(colours.warn),
        variables=variables,
    )


def normalised(svg: str) -> str:
    return re.sub(r"terminal-\d+-", "terminal-", svg)


def portable(svg: str) -> str:
    """Return the picture with a position for each word instead of a length for each text.

    Inkscape and librsvg ignore the length, and draw braille in fonts of other widths.
    """
    fonts = "font-family: Fira Code, DejaVu Sans Mono, monospace"
    text = r'(<text [^>]*)x="([\d.]+)" (y="[^>]*) textLength="([\d.]+)"([^>]*)>([^<]*)</text>'
    return re.sub(text, _placed, svg).replace("font-family: Fira Code, monospace", fonts)


def _placed(found: re.Match[str]) -> str:
    import html  # whose table of entities no lab needs

    opening, start, y, length, rest, escaped = found.groups()
    text = html.unescape(escaped)
    cell = float(length) / max(1, cell_len(text))
    parts = []
    for word in re.finditer(r"[!-~]+|[^\s]", text):
        x = float(start) + cell_len(text[: word.start()]) * cell
        width = cell_len(word[0]) * cell
        place = f'{opening}x="{x:.5g}" {y} textLength="{width:.5g}"{rest}'
        parts.append(f"{place}>{html.escape(word[0])}</text>")
    return "".join(parts)
