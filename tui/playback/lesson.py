"""Lesson: leads a lab through the scenes of a file, to moments, questions and answers."""

from collections.abc import Iterable
from typing import Literal, NamedTuple

from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import Scene, Shot
from pendu_tui.tui.cli.scene import TOUR, read_scenes
from pendu_tui.tui.playback.live import Live

ASTRAY = "This is your own run now. Enter restarts the page."

Stage = Literal["watching", "told", "asked", "answered", "over"]


class LessonState(NamedTuple):
    """Where a lesson stands: at a page, before the moment, there, or at the answer."""

    page: int = 0  # its index
    stage: Stage = "watching"
    choice: int | None = None  # the number of the chosen answer


class Lesson:
    """The pages of a lesson, and where it stands: before the moment, there, or at the answer."""

    def __init__(self, name: str, pages: Iterable[Scene]) -> None:
        self.name = name
        self.pages = tuple(pages)
        self.state = LessonState()

    @property
    def state(self) -> LessonState:
        return LessonState(self.index, self.stage, self.choice)

    @state.setter
    def state(self, state: LessonState) -> None:
        self.index, self.stage, self.choice = state

    def index_of(self, name: str) -> int:
        """Return the index of the page of a scene, -1 without one: before the first page."""
        named = (index for index, page in enumerate(self.pages) if page.name == name)
        return next(named, -1)

    @property
    def page(self) -> Scene:
        return self.pages[self.index]

    @property
    def shot(self) -> Shot:
        return self.page.shot

    @property
    def title(self) -> str:
        return f"{self.name} {self.index + 1} of {len(self.pages)}: {self.page.name}"

    @property
    def text(self) -> tuple[str, ...]:
        """The sentences of this stage."""
        shot = self.shot
        if self.stage == "told":
            return (shot.sentence,)
        if self.stage == "asked":
            answers = (f"{number}: {text}" for number, text in enumerate(shot.answers, 1))
            return shot.sentence, "  ".join([shot.question, *answers])
        if self.stage == "answered":
            result = {None: "", shot.right: "Right. "}.get(self.choice, "Not quite. ")
            return f"{result}{shot.right}: {shot.answers[shot.right - 1]}", shot.truth
        return (self.page.watch,)

    @property
    def _stepping(self) -> Stepping:
        scene = self.page
        return Stepping(scene.h, self.shot.equal_cost, scene.cast).with_smallest(scene.h)

    def is_astray(self, live: Live) -> bool:
        """Return whether the user has changed the run before its moment."""
        steppings = {change.step: change.stepping for change in live.changes}
        straight = {0: self._stepping}
        turned = {**straight, self._turn: self._stepping.reversed()}
        is_page = live.scene == self.page and steppings in (straight, turned)
        return self.stage == "watching" and self.shot.moment is not None and not is_page

    def begin(self, live: Live, index: int) -> None:
        """Start the run of a page.  Raises InputError or OwnMethodError."""
        page = self.pages[index]
        if (live.scene, live.sample.step) != (page, 0):
            live.start(page, page.shot.equal_cost)
        self.index = index
        self.stage = "watching"
        if live.stepping != self._stepping:
            live.change(self._stepping)
        if page.shot.under is not None and page.shot.moment is not None:
            live.lay_under(page.shot.under, page.shot.moment)
        live.set_speed(page.speed)
        live.pause(False)

    def follow(self, live: Live, before: Sample) -> bool:
        """Pause if the moment has come since a sample; return whether it has."""
        if self.stage == "told" and live.sample.step < self._turn:
            self.stage = "watching"  # the user went back
        if self.stage != "watching":
            return False
        if before.step < self._end(live) <= live.sample.step and not self.is_astray(live):
            self._reach(live)
        return self.stage != "watching"

    @property
    def _turn(self) -> int:
        """The step at the moment."""
        return round((self.shot.moment or 0.0) / self._stepping.h)

    def _end(self, live: Live) -> int:
        """The step to stop at: the moment, or where time that turned there is back."""
        if live.stepping.h < 0:
            return 2 * self._turn
        return self._turn

    def _reach(self, live: Live) -> None:
        """Go to the step to stop at, and turn there or tell what there is to tell."""
        live.step(self._end(live) - live.sample.step)
        if self.shot.returns and live.stepping.h > 0:
            live.change(live.stepping.reversed())
            live.pause(False)
        else:
            self.stage = "asked" if self.shot.question else "told"

    def answer(self, choice: int | None) -> None:
        """Answer the question, or show the truth."""
        self.choice = choice
        self.stage = "answered"

    def forward(self, live: Live) -> bool:
        """Go to the moment, the truth, or the next page; return False after the last."""
        if self.is_astray(live):
            self.begin(live, self.index)
        elif self.stage == "watching" and self.shot.moment is not None:
            while self.stage == "watching":
                self._reach(live)
        elif self.stage == "asked":
            self.answer(None)
        elif self.index + 1 < len(self.pages):
            self.begin(live, self.index + 1)
        else:
            self.index = 0
            self.stage = "over"
        return self.stage != "over"

    def back(self, live: Live) -> None:
        """Go back from the truth to the question, or to the previous page."""
        if self.stage == "answered":
            self.stage = "asked"
        else:
            self.begin(live, max(self.index - 1, 0))


def tour() -> Lesson:
    """Return the lesson that comes with the program."""
    return Lesson("Tour", read_scenes(TOUR).values())
