"""Guide: takes a lab through the tour, and knows what to say."""

from typing import Literal

from tui.playback.live import Live
from tui.words.tour.steps import STEPS, Step

MOST_STEPS = 5000  # of a run until a moment; the latest comes after 704

ASTRAY = "This is your own run now. Enter begins the step again."


class Guide:
    """Sets a step's run in a lab, pauses it at the step's moment, asks, and answers."""

    def __init__(self, live: Live) -> None:
        self.live = live
        self._to_the_start()

    def _to_the_start(self) -> None:
        self.at = 0
        self.stage: Literal["watching", "asked", "answered"] = "watching"
        self._set = (0, self.step.stepping)  # the run, and how it steps

    @property
    def step(self) -> Step:
        return STEPS[self.at]

    @property
    def title(self) -> str:
        return f"Tour {self.at + 1} of {len(STEPS)}: {self.step.title}"

    @property
    def is_astray(self) -> bool:
        """Whether the user has changed the run before its moment came."""
        return self.stage == "watching" and not self.is_at_home

    @property
    def is_at_home(self) -> bool:
        """Whether the lab still shows the step's run, as the guide has set it."""
        return (self.live.sample.run, self.live.stepping) == self._set

    @property
    def said(self) -> tuple[str, ...]:
        if self.stage == "watching":
            return (ASTRAY,) if self.is_astray else (self.step.watch,)
        if self.stage == "asked":
            return self.step.sentence, self.step.question
        return self.step.question, self.step.answer

    def go(self, at: int) -> None:
        """Begin a step."""
        self.at, self.stage = at, "watching"
        live, step = self.live, self.step
        if (live.scene, live.sample.step) != (step.scene, 0):
            live.start(step.scene)
        if live.stepping != step.stepping:
            live.set_stepping(step.stepping)
        self._note()
        self.go_on()

    def go_on(self) -> None:
        """Go on where one left; the step begins again if the lab shows another run since."""
        if not self.is_at_home:
            self.go(self.at)
        else:
            self.live.set_speed(self.step.speed)
            self.live.pause(self.stage != "watching")

    def follow(self) -> bool:
        """Look whether the moment has come; if so, the lab is paused."""
        if self.stage != "watching" or self.is_astray:
            return False
        turns = self.step.turns
        if turns is not None and self.live.stepping.h > 0:
            if turns(self.live):
                self.live.set_stepping(self.live.stepping.reversed())
                self._note()
        elif self.step.until(self.live):
            self.live.pause(True)
            self.stage = "asked"
            return True
        return False

    def forward(self) -> bool:
        """Go to the moment at once, to the answer, or to the next step; False after the last."""
        if self.is_astray:
            self.go(self.at)
        elif self.stage == "watching":
            for _ in range(MOST_STEPS):
                if self.follow():
                    break
                self.live.step(1)
        elif self.stage == "asked":
            self.stage = "answered"
        elif self.at + 1 < len(STEPS):
            self.go(self.at + 1)
        else:
            self._to_the_start()
            return False
        return True

    def back(self) -> None:
        """Return from the answer to the question, or else to the step before."""
        if self.stage == "answered":
            self.stage = "asked"
        else:
            self.go(max(self.at - 1, 0))

    def _note(self) -> None:
        self._set = self.live.sample.run, self.live.stepping
