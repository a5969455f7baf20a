"""What an undo took back, in a sentence."""

from tui.playback.state import State
from tui.words.numbers import factor, seconds


def undone(before: State, after: State) -> str:
    """Return what an undo has changed."""
    same_run = after.number == before.number
    if after.stepping != before.stepping:
        what = f"h {after.stepping.h:.4g} s"
        if after.stepping.equal_cost != before.stepping.equal_cost:
            what = "equal cost" if after.stepping.equal_cost else "equal steps"
        return f"Undone: {what} again" if same_run else f"Undone: {after.scene.name}, {what}"
    if not same_run:
        return f"Undone: back to {after.scene.name} at {seconds(after.t)}"
    if after.speed != before.speed:
        return f"Undone: {factor(after.speed)}× again"
    is_hidden = before.shown.hidden != after.shown.hidden
    return f"Undone: {'the methods shown' if is_hidden else 'what the screen shows'}"
