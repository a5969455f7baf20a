"""The exact motion in words: regime, energy and period."""

from engine.models.model import ExactMotion, Model
from engine.scenes import Scene


def regime(model: Model, theta: float, omega: float) -> str:
    """Return the kind of exact motion through a state: "libration", "rotation" or "separatrix"."""
    level = model.level(theta, omega)
    if level == 0:
        return "separatrix"
    return "libration" if level > 0 else "rotation"


def energy_share(model: Model, theta: float, omega: float) -> str:
    """Return energy over that of the separatrix; near 1, as the difference: "1 - 2.5e-13"."""
    level = model.level(theta, omega)
    if level != 0 and abs(level) < 1e-3:
        return f"1 {'-' if level > 0 else '+'} {abs(level):.1e}"
    return f"{1 - level:.4g}"


def motion_text(scene: Scene, exact: ExactMotion) -> str:
    """Return the motion from a scene's start: "exact period 2.139 s  E/Es 0.2298  libration"."""
    parts = []
    if exact.period is not None:
        parts.append(f"exact period {exact.period:.6g} s")
    if scene.equations.has_separatrix:
        parts.append(f"E/Es {energy_share(scene.equations, scene.theta, scene.omega)}")
    return "  ".join([*parts, exact.regime])
