"""What an undo took back, in a sentence."""

from tui.playback.state import State
from tui.words.numbers import factor, seconds

_NAMES = {
    "hidden": "the methods shown",
    "exact": "the exact motion",
    "overlay": "one pivot or one pane each",
    "trails": "trails",
    "quantity": "the quantity of the chart",
    "log": "log or linear",
    "seconds": "the window of the chart",
    "stretch": "the zoom of the chart",
}


def undone(before: State, after: State) -> str:
    """Return what an undo has changed."""
    same_run = after.number == before.number
    if after.stepping != before.stepping:
        what = f"h {after.stepping.h:.4g} s"
        if after.stepping.equal_cost != before.stepping.equal_cost:
            what = "equal cost" if after.stepping.equal_cost else "equal steps"
        return (
            f"Undone: {what} again" if same_run else f"Undone: back to {after.scene.name}, {what}"
        )
    if not same_run:
        return f"Undone: back to {after.scene.name} at {seconds(after.t)}"
    if after.speed != before.speed:
        return f"Undone: {factor(after.speed)}× again"
    changed = [
        text
        for name, text in _NAMES.items()
        if getattr(before.shown, name) != getattr(after.shown, name)
    ]
    return f"Undone: {', '.join(changed) or 'nothing has changed'}"
