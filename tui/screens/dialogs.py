"""Dialogs: texts, forms, the finder, and the help, which is made from BINDINGS."""

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby, zip_longest
from typing import ClassVar, NamedTuple

from rich.table import Table
from rich.text import Text
from textual import events, on
from textual.app import ComposeResult
from textual.await_complete import AwaitComplete
from textual.binding import ActiveBinding, Binding, BindingType
from textual.containers import Container, Horizontal, VerticalScroll
from textual.dom import DOMNode
from textual.screen import ModalScreen, ScreenResultType
from textual.widgets import Input, Label, OptionList, Static

from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.methods import METHODS, Method
from pendu_tui.engine.models import NUMBERS
from pendu_tui.engine.scenes import MAX_METHODS, Scene
from pendu_tui.tui.drawing.picture import PALETTES
from pendu_tui.tui.screens.lines import SizedScreen, key_text
from pendu_tui.tui.terminal.options import CHARACTER_SETS
from pendu_tui.tui.words.cards import glossary, method_card, scene_card
from pendu_tui.tui.words.numbers import counted, z_text

KEY_WIDTH = 9  # characters
COLUMN_WIDTH = 36  # characters, a key and what it does


class Form(ModalScreen[ScreenResultType], SizedScreen[ScreenResultType]):
    """A screen over the lab that closes once, however fast clicks and keys come."""

    def on_click(self, event: events.Click) -> None:
        if event.widget is self:
            self.dismiss(None)

    def dismiss(self, result: ScreenResultType | None = None) -> AwaitComplete:
        """Close with a result, once; a second call would close the screen below."""
        if self.app.screen is not self:
            return AwaitComplete()
        return super().dismiss(result)


# Texts, and the help


class TextScreen(Form[None]):
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape,?,q,space,enter,d,E,shift+e", "dismiss(None)")
    ]

    def __init__(self, title: str, text: str) -> None:
        super().__init__()
        self.title = title
        self.text = text

    def compose(self) -> ComposeResult:
        with VerticalScroll(id="text") as scroll:
            scroll.border_title = self.title
            scroll.border_subtitle = "arrows scroll, Esc closes"
            yield Static(self.text, markup=False)


def bindings_of(owner: type[DOMNode]) -> list[Binding]:
    """Return the described bindings of a class, then of those of its bases that are ours."""
    classes = [each for each in owner.__mro__ if each.__module__.startswith("pendu_tui.tui.")]
    found = [binding for each in classes for binding in each.__dict__.get("BINDINGS", ())]
    return [each for each in found if isinstance(each, Binding) and each.description]


def purpose(binding: Binding) -> str:
    return binding.tooltip or binding.description


def key_lines(bindings: Iterable[Binding]) -> Iterator[str]:
    for group, members in groupby(bindings, key=lambda each: each.group or each):
        keys = [key_text(each) for each in members]
        if len(keys) > 3:
            keys = [keys[0], "…", keys[-1]]
        does = group.description if isinstance(group, Binding.Group) else purpose(group)
        yield f"{' '.join(keys):<{KEY_WIDTH - 1}} {does}"


def help_text(owners: Sequence[type[DOMNode]], scene: Scene, width: int) -> str:
    """Return the keys of these classes, the scene, the glossary, and the methods.

    `width`: columns of the screen; from 80 on keys stand in two columns.
    """
    parts = []
    for owner in owners:
        lines = list(key_lines(bindings_of(owner)))
        if width >= 80:
            half = (len(lines) + 1) // 2
            pairs = zip_longest(lines[:half], lines[half:], fillvalue="")
            lines = [f"{left:<{COLUMN_WIDTH}}{right}".rstrip() for left, right in pairs]
        parts.append("\n".join(filter(None, [owner.BINDING_GROUP_TITLE, *lines, owner.HELP])))
    return "\n\n".join([*parts, scene_card(scene), glossary(), *map(method_card, scene.cast)])


# Forms


class Choices(OptionList):
    """A list that bears keys and clicks which come faster than it is filled and drawn.

    Textual's raises: https://github.com/Textualize/textual/issues/3714
    """

    def on_click(self, event: events.Click) -> None:
        if event.style.meta.get("option", 0) >= self.option_count:
            event.prevent_default()

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool:
        """Do nothing before there is something to move in."""
        return self.virtual_size.height > 0


class Entry(NamedTuple):
    """Something that can be done, its key, and a sentence about it."""

    action: str
    text: str
    key: str = ""
    about: str = ""


def entries(scenes: Iterable[Scene], bindings: Iterable[ActiveBinding]) -> Iterator[Entry]:
    """Yield themes, pixels and scenes, then what keys do, each once."""
    for name in PALETTES:
        yield Entry(f"app.use_theme({name!r})", f"theme {name}")
    for name in CHARACTER_SETS:
        yield Entry(f"app.use_pixels({name!r})", f"pixels {name}")
    for scene in scenes:
        yield Entry(f"start_scene({scene.name!r})", f"scene {scene.name}", about=scene.watch)
    done = {"find"}
    for node, binding, *_ in bindings:
        ours = {each.action for each in bindings_of(type(node))}
        if binding.action in ours - done:
            done.add(binding.action)
            press = f"app.simulate_key({binding.key!r})"
            yield Entry(press, purpose(binding), key_text(binding))


MOVES = {
    "up": "cursor_up",
    "down": "cursor_down",
    "pageup": "page_up",
    "pagedown": "page_down",
}
"""Keys of the finder, and what its list does."""


class Finder(Form[str]):
    """Returns the action of an entry that has words beginning with each word typed."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape,ctrl+p", "dismiss(None)", priority=True),
        *(Binding(key, f"move('{name}')", priority=True) for key, name in MOVES.items()),
    ]

    def __init__(self, entries: Iterable[Entry], typed: str = "") -> None:
        super().__init__()
        self.entries = list(entries)
        self.found: list[Entry] = []
        self._typed = typed

    def compose(self) -> ComposeResult:
        with Container(id="finder") as form:
            form.border_title = "Find a scene, a theme, a key …"
            form.border_subtitle = "Enter chooses, Esc cancels"
            yield Input(self._typed, select_on_focus=False)
            yield Choices()

    @on(events.Mount)
    @on(Input.Changed)
    def fill(self) -> None:
        typed = self.query_one(Input).value
        patterns = [rf"(?i)(?<!\w){re.escape(word)}" for word in typed.split()]

        def places(entry: Entry) -> list[int]:
            text = f"{entry.text} {entry.about}"
            return [found.start() for each in patterns if (found := re.search(each, text))]

        found = [each for each in self.entries if len(places(each)) == len(patterns)]
        self.found = sorted(found, key=lambda each: sum(places(each)))
        listed = self.query_one(Choices)
        listed.clear_options()
        listed.add_options(map(self._line, self.found))
        listed.highlighted = 0

    def _line(self, entry: Entry) -> Table:
        line = Table.grid("text", "about", "key", expand=True, padding=(0, 1))
        line.columns[0].width = max(len(each.text) for each in self.found)
        line.columns[1].ratio = 1
        line.add_row(*map(Text, (entry.text, entry.about, entry.key)))
        return line

    async def action_move(self, name: str) -> None:
        await self.query_one(Choices).run_action(name)

    async def on_input_submitted(self) -> None:
        await self.action_move("select")

    def on_option_list_option_selected(self, event: OptionList.OptionSelected) -> None:
        self.dismiss(self.found[event.option_index].action)


class CastForm(Form[Scene]):
    """Returns the scene with the chosen methods, in the order of choosing."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape,M,shift+m,q", "dismiss(None)"),
        Binding("space", "take"),
        Binding("enter", "start", priority=True),
    ]

    def __init__(self, scene: Scene) -> None:
        super().__init__()
        self._scene = scene
        known = dict.fromkeys((*METHODS, *scene.cast))
        self._methods = [each for each in known if scene.model in each.models]
        self.cast = scene.cast

    def compose(self) -> ComposeResult:
        listed = Choices(*map(self._line, self._methods), id="cast")
        listed.border_title = f"Methods for the model {self._scene.model}, 1 to {MAX_METHODS}"
        listed.border_subtitle = "Space adds or removes one, Enter starts, Esc cancels"
        yield listed

    def _line(self, method: Method) -> Text:
        """Return "2 v Velocity Verlet  order 2  1 eval a step"; the digit only if chosen."""
        digits = {each: at for at, each in enumerate(self.cast, 1)}
        name = f"{digits.get(method, ' ')} {method.letter} {method.label:<22}"
        evals = f"{counted(method.force_evaluations, 'eval')} a step"
        kind = "symplectic"
        if not method.symplectic:
            kind = "not symplectic"
        return Text(f"{name} order {method.order:<2} {evals:<16} {kind}")

    async def action_take(self) -> None:
        await self.query_one(Choices).run_action("select")

    def on_option_list_option_selected(self, event: OptionList.OptionSelected) -> None:
        method = self._methods[event.option_index]
        if method in self.cast:
            self.cast = tuple(each for each in self.cast if each is not method)
        elif len(self.cast) < MAX_METHODS:
            self.cast = (*self.cast, method)
        else:
            self.notify(f"No more than {MAX_METHODS} methods fit: remove one first.")
        for at, each in enumerate(self._methods):
            event.option_list.replace_option_prompt_at_index(at, self._line(each))

    def action_start(self) -> None:
        if self.cast:
            self.dismiss(self._scene.with_cast(self.cast))
        else:
            self.notify("Choose at least one method.")


class StartForm(Form[Scene]):
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "dismiss(None)"),
        Binding("down", "app.focus_next"),
        Binding("up", "app.focus_previous"),
    ]

    def __init__(self, scene: Scene) -> None:
        super().__init__()
        self._before = scene
        self._scene: Scene | None = scene

    def compose(self) -> ComposeResult:
        with Container(id="form") as form:
            form.border_title = "Initial values"
            form.border_subtitle = "Enter starts, Esc cancels"
            numbers = self._before.numbers
            for name, value in numbers.items():
                row = NUMBERS[name]
                with Horizontal():
                    yield Label(name)
                    yield Input(f"{value!r}", id=name, compact=True)
                    hint = row.hint or f", {row.min:g} to {row.max:g}"
                    yield Label(row.unit + hint, classes="unit")
            yield Label(id="verdict", markup=False)

    @on(Input.Changed)
    def check(self) -> None:
        values = {}
        verdict = self.query_one("#verdict", Label)
        self._scene = None
        try:
            for field in self.query(Input):
                name = str(field.id)
                values[name] = NUMBERS[name].read(field.value.strip())
            self._scene = scene = self._before.altered(**values)
        except InputError as error:
            verdict.update(str(error))
        except ValueError as error:
            verdict.update(f"{name}: {error}.")
        else:
            verdict.update(f"w0 = {scene.w0:.4g} 1/s, {z_text(scene, 3)}")
        verdict.set_class(self._scene is None, "-wrong")

    @on(Input.Submitted)
    def submit(self) -> None:
        if self._scene is not None:
            self.dismiss(self._scene)
