"""STEPS: a scene, the moment that is waited for, a sentence, a question and its answer.

Tests measure what the sentences say.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

from engine.run.stepping import Stepping
from engine.scenes import SCENES, Scene
from tui.playback.source import Source

Moment = Callable[[Source], bool]
"""Whether it has come; once it has, it has come for the rest of the run."""


def over_the_top(key: str) -> Moment:
    """A method went over the top."""
    return lambda source: any((each.kind, each.method.key) == ("over the top", key) for each in source.milestones)


def stays_bounded(key: str) -> Moment:
    """A method earned the verdict `bounded`."""
    return lambda source: any((each.verdict, each.method.key) == ("bounded", key) for each in source.milestones)


def energy_times(key: str, factor: float) -> Moment:
    """A method's energy has been this many times that of its start."""
    return lambda source: source.sample.readings[_place(source, key)].energy_error_high >= factor - 1


def falls_behind(key: str, other: str) -> Moment:
    """A method's largest energy error so far has passed another's."""

    def moment(source: Source) -> bool:
        readings = source.sample.readings
        return readings[_place(source, key)].max_energy_error > readings[_place(source, other)].max_energy_error

    return moment


def back_at_start(source: Source) -> bool:
    """Time has run back to 0."""
    return source.history.returned is not None


def swings(count: int) -> Moment:
    """The exact pendulum has swung so many times."""
    return lambda source: source.sample.t >= count * (source.exact.period or 0.0)


def reaches(key: str, theta: float) -> Moment:
    """A method's bob is this far [rad] from the bottom, or has been: it is where its energy error is largest."""
    return lambda source: abs(source.sample.readings[_place(source, key)].theta) >= theta


def _place(source: Source, key: str) -> int:
    return next(place for place, method in enumerate(source.scene.cast) if method.key == key)


@dataclass(frozen=True, slots=True)
class Step:
    """One step of the tour."""

    title: str
    scene: Scene
    speed: float  # so that the moment comes after about ten seconds
    view: str  # a key of VIEWS
    watch: str  # what to look at until the moment comes
    until: Moment
    sentence: str
    question: str
    answer: str
    turns: Moment | None = None  # when time turns round
    equal_cost: bool = False

    @property
    def stepping(self) -> Stepping:
        """How its run steps at first."""
        scene = self.scene
        return Stepping(scene.h, self.equal_cost, scene.cast).with_smallest(scene.h)


EULER, SYMPLECTIC, VERLET, RK4 = "explicit_euler", "symplectic_euler", "velocity_verlet", "rk4"

STEPS = (
    Step(
        "who gains",
        SCENES["drift"],
        1.0,
        "lab",
        "Four methods, one pendulum without friction, the same step. Watch Explicit Euler.",
        over_the_top(EULER),
        "Explicit Euler went over the top: it has five times its initial energy.",
        "Nothing pushes this pendulum. Do the other three keep their energy?",
        "Symplectic Euler to 8 %, Verlet to 0.6 %: their errors come and go. RK4 lost only 0.002 %, but a little more"
        " with each swing.",
    ),
    Step(
        "why",
        SCENES["linear"].altered(theta=0.3, model="pendulum"),
        0.5,
        "phase",
        "A small swing in phase space, where it is almost an ellipse. Watch Explicit Euler step by step.",
        energy_times(EULER, 10),
        "Each step of Explicit Euler follows the tangent and lands outside: its energy grows by about z², 25 % a step.",
        "Symplectic Euler differs in one thing: it moves theta with the new omega. Is that enough?",
        "Yes. Its orbit is an ellipse, too, only a tilted one: the energy error stays between -20 % and +33 %, however"
        " long it runs.",
    ),
    Step(
        "smaller h",
        replace(SCENES["drift"], h=0.025),
        2.0,
        "lab",
        "The first scene again with half the step, at twice the speed, until Verlet has its verdict.",
        stays_bounded(VERLET),
        "Half the step: Verlet's largest energy error is a quarter, 0.14 % instead of 0.57 %. Its order is 2.",
        "RK4 has order 4. Is its energy error a sixteenth now?",
        "Even less: a thirty-second, for its loss of energy goes with the fifth power of h. Explicit Euler still goes"
        " over the top, only later.",
    ),
    Step(
        "the crossing",
        SCENES["crossover"],
        3.0,
        "lab",
        "A step of 0.2 s. RK4's energy error starts far below Verlet's.",
        falls_behind(RK4, VERLET),
        "After half a minute RK4's energy error has passed Verlet's, for good.",
        "Would a smaller step save RK4?",
        "It buys time: with h = 0.05 s the errors cross after half an hour. Verlet's stays bounded, RK4's grows with"
        " each swing.",
    ),
    Step(
        "time reversed",
        SCENES["drift"],
        1.5,
        "lab",
        "When Explicit Euler goes over the top, time turns round: the same steps with -h, back to 0.",
        back_at_start,
        "Back at t = 0, only Verlet is back at its start, to the last digits. Symplectic Euler misses it visibly.",
        "Verlet made errors on the way there. Why does it come home?",
        "Its step is symmetric: a step of -h undoes one of h, errors and all. RK4 is merely accurate and misses its"
        " start by 0.00004 rad.",
        turns=over_the_top(EULER),
    ),
    Step(
        "phase space and area",
        SCENES["drift"],
        0.5,
        "phase",
        "The rings are neighbouring starts, carried along by each method. Watch them for two swings.",
        swings(2),
        "Symplectic Euler and Verlet keep the area of their rings exactly; Explicit Euler's is 2.4 times as large.",
        "What has area to do with energy?",
        "Where area stays, orbits cannot spiral out or in. Explicit Euler's step multiplies it by 1 + z² cos(theta),"
        " RK4's by a little less than 1.",
    ),
    Step(
        "where it breaks",
        SCENES["verlet-limit-above"],
        2.0,
        "stability",
        "z = h·sqrt(g/L) goes to the right, the amplitude up; @ is here, just above Verlet's limit 2.",
        reaches(VERLET, 0.45),
        "In ten steps Verlet's swing grew from 0.1 to almost 0.5 rad. For a linear spring that would never end.",
        "Does it go over the top here?",
        "No: at 0.48 rad a swing takes longer, so that the same step is small enough again. RK4 lasts to z = 2.83,"
        " Explicit Euler is never stable.",
    ),
    Step(
        "what it costs",
        SCENES["drift"],
        0.25,
        "accuracy",
        "To the right: more force evaluations. Down: smaller errors. At equal cost RK4's step is four times as long.",
        falls_behind(RK4, VERLET),
        "With as many force evaluations for all, RK4's energy error passed Verlet's after two seconds.",
        "Is Verlet the better method, then?",
        "For an error of 1 % it is: it needs half of RK4's evaluations. For 1e-6 RK4 needs an eighth of Verlet's: its"
        " line is steeper.",
        equal_cost=True,
    ),
)
