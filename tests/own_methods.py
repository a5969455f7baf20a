from pendu_tui.engine.methods.measure import examined
from pendu_tui.engine.methods.own import OwnMethod, own_function, own_method

VERLET = '''
def mine(force, phase, h):
    """Half a kick, a drift, half a kick."""
    theta, omega = phase
    a = force(theta)
    while True:
        omega_half = omega + h / 2 * a
        theta = theta + h * omega_half
        a = force(theta)
        omega = omega_half + h / 2 * a
        yield theta, omega
'''


def load(source: str, key: str = "mine") -> OwnMethod:
    """Return a user's method from the text of a file `mine.py`."""
    measured = examined(own_function(source, key, "mine.py"), f"mine.py: {key}")
    return own_method(source, key, "m", "mine.py", measured)
