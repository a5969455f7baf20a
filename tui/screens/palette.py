"""The command palette: themes and scenes first, then all actions."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import NamedTuple, cast

from rich.markup import escape
from textual.command import CommandPalette, DiscoveryHit, Hit, Hits, Provider

from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.drawing.palette import PALETTES
from pendu_tui.tui.screens.dialogs import KEY_WIDTH, Once, bindings_of, purpose
from pendu_tui.tui.screens.lab import LabScreen
from pendu_tui.tui.screens.lines import key_text


class Entry(NamedTuple):
    text: str
    action: str
    key: str = ""


def entries(screen: LabScreen) -> Iterator[Entry]:
    """Yield all that can be done on this screen, each action once."""
    for name in PALETTES:
        yield Entry(f"theme {name}", f"app.use_theme({name!r})")
    pages = {page.name: page for page in screen.lesson.pages}
    for scene in {**SCENES, **pages}.values():
        yield Entry(f"scene {scene.name}: {scene.watch}", f"start_scene({scene.name!r})")
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
    def _lines(self) -> Iterator[tuple[str, Callable[[], object]]]:
        screen = cast(LabScreen, self.screen)
        room = min(screen.size.width - 8, 100) - KEY_WIDTH
        for text, action, key in entries(screen):
            if len(text) > room:
                text = f"{text[: room - 1]}…"
            # when the screen is in front again
            run = partial(screen.call_later, screen.run_action, action)
            yield f"{text:<{room}}{key:>{KEY_WIDTH}}", run

    async def discover(self) -> Hits:
        for text, run in self._lines():
            yield DiscoveryHit(escape(text), run, text=text)

    async def search(self, query: str) -> Hits:
        matcher = self.matcher(query)
        for text, run in self._lines():
            if (score := matcher.match(text)) > 0:
                yield Hit(score, matcher.highlight(text), run, text=text)
