"""The command palette: themes, pixels and scenes first, then all actions."""

import re
from collections.abc import Callable, Iterator
from functools import partial
from typing import NamedTuple, cast

from rich.markup import escape
from textual.command import CommandPalette, DiscoveryHit, Hit, Hits, Provider
from textual.content import Content

from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.drawing.picture import PALETTES
from pendu_tui.tui.screens.dialogs import KEY_WIDTH, Once, bindings_of, purpose
from pendu_tui.tui.screens.lab import LabScreen
from pendu_tui.tui.screens.lines import key_text
from pendu_tui.tui.terminal.options import CHARACTER_SETS


class Entry(NamedTuple):
    text: str
    action: str
    key: str = ""
    about: str = ""  # on lines below


def entries(screen: LabScreen) -> Iterator[Entry]:
    """Yield all that can be done on this screen, each action once."""
    for name in PALETTES:
        yield Entry(f"theme {name}", f"app.use_theme({name!r})")
    for name in CHARACTER_SETS:
        yield Entry(f"pixels {name}", f"app.use_pixels({name!r})")
    pages = {page.name: page for page in screen.lesson.pages}
    for scene in {**SCENES, **pages}.values():
        action = f"start_scene({scene.name!r})"
        yield Entry(f"scene {scene.name}", action, about=scene.watch)
    done: set[str] = set()
    for node, binding, enabled, _ in screen.active_bindings.values():
        ours = {each.action for each in bindings_of(type(node))}
        if enabled and binding.action in ours - done:
            done.add(binding.action)
            press = f"app.simulate_key({binding.key!r})"
            yield Entry(purpose(binding), press, key_text(binding))
    if not screen.app.is_web:  # visitors write no files
        yield Entry("save what I see as a scene file", "save_scene")


class Commands(CommandPalette, Once[None]):
    """The command palette; the app ignores its errors, which fast keys cause."""


class LabCommands(Provider):
    def _lines(self) -> Iterator[tuple[Entry, str, Callable[[], object]]]:
        """Yield each entry with its line, whose key is in the last column, and what it does."""
        screen = cast(LabScreen, self.screen)
        room = min(screen.size.width - 8, 100) - KEY_WIDTH
        for entry in entries(screen):
            # when the screen is in front again
            run = partial(screen.call_later, screen.run_action, entry.action)
            yield entry, f"{entry.text:<{room}}{entry.key:>{KEY_WIDTH}}", run

    async def discover(self) -> Hits:
        for entry, line, run in self._lines():
            yield DiscoveryHit(escape(line), run, text=line, help=entry.about or None)

    async def search(self, query: str) -> Hits:
        """Find entries that have words beginning with each word of the query."""
        for entry, line, run in self._lines():
            found = [at for word in query.split() if (at := _begins(f"{line} {entry.about}", word))]
            if len(found) == len(query.split()):
                shown = Content(line)
                for start, end in found:
                    shown = shown.stylize("bold underline", start, end)
                score = 1.0 / (1 + sum(start for start, _ in found))
                yield Hit(score, shown, run, text=line, help=entry.about or None)


def _begins(text: str, word: str) -> tuple[int, int] | None:
    """Return where a word of the text begins like this one, if any does."""
    found = re.search(rf"(?<!\w){re.escape(word)}", text, re.IGNORECASE)
    return found and found.span()
