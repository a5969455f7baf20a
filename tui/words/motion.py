"""The exact motion in words: regime, energy and period."""

from engine.models.model import ExactMotion
from engine.models.pendulum import separatrix_margin
from engine.scenes import Scene


def regime(w0: float, theta: float, omega: float) -> str:
    """The kind of exact motion through a state: "libration", "rotation" or "separatrix"."""
    value = separatrix_margin(w0, theta, omega)
    return "separatrix" if value == 0 else "libration" if value > 0 else "rotation"


def energy_share(w0: float, theta: float, omega: float) -> str:
    """Energy over the energy of the separatrix; near 1, as the difference from 1: "1 - 2.5e-13"."""
    value = separatrix_margin(w0, theta, omega)
    if value != 0 and abs(value) < 1e-3:
        return f"1 {'-' if value > 0 else '+'} {abs(value):.1e}"
    return f"{1 - value:.4g}"


def motion_text(scene: Scene, exact: ExactMotion) -> str:
    """As "exact period 2.139 s  E/Es 0.2298  libration"."""
    share = (
        f"E/Es {energy_share(scene.w0, scene.theta, scene.omega)}" if scene.equations.turns else ""
    )
    period = "" if exact.period is None else f"exact period {exact.period:.6g} s"
    return "  ".join(filter(None, [period, share, exact.regime]))
