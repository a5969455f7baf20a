from pendu_tui.engine.methods.measure import examined
from pendu_tui.engine.methods.own import OwnMethod, own_function, own_method


def load(source: str, key: str = "mine") -> OwnMethod:
    """Return a user's method from the text of a file `mine.py`."""
    measured = examined(own_function(source, key, "mine.py"), f"mine.py: {key}")
    return own_method(source, key, "m", "mine.py", measured)
