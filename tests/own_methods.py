from pendu_tui.engine.methods.measure import measured_text
from pendu_tui.engine.methods.own import OwnMethod, own_method


def load(source: str, key: str = "mine") -> OwnMethod:
    """Return a user's method from the text of a file `mine.py`."""
    return own_method(source, key, "m", "mine.py", measured_text(source, key, "mine.py"))
