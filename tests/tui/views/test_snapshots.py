"""The views as they look: characters and colours, and the titles and texts of panes."""

import pytest

from pendu_tui.engine.scenes import SCENES
from pendu_tui.engine.studies.accuracy import ladder
from pendu_tui.tui.drawing.picture import TEXT
from pendu_tui.tui.screens.dialogs import bindings_of, key_text, purpose
from pendu_tui.tui.terminal.options import SMALLEST
from pendu_tui.tui.views.accuracy import AccuracyPane
from pendu_tui.tui.views.lab import EventList, TimeChart
from pendu_tui.tui.views.phase import SectionPane
from pendu_tui.tui.views.stability import StabilityPane
from pendu_tui.tui.views.stage import Stage
from pendu_tui.tui.views.view import Held, Pane
from tests.tui.drawn import looks
from tests.tui.harness import Theatre, lab

SMALL = (80, 24)
LARGE = (120, 40)
SECONDS = 12.0


@pytest.fixture
def robust_studies(monkeypatch):
    """Let the views compute what no last bit of another processor's sine can change visibly.

    In 60 steps chaos does not carry it as far as a dot; no error comes near the rounding.
    """
    steps = ladder(20.0, h_max=0.4, h_min=0.02, count=8)
    monkeypatch.setattr("pendu_tui.tui.views.accuracy.usual", lambda scene, all: (20.0, steps))
    monkeypatch.setattr("pendu_tui.tui.views.stability.PASSES", (60,))


async def settled(theatre: Theatre, *keys: str) -> str:
    await theatre.run(SECONDS)
    await theatre.press(*keys)
    await theatre.settled()
    await theatre.pilot.pause()
    return looks(theatre.app)


@pytest.mark.parametrize(
    ("name", "size", "keys"),
    [
        ("lab-60x16", SMALLEST, []),
        ("lab-80x24", SMALL, []),
        ("lab-120x40", LARGE, []),
        ("phase-80x24", SMALL, ["f3", "5"]),
        ("accuracy-120x40", LARGE, ["f4"]),
        ("stability-80x24", SMALL, ["f5"]),
    ],
)
@pytest.mark.usefixtures("robust_studies")
async def test_every_view(snapshot, name, size, keys):
    async with lab(size=size) as theatre:
        snapshot(f"{name}.txt", await settled(theatre, *keys))


def test_what_help_and_the_line_of_keys_tell_of_a_view(snapshot):
    lines = []
    for owner in (SectionPane, AccuracyPane, StabilityPane):
        lines.append(f"{owner.BINDING_GROUP_TITLE}: {owner.HELP}")
        for each in bindings_of(owner):
            lines.append(f"{key_text(each)} | {each.description * each.show} | {purpose(each)}")
    snapshot("keys.txt", "\n".join(lines) + "\n")


async def test_panes_after_keys_and_pointers(snapshot):
    texts = []
    async with lab(size=(150, 50)) as theatre:

        async def note(what: str) -> None:
            await theatre.run(0.1)
            await theatre.settled()
            texts.append(f"[{what}]")
            for pane in theatre.stage.query("#views *").results(Pane):
                if pane.drawable:
                    titles = f"{pane.border_title} | {pane.border_subtitle}"
                    texts.extend([f"{type(pane).__name__}: {titles}", pane.text])

        await theatre.run(SECONDS)
        await theatre.pilot.hover(TimeChart, offset=(40, 5))
        await note("pointer")
        await theatre.pilot.hover(Stage)
        await theatre.press("+", "2", "e", "y", "o", "r")
        await theatre.run(1)
        await note("ghost")
        await theatre.press("z")
        await note("zoomed ghost")
        await theatre.press("f3", "right", "up")
        await note("crosshair")
        await theatre.press("escape", "f2", "o")
        await theatre.stage.start(SCENES["gentle"])
        await theatre.run(4)
        await theatre.press("+", "r", "e")
        await theatre.run(7)
        await note("small swings but for explicit Euler's")
        theatre.stage.post_message(Held(0.3))
        await note("held")
        theatre.stage.post_message(Held(None))
        await theatre.stage.start(SCENES["stiff-slow"])
        await theatre.run(2)
        for _ in range(3):  # more events than rows
            theatre.source.step(1)
            theatre.source.mark()
        await note("springs")
        assert theatre.pane(EventList)._picture.rows[-1][0][1] == TEXT
        stage = theatre.pane(Stage)
        before = stage.text
        theatre.source.start(SCENES["drift"])
        stage.draw()  # as the pointer asks for it before the next frame
        assert stage.text == before
    snapshot("panes.txt", "\n".join(texts) + "\n")
