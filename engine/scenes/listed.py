"""The scenes worth watching, in groups, each with what to watch."""

import math

from pendu_tui.engine.methods import Cast, method_of
from pendu_tui.engine.quantities import ENERGY_ERROR
from pendu_tui.engine.scenes.scene import Line, Scene, Shot

_UNIT_W0 = 9.81  # m, the length with which w0 = 1 s⁻¹, so that z reads like h


def _cast(*keys: str) -> Cast:
    return tuple(map(method_of, keys))


_PRECISE = _cast("verlet_float32", "velocity_verlet", "verlet_compensated")

_SPRING = _cast("velocity_verlet", "rk4", "respa", "implicit_midpoint", "imex_euler")
_STIFF = 2500.0  # s⁻²: the spring vibrates at 50 rad/s, the swing at 3

_FIRST_LOOK = (
    Scene(
        "drift",
        watch="Explicit Euler gains energy, RK4 loses a bit, symplectic methods do neither.",
        shot=Shot(theta=math.pi),
    ),
    Scene(
        "gentle",
        theta=0.1,
        watch="Nearly linear: dE/E per step is z² for explicit Euler and -z⁶/72 for RK4.",
        shot=Shot(front=("explicit_euler", "velocity_verlet", "rk4")),
    ),
    Scene(
        "linear",
        length=_UNIT_W0,
        h=0.5,
        model="linear",
        speed=2.0,
        watch="Linear, so theory is exact: explicit Euler gains 25 % of its energy per step.",
        shot=Shot(theta=math.pi),
    ),
    Scene(
        "large-swing",
        theta=2.5,
        watch="A 143° swing takes 1.64 small-swing periods; explicit Euler goes over the top.",
    ),
    Scene(
        "crossover",
        h=0.2,
        speed=4.0,
        watch="RK4's energy error starts far below Verlet's and passes it after half a minute.",
        shot=Shot(
            log=False,
            front=("velocity_verlet", "rk4"),
            moment=50.0,
            sentence="RK4 left Verlet's band at 33 s, for good: its error grows, "
            "Verlet's does not.",
        ),
    ),
    Scene(
        "near-separatrix",
        theta=math.radians(179.9),
        h=0.02,
        speed=4.0,
        watch="RK4 has the smallest energy error, yet falls from the top at the wrong time.",
        shot=Shot(quantity="theta_error"),
    ),
    Scene(
        "spin",
        theta=0.0,
        omega=8.0,
        h=0.02,
        watch="One turn a second: symplectic Euler's omega, not its theta, is half a kick off.",
        shot=Shot(front=("symplectic_euler", "velocity_verlet")),  # on one ray, errors far apart
    ),
)

_STABILITY = (
    Scene(
        "euler-caught",
        h=0.1,
        speed=60.0,
        watch="Explicit Euler's energy levels off near 110 E0, at half a turn per step.",
        shot=Shot(theta=math.pi, line=Line(ENERGY_ERROR.name, 110.0, "110 E0")),
    ),
    Scene(
        "verlet-limit",
        theta=0.1,
        length=_UNIT_W0,
        h=1.98,
        speed=16.0,
        watch="Just below z = 2: every 11 steps Verlet loses and regains 98 % of its energy.",
        shot=Shot(
            log=False,
            seconds=60.0,
            front=("velocity_verlet",),
            moment=43.56,
            sentence="Twice in 43 s Verlet's energy fell to 2 % and recovered.",
        ),
    ),
    Scene(
        "verlet-limit-above",
        theta=0.1,
        length=_UNIT_W0,
        h=2.02,
        speed=16.0,
        watch="Just above z = 2: Verlet's swing grows until nonlinearity stops it at 0.48 rad.",
        shot=Shot(
            theta=0.6,
            log=False,
            seconds=60.0,
            front=("velocity_verlet",),
            line=Line(
                ENERGY_ERROR.name, (1 - math.cos(0.48)) / (1 - math.cos(0.1)) - 1, "0.48 rad"
            ),
        ),
    ),
    Scene(
        "rk4-limit",
        theta=0.1,
        length=_UNIT_W0,
        h=2.80,
        speed=8.0,
        watch="Just below z = 2√2: RK4 halves its energy in 4 steps; others go over the top.",
        shot=Shot(
            log=False,
            seconds=60.0,
            front=("rk4",),
            line=Line(ENERGY_ERROR.name, -0.5, "half"),
            moment=22.4,
            sentence="After 4 steps half of RK4's energy was gone, after 8 almost three quarters.",
        ),
    ),
    Scene(
        "rk4-limit-above",
        theta=0.1,
        length=_UNIT_W0,
        h=2.86,
        speed=8.0,
        watch="Just above z = 2√2: RK4's swing grows until nonlinearity holds it at 0.2 rad.",
        shot=Shot(theta=0.25, log=False, front=("rk4",)),
    ),
    Scene(
        "chaos-fenced",
        theta=3.14,
        length=_UNIT_W0,
        h=math.sqrt(0.95),
        speed=64.0,
        watch="Standard map, K = z² = 0.95: two methods are chaotic, yet |omega| < pi/h.",
        shot=Shot(
            view="phase",
            theta=math.pi,
            line=Line("omega", math.pi / math.sqrt(0.95), "pi/h"),
            front=("symplectic_euler", "velocity_verlet"),
        ),
    ),
    Scene(
        "chaos-loose",
        theta=3.14,
        length=_UNIT_W0,
        h=math.sqrt(1.1),
        speed=2048.0,
        watch="K = z² = 1.1: no barrier is left, and |omega| exceeds 2 pi/h.",
        shot=Shot(
            view="phase",
            theta=math.pi,
            line=Line("omega", 2 * math.pi / math.sqrt(1.1), "2 pi/h"),
            front=("symplectic_euler", "velocity_verlet"),
        ),
    ),
    Scene(
        "resonance",
        theta=0.6,
        length=_UNIT_W0,
        h=1.45,
        cast=_cast("velocity_verlet", "symplectic_euler"),
        speed=16.0,
        watch="4 steps a period: Verlet's energy doubles and returns. Press - to avoid this.",
        often_said='"h over the golden ratio avoids resonances: the ratio is irrational." But 5/8 '
        "of h does too: it is about as far from the relevant resonance.",
        shot=Shot(log=False, front=("velocity_verlet",)),
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
        watch="Despite friction explicit Euler gains energy and spins; the other swings decay.",
        often_said='"RK4 is better with friction." True for an accuracy of 0.1 % or better, '
        "but at 1 % conformal Verlet costs half as much.",
    ),
    Scene(
        "halving",
        theta=2.0,
        h=0.2,
        cast=_cast("halving_verlet", "halving_richardson", "velocity_verlet", "rk4"),
        speed=4.0,
        watch="Step doubling: energy up 19 % in 1 min, 29.6 % in 2; Verlet stays within 8 %.",
        often_said='"Adaptive steps are better." But step doubling makes Verlet drift in energy.',
        # RK4 lies on Richardson's line
        shot=Shot(log=False, front=("halving_verlet", "halving_richardson", "velocity_verlet")),
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
        watch="h·omega_s = 1: RK4 drains the spring, IMEX Euler drains the whole pendulum.",
        often_said='"IMEX Euler is stable at any h." True, but it damps the swing as well as the '
        "spring.",
        # Verlet and RESPA lie on implicit midpoint
        shot=Shot(
            quantity="spring_energy",
            log=False,
            front=("rk4", "implicit_midpoint", "imex_euler"),
        ),
    ),
    Scene(
        "stiff-limit",
        model="spring",
        parameters={"stiffness": _STIFF},
        h=0.05,
        cast=_SPRING,
        speed=0.25,
        watch="h·omega_s = 2.5, beyond Verlet's limit of 2: it blows up within 1/4 s.",
        shot=Shot(front=("velocity_verlet", "rk4", "implicit_midpoint", "imex_euler")),
    ),
    Scene(
        "stiff-resonance",
        model="spring",
        parameters={"stiffness": _STIFF},
        h=0.125,
        cast=_SPRING,
        speed=0.5,
        watch="One step per spring period: RESPA resonates, implicit midpoint stays bounded.",
        often_said='"With impulse methods, only the slow motion limits h." But h must avoid '
        "multiples of half the spring's period.",
    ),
)

_PRECISION = (
    Scene(
        "precision",
        theta=math.pi - 1e-3,
        h=1 / 256,
        cast=_PRECISE,
        watch="In 32 bits Verlet goes over the top at 5.5 s; in 64 it is good to 0.003 rad.",
        shot=Shot(quantity="theta_error"),
    ),
    Scene(
        "precision-deep",
        theta=math.pi - 1e-6,
        h=1 / 1024,
        cast=_PRECISE,
        speed=4.0,
        watch="In 64 bits theta is off by 0.1 rad at 35 s; with compensated sums by < 3e-4.",
        shot=Shot(quantity="theta_error"),
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
        watch="Learned field and map lose 60 % of E0 in 100 s; H and SympNet stay within 1 %.",
        often_said='"A learned Hamiltonian conserves energy." Only the learned energy: '
        "the true one is off by up to a percent.",
        # the field lies on the map, H on SympNet
        shot=Shot(front=("learned_map", "learned_symplectic_map", "rk4")),
    ),
)

_MEAN_FIELD = (
    Scene(
        "mean-field",
        model="mean_field",
        cast=_cast("rk4", "mean_field_splitting"),
        speed=4.0,
        watch="RK4's energy is good to 4e-4, but the Bloch vector shrinks by 15 % in a minute.",
        shot=Shot(quantity="probability_error", log=False),
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
