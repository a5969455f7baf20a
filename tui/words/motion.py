"""What the phase portrait says in words and numbers."""

import math

from engine.models.exact_pendulum import ExactMotion
from tui.drawing.axes import in_pi
from tui.views.phase.portrait import margin
from tui.words.numbers import scientific


def regime(w0: float, theta: float, omega: float) -> str:
    """Which motion goes through a state."""
    value = float(margin(w0, theta, omega))
    if value == 0:
        return "separatrix"
    return "libration" if value > 0 else "rotation"


def energy_share(w0: float, theta: float, omega: float) -> str:
    """The energy in units of the separatrix'; near 1 as its distance from there, which is what then matters."""
    value = float(margin(w0, theta, omega))
    if value != 0 and abs(value) < 1e-3:
        return f"1 {'-' if value > 0 else '+'} {abs(value):.1e}"
    return f"{1 - value:.4g}"


def place_text(w0: float, theta: float, omega: float, width: int) -> str:
    """A state, its energy in units of the separatrix' and its regime, as wordy as fits."""
    energy, motion = energy_share(w0, theta, omega), regime(w0, theta, omega)
    half_turns = round(theta / math.pi)
    angle = in_pi(half_turns) if theta == half_turns * math.pi else f"{theta:.15g}"
    for text in (
        f"theta {angle} rad ({math.degrees(theta):.5g}°)  omega {omega:.15g} rad/s  E/Es {energy}  {motion}",
        f"theta {angle} rad  omega {omega:.15g} rad/s  E/Es {energy}  {motion}",
        f"theta {angle}  omega {omega:.15g}  E/Es {energy}  {motion}",
        f"{angle}, {omega:.15g}  E/Es {energy}  {motion}",
    ):
        if len(text) <= width:
            return text
    return text[:width]


def motion_text(exact: ExactMotion) -> str:
    """The exact motion: its period, energy and regime."""
    scene = exact.scene
    energy = f"E/Es {energy_share(scene.w0, scene.theta, scene.omega)}  {exact.regime}"
    return energy if exact.period is None else f"exact period {exact.period:.6g} s  {energy}"


def area_text(ratio: float) -> tuple[str, str]:
    """The sum of log det J, and the area ratio with the digits that tell it from 1: "1 + 2.2e-16", "0.997838501"."""
    if not 0 < ratio < math.inf:
        return "-", "> 1e308" if ratio else "< 1e-308"
    logarithm = scientific(math.log(ratio), 10, 3)
    if ratio == 1:
        return logarithm, "1"
    if abs(ratio - 1) < 1e-6:
        return logarithm, f"1 {'+' if ratio > 1 else '-'} {abs(ratio - 1):.1e}"
    return logarithm, f"{ratio:.9f}" if 1e-3 <= ratio < 1e3 else f"{ratio:.3e}"
