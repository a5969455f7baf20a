"""The scenes worth watching, in groups, each with what to watch."""

import math

from engine.methods import Cast, method_of
from engine.scenes.scene import Scene

_UNIT_W0 = 9.81  # m, the length with which w0 = 1 s⁻¹, so that z reads like h
_GOLDEN = (1 + math.sqrt(5)) / 2


def _cast(*keys: str) -> Cast:
    return tuple(map(method_of, keys))


_RESONANT = _cast("velocity_verlet", "symplectic_euler")
_PRECISE = _cast("verlet_float32", "velocity_verlet", "verlet_compensated")

_SPRING = _cast("velocity_verlet", "rk4", "respa", "implicit_midpoint", "imex_euler")
_STIFF = 2500.0  # s⁻²: the spring vibrates at 50 rad/s, the swing at 3

_FIRST_LOOK = (
    Scene(
        "drift",
        watch="Explicit Euler gains energy, the symplectic ones keep it, RK4 loses a little.",
    ),
    Scene(
        "gentle",
        theta=0.1,
        watch="Nearly linear: a step gains explicit Euler z² of its energy, costs RK4 z⁶/72.",
    ),
    Scene(
        "linear",
        length=_UNIT_W0,
        h=0.5,
        model="linear",
        speed=2.0,
        watch="Linear, so theory is exact: a step gains explicit Euler 25 % of its energy.",
    ),
    Scene(
        "large-swing",
        theta=2.5,
        watch="A swing of 143° takes 1.64 small ones; explicit Euler never ends its first.",
    ),
    Scene(
        "crossover",
        h=0.2,
        speed=4.0,
        watch="RK4 starts far ahead of Verlet in energy and falls behind after half a minute.",
    ),
    Scene(
        "near-separatrix",
        theta=math.radians(179.9),
        h=0.02,
        speed=4.0,
        watch="RK4's energy error is smallest, yet soon it falls at the wrong time.",
    ),
    Scene(
        "spin",
        theta=0.0,
        omega=8.0,
        h=0.02,
        watch="A turn a second: symplectic Euler is half a kick from Verlet, the angles agree.",
    ),
)

_STABILITY = (
    Scene(
        "euler-caught",
        h=0.1,
        speed=20.0,
        watch="Explicit Euler does not gain for ever: half a turn a step holds it near 110 E0.",
    ),
    Scene(
        "verlet-limit",
        theta=0.1,
        length=_UNIT_W0,
        h=1.98,
        speed=16.0,
        watch="Just below z = 2: Verlet loses 98 % of its energy, has it back every 11 steps.",
    ),
    Scene(
        "verlet-limit-above",
        theta=0.1,
        length=_UNIT_W0,
        h=2.02,
        speed=16.0,
        watch="Just above z = 2: Verlet leaves the bottom, the pendulum holds it at 0.48 rad.",
    ),
    Scene(
        "rk4-limit",
        theta=0.1,
        length=_UNIT_W0,
        h=2.80,
        speed=8.0,
        watch="Just below z = 2√2: RK4 loses half its energy in 4 steps, the others go over.",
    ),
    Scene(
        "rk4-limit-above",
        theta=0.1,
        length=_UNIT_W0,
        h=2.86,
        speed=8.0,
        watch="Just above z = 2√2: RK4 gains energy till the pendulum catches it at 0.2 rad.",
    ),
    Scene(
        "chaos-fenced",
        theta=3.14,
        length=_UNIT_W0,
        h=math.sqrt(0.95),
        speed=64.0,
        watch="K = z² = 0.95: the symplectic ones tumble in chaos, yet |omega| stays < pi/h.",
    ),
    Scene(
        "chaos-loose",
        theta=3.14,
        length=_UNIT_W0,
        h=math.sqrt(1.1),
        speed=2048.0,
        watch="K = z² = 1.1: no fence is left, |omega| passes 2 pi/h within a million steps.",
    ),
    Scene(
        "resonance",
        theta=0.6,
        length=_UNIT_W0,
        h=1.45,
        cast=_RESONANT,
        speed=16.0,
        watch="A swing takes Verlet 4 steps, a resonance: its energy doubles and comes back.",
    ),
    Scene(
        "resonance-golden",
        theta=0.6,
        length=_UNIT_W0,
        h=1.45 / _GOLDEN,
        cast=_RESONANT,
        speed=16.0,
        watch="h over the golden ratio: no resonance, but nor at 5/8 h: irrational is no cure.",
        often_said="h over the golden ratio avoids resonances because it is irrational. 5/8 of h "
        "does, too: it is far from the resonance that counts.",
    ),
)

_STRUCTURE = (
    Scene(
        "damped",
        theta=2.0,
        model="damped",
        parameters={"friction": 0.05},
        h=0.025,
        cast=_cast("explicit_euler", "lagged_verlet", "conformal_verlet", "rk4"),
        speed=2.0,
        watch="Explicit Euler gains energy against friction, and spins; the others slow down.",
        often_said="RK4 is to be preferred where energy is lost. True from an accuracy of 0.1 % on; "
        "at 1 % conformal Verlet costs half.",
    ),
    Scene(
        "halving",
        theta=2.0,
        h=0.2,
        cast=_cast("halving_verlet", "halving_richardson", "velocity_verlet", "rk4"),
        speed=4.0,
        watch="Step doubling gains 19 % a minute; Verlet, 8 times cheaper, stays within 8 %.",
        often_said="Adaptive steps are better. They make the energy of a symplectic method drift.",
    ),
)

_STIFFNESS = (
    Scene(
        "stiff-slow",
        model="spring",
        parameters={"stiffness": _STIFF},
        h=0.02,
        cast=_SPRING,
        speed=0.5,
        watch="h·omega = 1: RK4 takes the energy out of the spring, IMEX Euler all of it.",
        often_said="IMEX Euler is stable at any h. True, but it stops the swing as well as the spring.",
    ),
    Scene(
        "stiff-limit",
        model="spring",
        parameters={"stiffness": _STIFF},
        h=0.05,
        cast=_SPRING,
        speed=0.25,
        watch="h·omega = 2.5, beyond Verlet's limit of 2: in a quarter second its bob is gone.",
    ),
    Scene(
        "stiff-resonance",
        model="spring",
        parameters={"stiffness": _STIFF},
        h=0.125,
        cast=_SPRING,
        speed=0.5,
        watch="A period of the spring a step: r-RESPA resonates, implicit midpoint holds.",
        often_said="With impulses h follows the slow motion. But not where it comes near the spring's period.",
    ),
)

_PRECISION = (
    Scene(
        "precision",
        theta=math.pi - 1e-3,
        h=1 / 256,
        cast=_PRECISE,
        watch="32 bits carry Verlet over the top at 5.5 s; 64 bits are right to 0.003 rad.",
    ),
    Scene(
        "precision-deep",
        theta=math.pi - 1e-6,
        h=1 / 1024,
        cast=_PRECISE,
        speed=2.0,
        watch="64 bits lose the angle at 35 s; with compensated sums Verlet is right to 3e-4.",
    ),
)

_LEARNING = (
    Scene(
        "learned",
        theta=1.5,
        h=0.032,
        cast=_cast(
            "rk4_learned_field",
            "learned_map",
            "rk4_learned_hamiltonian",
            "learned_symplectic_map",
            "rk4",
        ),
        speed=8.0,
        watch="Of the same data, in 100 s: field and map lose 60 %, H and SympNet under 1 %.",
        often_said="A learned Hamiltonian conserves energy. It conserves the learned one; the true "
        "one errs by a percent.",
    ),
)

_MEAN_FIELD = (
    Scene(
        "mean-field",
        model="mean_field",
        parameters={"coupling": 2.0, "level_frequency": 20.0},
        cast=_cast("rk4", "mean_field_splitting", "explicit_euler"),
        speed=2.0,
        watch="RK4's energy is right to 4e-4; in a minute 15 % of the probability is gone.",
    ),
)

GROUPS: dict[str, tuple[Scene, ...]] = {
    "first look": _FIRST_LOOK,
    "stability": _STABILITY,
    "structure": _STRUCTURE,
    "stiffness": _STIFFNESS,
    "precision": _PRECISION,
    "learning": _LEARNING,
    "mean field": _MEAN_FIELD,
}
SCENES: dict[str, Scene] = {scene.name: scene for group in GROUPS.values() for scene in group}
DEFAULT_SCENE = SCENES["drift"]
