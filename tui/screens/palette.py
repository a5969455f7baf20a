"""The command palette: themes and scenes first, then what the keys do, and what has no key."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import NamedTuple, cast

from rich.cells import cell_len
from rich.markup import escape
from textual.command import DiscoveryHit, Hit, Hits, Provider

from engine.scenes import SCENES
from tui.drawing.palette import PALETTES
from tui.screens.base import SourceScreen
from tui.screens.help import bindings_of, key_text, purpose
from tui.screens.live import LiveScreen

MAX_WIDTH = 100  # columns of an entry
EDGE = 8  # columns around it
KEY_WIDTH = 7


class Entry(NamedTuple):
    """A line of the palette."""

    text: str
    action: str | Callable[[], object]
    key: str = ""


def entries(screen: SourceScreen) -> Iterator[Entry]:
    """Yield what can be done on this screen."""
    for name in PALETTES:
        yield Entry(f"theme {name}", f"app.use_theme({name!r})")
    if isinstance(screen, LiveScreen):
        for scene in {**SCENES, **screen.lecture}.values():
            yield Entry(f"scene {scene.name}: {scene.watch}", f"start_scene({scene.name!r})")
    yield from key_entries(screen)
    for command in screen.commands():
        yield Entry(command.title, command.callback)


def key_entries(screen: SourceScreen) -> Iterator[Entry]:
    """Yield what the keys do, each action once."""
    done: set[str] = set()
    for node, binding, enabled, _ in screen.active_bindings.values():
        ours = {each.action for each in bindings_of(type(node))}
        if enabled and binding.action in ours - done:
            done.add(binding.action)
            press = partial(screen.app.simulate_key, binding.key)
            yield Entry(purpose(binding), press, key_text(binding))


def line(entry: Entry, width: int) -> str:
    """Return the text of an entry with its key in the last column."""
    room = width - KEY_WIDTH
    text = entry.text
    if cell_len(text) > room:
        text = text[: room - 1] + "…"
    return f"{text:<{room}}{entry.key:>{KEY_WIDTH}}"


class LabCommands(Provider):
    """Finds entries by what is typed."""

    def _lines(self) -> Iterator[tuple[str, Callable[[], object]]]:
        screen = cast(SourceScreen, self.screen)
        width = min(screen.size.width - EDGE, MAX_WIDTH)
        for entry in entries(screen):
            run = entry.action
            if isinstance(run, str):
                run = partial(screen.run_action, run)
            # once the screen is in front again
            yield (line(entry, width), partial(screen.call_later, run))

    async def discover(self) -> Hits:
        for text, run in self._lines():
            yield DiscoveryHit(escape(text), run, text=text)

    async def search(self, query: str) -> Hits:
        matcher = self.matcher(query)
        for text, run in self._lines():
            if (score := matcher.match(text)) > 0:
                yield Hit(score, matcher.highlight(text), run, text=text)
