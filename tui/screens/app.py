"""The app: themes, signals, and the stages."""

import asyncio
import os
import signal
import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import ClassVar

from textual.app import App, SystemCommand
from textual.binding import Binding, BindingType
from textual.driver import Driver
from textual.filter import LineFilter
from textual.reactive import var
from textual.screen import Screen
from textual.theme import BUILTIN_THEMES, Theme

from tui.cli.errors import Exit
from tui.drawing.cells import PRESENT
from tui.drawing.palette import PALETTES, Palette
from tui.screens.base import SMALLEST, SourceScreen
from tui.screens.modal import Commands
from tui.terminal.character_sets import CharacterSetFilter
from tui.terminal.check import is_gone
from tui.terminal.options import CHARACTER_SETS, USUAL, CharacterSet, TerminalOptions
from tui.terminal.throughput import Throughput

WIDTHS = [(0, "-tiny"), (SMALLEST[0], "-narrow"), (80, "-normal"), (120, "-wide")]
HEIGHTS = [(0, "-flat"), (SMALLEST[1], "-low"), (24, "-middle"), (36, "-high")]
"""The classes that the sheet knows a terminal's size by, each from so many columns or rows on."""


class PenduApp(App[Exit | OSError]):
    """Shows a stage.  Returns how the program ends, or an error that made it end; None if the user left."""

    HORIZONTAL_BREAKPOINTS = WIDTHS
    VERTICAL_BREAKPOINTS = HEIGHTS
    CSS_PATH = "app.tcss"
    TITLE = "pendu"
    ALLOW_SELECT = False  # Textual stumbles over a click on a notice where text can be selected
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("ctrl+c", "interrupt", show=False, priority=True),
        Binding("ctrl+z", "suspend_process", show=False, priority=True),
    ]

    character_set: var[CharacterSet] = var("braille", init=False)

    def __init__(
        self,
        stage: SourceScreen,
        opened: Callable[[Path], SourceScreen] | None = None,
        display: TerminalOptions = USUAL,
    ) -> None:
        """`opened` makes the stage on which a recording is replayed; it may raise an exception with a sentence."""
        if not os.environ.get("NO_COLOR", "?"):
            del os.environ["NO_COLOR"]  # no-color.org: empty means nothing
        super().__init__(ansi_color=True if "NO_COLOR" in os.environ else None)  # else Textual would make greys of it
        self.opened = opened
        for name, colours in PALETTES.items():
            self.register_theme(_theme(name, colours))
        self.theme = display.theme
        self.fps = display.fps
        self.set_reactive(PenduApp.character_set, display.character_set)
        self.set_class(display.present, PRESENT)
        self.stages = [stage]
        self.throughput = Throughput()

    def get_driver_class(self) -> type[Driver]:
        """Our own for Linux and its kin, unless another was asked for."""
        usual = super().get_driver_class()
        if usual.__module__ != "textual.drivers.linux_driver":
            return usual
        from tui.terminal.driver import LabDriver

        return LabDriver

    def is_behind(self, urgent: bool = False) -> bool:
        """Whether frames are still on their way: on a slow line one more only adds to the delay.

        What is urgent need not wait for what the system has taken already.
        """
        self.throughput.tick(time.monotonic())
        return self.throughput.is_full if urgent else self.throughput.is_busy

    @property
    def stage(self) -> SourceScreen:
        """The stage that follows the clock."""
        return self.stages[-1]

    def get_default_screen(self) -> Screen[None]:
        """The stage."""
        return self.stage

    def on_source_screen_began(self, message: SourceScreen.Began) -> None:
        """Another stage has taken over."""
        if message.stage is not self.stage:
            self.stages.append(message.stage)

    def on_mount(self) -> None:
        """Leave in order when asked to by a signal, and paint everything anew after Ctrl+Z."""
        self.app_resume_signal.subscribe(self, lambda _: self.refresh())
        loop = asyncio.get_running_loop()
        for name in ("SIGINT", "SIGTERM", "SIGHUP"):
            if number := getattr(signal, name, None):
                try:
                    loop.add_signal_handler(number, self.interrupt)
                except (NotImplementedError, RuntimeError):  # Windows, or not in the main thread
                    return

    def action_interrupt(self) -> None:
        """Ctrl+C: the terminal sends it as a key."""
        self.interrupt()

    def interrupt(self) -> None:
        """Finish the recording and leave, even if there is no terminal any more to take leave of."""
        self.stage.source.close()
        if is_gone():
            os._exit(Exit.INTERRUPTED)
        self.exit(Exit.INTERRUPTED)

    def get_system_commands(self, screen: Screen[object]) -> Iterable[SystemCommand]:
        """What the palette offers."""
        from recordings.library import GOLDEN, listing
        from tui.screens.palette_entries import menu

        recordings = [item.path for item in (*listing(), *listing(GOLDEN))] if self.opened else []
        for entry in menu(self.stage.KEYS, self.stage.source.kind == "LIVE", recordings):
            yield SystemCommand(entry.title, entry.about, self._doing(entry.action))

    def _doing(self, action: str) -> Callable[[], None]:
        return lambda: self.stage.call_next(self.stage.run_action, action)

    def action_extra(self, name: str, *arguments: object) -> None:
        """Do what is seldom wanted, and imported only then."""
        from tui.screens.extras import EXTRAS

        EXTRAS[name](self, *arguments)

    def action_command_palette(self) -> None:
        """Open the palette."""
        if not isinstance(self.screen, Commands):
            self.push_screen(Commands())

    def action_use_theme(self, name: str) -> None:
        """Use another theme."""
        self.theme = name

    def action_present(self) -> None:
        """Use large numbers and thick lines, or the usual ones again."""
        self.toggle_class(PRESENT)
        self.stage.show_now()

    def action_next_character_set(self) -> None:
        """Draw with braille, half blocks, or ASCII."""
        self.character_set = CHARACTER_SETS[(CHARACTER_SETS.index(self.character_set) + 1) % len(CHARACTER_SETS)]

    def watch_character_set(self) -> None:
        """Draw everything anew: no widget knows that its characters have become others."""
        self.refresh_css(animate=False)
        for screen in self.screen_stack:
            for node in screen.walk_children(with_self=True):
                node.refresh()

    def get_line_filters(self) -> Sequence[LineFilter]:
        """What all lines pass through before they are shown."""
        return [*super().get_line_filters(), *(one for one in (_FILTERS[self.character_set],) if one.enabled)]


_FILTERS = {character_set: CharacterSetFilter(character_set) for character_set in CHARACTER_SETS}


_ANSI = BUILTIN_THEMES["ansi-dark"].variables  # of cursors and selections, in the terminal's own colours


def _theme(name: str, colours: Palette) -> Theme:
    def called(colour: str) -> str:
        return colour if colour.startswith("#") else f"ansi_{colour}"  # Textual's names of the 16

    background = called(colours.background)
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
        variables={**(_ANSI if name == "ansi" else {}), "frame": called(colours.frame)},
    )
