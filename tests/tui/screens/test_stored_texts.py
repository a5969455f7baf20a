"""What the lines, notices and dialogs of the lab say after each key."""

import re
import sys

import pytest

from tests.tui.drawn import screen
from tests.tui.harness import Theatre, lab

KEYS = (
    *("plus", "minus", "minus", "n", "n", "b", "b", "u", "space", "comma", "full_stop", "m", "m"),
    *("left_square_bracket", "right_square_bracket", "less_than_sign", "greater_than_sign"),
    *("left", "right", "home", "pagedown", "end", "pageup", "1", "5", "1", "e", "y", "y", "w", "z"),
    *("escape", "o", "r", "f3", "x", "escape", "f4", "v", "v", "p", "S", "T", "plus", "enter"),
    *("enter", "backspace", "1", "enter", "escape", "u", "i", "9", "escape", "M", "space", "down"),
    *("space", "escape", "question_mark", "question_mark", "d", "d", "E", "E", "d", "q"),
    *("d", "space", "d", "enter", "d", "escape", "ctrl+p"),
    *("escape", "P", "escape", "f", "r", "T", "space", "1", "2", "3", "space", "f3"),
    *("question_mark", "escape", "plus", "u", "enter", "enter", "enter", "enter", "backspace"),
    *("u", "u", "u", "3", "enter", "T", "z", "escape", "u", "r", "w"),
)


def words(theatre: Theatre) -> list[str]:
    """The lines, or the first rows of a dialog; a list of all methods or scenes may grow."""
    app = theatre.app
    lines = theatre.stage.query("StatusLine, SeekBar, LessonPanel, InsightLine, KeyLine")
    texts = [each.text for each in lines if each.is_on_screen]
    if box := next(iter(app.screen.query("#form, #cast, #finder, #text")), None):
        x, y, width, height = box.region
        rows = ["".join(cell for cell, _ in row[x : x + width]) for row in screen(app)]
        texts = [*rows[y : y + min(height - 1, 9)], rows[y + height - 1]]
    shown = theatre.stage.shown._asdict() | {"hidden": sorted(theatre.stage.shown.hidden)}
    texts.append(f"{theatre.stage.view}: {shown}")
    notices = app._notifications
    texts += [f"! {each.message} ({each.severity}, {each.timeout:g} s)" for each in notices]
    app.clear_notifications()
    return [re.sub(r" of \d+:", " of N:", line) for text in texts for line in text.splitlines()]


@pytest.mark.skipif(sys.platform == "win32", reason="it has ctrl+z in the help, and / in names")
@pytest.mark.usefixtures("uncomputed")
async def test_a_walk_over_the_keys(snapshot, here):
    """After each key the lines that it has changed."""
    texts: list[str] = []
    before: list[str] = []
    async with lab(size=(120, 40)) as theatre:
        await theatre.run(2)
        for key in KEYS:
            await theatre.press(key)
            await theatre.run(0.1)
            now = words(theatre)
            texts += ["", f"[{key}]", *(line for line in now if line not in before)]
            before = now
    snapshot("walk.txt", "\n".join(texts).replace(str(here), "FOLDER") + "\n")
