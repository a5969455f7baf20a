"""The tour as data: each step has a run and a shot, a question, two answers, and the truth.

Tests measure the truths.
"""

import math
from dataclasses import dataclass, replace
from typing import Literal

from pendu_tui.engine.models import DEFAULT_MODEL
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES, Scene, Shot
from pendu_tui.tui.playback.live import Live

ASTRAY = "This is your own run now. Enter begins the step again."


@dataclass(frozen=True, slots=True)
class TourStep:
    """A step of the tour."""

    title: str
    scene: Scene
    speed: float  # the moment comes after about ten seconds
    watch: str  # what to look at until the moment comes
    moment: float  # s, simulated
    happened: str
    question: str
    answers: tuple[str, str]
    right: int  # index of the right answer
    truth: str
    shot: Shot
    returns: bool = False  # time reverses at the moment; the question comes at t = 0
    equal_cost: bool = False

    @property
    def stepping(self) -> Stepping:
        """The stepping at the start of the run."""
        scene = self.scene
        return Stepping(scene.h, self.equal_cost, scene.cast).with_smallest(scene.h)

    @property
    def asked(self) -> str:
        """The question with its answers."""
        return f"{self.question}  1: {self.answers[0]}  2: {self.answers[1]}"

    @property
    def turn(self) -> int:
        """The step at the moment."""
        return round(self.moment / self.stepping.h)


# The formatter would join lines of a sentence.
# fmt: off
STEPS = (
    TourStep(
        title="who gains",
        scene=SCENES["drift"],
        speed=1.0,
        shot=Shot(theta=math.pi),
        watch="Four methods, one pendulum without friction, the same step. Watch Explicit Euler.",
        moment=7.15,
        happened="Explicit Euler went over the top: it has five times its initial energy.",
        question="Nothing pushes this pendulum. Do the other three keep their energy?",
        answers=("All three, nearly.", "Only RK4, the most accurate."),
        right=0,
        truth=(
            "Symplectic Euler to 8 %, Verlet to 0.6 %: their errors come and go. RK4 lost only "
            "0.002 %, but a little more with each swing."
        ),
    ),
    TourStep(
        title="why",
        scene=SCENES["linear"].altered(theta=0.3, model=DEFAULT_MODEL),
        speed=1.5,
        shot=Shot(view="phase", theta=0.7, front=("explicit_euler", "symplectic_euler")),
        watch="A small swing in phase space, almost an ellipse. Watch Explicit Euler step by step.",
        moment=16.5,
        happened=(
            "Each step of Explicit Euler follows the tangent and lands outside: its energy grows "
            "by about z², 25 % a step."
        ),
        question=(
            "Symplectic Euler differs in one thing: it moves theta with the new omega. Is that "
            "enough?"
        ),
        answers=("Yes, its energy stays bounded.", "No, it gains, only slower."),
        right=0,
        truth=(
            "Its orbit is an ellipse, too, only a tilted one: the energy error stays between -20 "
            "% and +33 %, however long it runs."
        ),
    ),
    TourStep(
        title="smaller h",
        scene=replace(SCENES["drift"], h=0.025),
        speed=2.0,
        shot=Shot(theta=math.pi),
        watch=(
            "The first scene with half the step, at twice the speed, until Verlet has its verdict."
        ),
        moment=17.6,
        happened=(
            "Half the step: Verlet's largest energy error is a quarter, 0.14 % instead of 0.57 %."
            " Its order is 2."
        ),
        question="RK4 has order 4. By how much did its energy error shrink?",
        answers=("To a sixteenth.", "To a thirty-second."),
        right=1,
        truth=(
            "Its loss of energy goes with the fifth power of h. Explicit Euler still goes over the "
            "top, only later."
        ),
    ),
    TourStep(
        title="the crossing",
        scene=SCENES["crossover"],
        speed=3.0,
        shot=Shot(theta=math.pi, front=("velocity_verlet", "rk4")),
        watch="A step of 0.2 s. RK4's energy error starts far below Verlet's.",
        moment=33.4,
        happened="After half a minute RK4's energy error has passed Verlet's, for good.",
        question="Would a smaller step save RK4?",
        answers=("Yes, it would stay below.", "It would only buy time."),
        right=1,
        truth=(
            "With h = 0.05 s the errors cross after half an hour. Verlet's stays bounded, RK4's "
            "grows with each swing."
        ),
    ),
    TourStep(
        title="time reversed",
        scene=SCENES["drift"],
        speed=1.5,
        shot=Shot(theta=math.pi),
        watch=(
            "When Explicit Euler goes over the top, time turns round: the same steps with -h, back "
            "to 0."
        ),
        moment=7.15,
        happened=(
            "Back at t = 0, only Verlet is back at its start, to the last digits. Symplectic Euler "
            "misses it visibly."
        ),
        question="Verlet made errors on the way there. Why does it come home?",
        answers=("It is the most accurate here.", "Its step is symmetric."),
        right=1,
        truth=(
            "A step of -h undoes one of h, errors and all. RK4 is merely accurate: in angle and "
            "speed it misses its start by 0.00004 rad."
        ),
        returns=True,
    ),
    TourStep(
        title="phase space and area",
        scene=SCENES["drift"],
        speed=0.5,
        shot=Shot(view="phase", ring=True, theta=math.pi),
        watch=(
            "The rings are neighbouring starts, carried along by each method. Watch them for two "
            "swings."
        ),
        moment=4.3,
        happened=(
            "Symplectic Euler and Verlet keep the area of their rings exactly; Explicit Euler's "
            "is 2.4 times as large."
        ),
        question="What has area to do with energy?",
        answers=("Where it stays, no orbit spirals out.", "Nothing, it is a coincidence."),
        right=0,
        truth=(
            "Explicit Euler's step multiplies area by 1 + z² cos(theta), RK4's by a little less "
            "than 1."
        ),
    ),
    TourStep(
        title="where it breaks",
        scene=SCENES["verlet-limit-above"],
        speed=2.0,
        shot=Shot(view="stability"),
        watch=(
            "z = h·sqrt(g/L) goes to the right, the amplitude up. The vertical line is Verlet's "
            "linear limit, z = 2; @ is here, just beyond it."
        ),
        moment=20.2,
        happened=(
            "In ten steps Verlet's swing grew from 0.1 to almost 0.5 rad. For a linear spring that "
            "would never end."
        ),
        question="Does it go over the top here?",
        answers=("Yes.", "No."),
        right=1,
        truth=(
            "At 0.48 rad a swing takes longer, so that the same step is small enough again. On a "
            "linear spring RK4 lasts to z = 2.83, Explicit Euler is never stable."
        ),
    ),
    TourStep(
        title="what it costs",
        scene=SCENES["drift"],
        speed=0.25,
        shot=Shot(view="accuracy"),
        watch=(
            "To the right: more force evaluations. Down: smaller errors. At equal cost RK4's step"
            " is four times as long."
        ),
        moment=1.8,
        happened=(
            "With as many force evaluations for all, RK4's energy error passed Verlet's after two"
            " seconds."
        ),
        question="Is Verlet the better method, then?",
        answers=("Yes.", "It depends on the accuracy."),
        right=1,
        truth=(
            "For an error of 1 % Verlet needs half of RK4's evaluations. For 1e-6 RK4 needs an "
            "eighth of Verlet's: its line is steeper."
        ),
        equal_cost=True,
    ),
)
# fmt: on


class Tour:
    """Leads a lab through the steps: to the moment, the question, the truth, and on."""

    def __init__(self, live: Live) -> None:
        self.live = live
        self.index = 0
        self.stage: Literal["watching", "asked", "answered"] = "watching"
        self.choice: int | None = None  # the chosen answer
        self._home: tuple[int, Stepping] | None = None  # the step's run and its stepping

    @property
    def step(self) -> TourStep:
        return STEPS[self.index]

    @property
    def title(self) -> str:
        return f"Tour {self.index + 1} of {len(STEPS)}: {self.step.title}"

    @property
    def is_astray(self) -> bool:
        """Return whether the user has changed the run before its moment."""
        return self.stage == "watching" and (self.live.sample.run, self.live.stepping) != self._home

    @property
    def text(self) -> tuple[str, ...]:
        """Return the sentences of this stage."""
        step = self.step
        if self.is_astray:
            return (ASTRAY,)
        if self.stage == "watching":
            return (step.watch,)
        if self.stage == "asked":
            return step.happened, step.asked
        result = {None: "", step.right: "Right. "}.get(self.choice, "Not quite. ")
        return f"{result}{step.right + 1}: {step.answers[step.right]}", step.truth

    def begin(self, index: int) -> None:
        """Set the run of a step in the lab."""
        self.index = index
        self.stage = "watching"
        if (self.live.scene, self.live.sample.step) != (self.step.scene, 0):
            self.live.start(self.step.scene)
        self._go_on(self.step.stepping)
        self.live.set_speed(self.step.speed)

    def _go_on(self, stepping: Stepping) -> None:
        if stepping != self.live.stepping:
            self.live.set_stepping(stepping)
        self._home = self.live.sample.run, stepping
        self.live.pause(False)

    def follow(self, at_once: bool = False) -> bool:
        """Pause at the moment, `at_once` or when it comes; return whether it has come."""
        if self.stage != "watching" or self.is_astray:
            return False
        end = self.step.turn
        if self.step.returns:
            if self.live.stepping.h > 0 and self._reach(end, at_once):
                self._go_on(self.live.stepping.reversed())
            if self.live.stepping.h > 0:
                return False
            end *= 2
        if self._reach(end, at_once):
            self.stage = "asked"
        return self.stage == "asked"

    def _reach(self, step: int, at_once: bool) -> bool:
        """Pause at a step, once it has come."""
        reached = at_once or self.live.sample.step >= step
        if reached:
            self.live.go_to(self.live.sample.run, step)
        return reached

    def answer(self, choice: int | None) -> None:
        """Answer the question, or show the truth."""
        self.choice = choice
        self.stage = "answered"

    def forward(self) -> bool:
        """Go to the moment, the truth, or the next step; return False after the last."""
        if self.is_astray:
            self.begin(self.index)
        elif self.stage == "watching":
            self.follow(at_once=True)
        elif self.stage == "asked":
            self.answer(None)
        elif self.index + 1 < len(STEPS):
            self.begin(self.index + 1)
        else:
            self.index = 0
            return False
        return True

    def back(self) -> None:
        """Go back from the truth to the question, or to the previous step."""
        if self.stage == "answered":
            self.stage = "asked"
        else:
            self.begin(max(self.index - 1, 0))
