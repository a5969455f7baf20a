"""Each hint comes once, and to those who need it."""

from recordings.events import Event
from tests.tui.stage import lab
from tui.screens.insight_line import InsightLine
from tui.words.insight import HINT_SHOWN, HINTS, hint

FIRST_START = Event("start", 1, 0, 0.0)


def shown(events: list[Event]) -> list[str]:
    """The hints of two minutes, in the order in which they come and go."""
    told = [hint(seconds / 10, events) for seconds in range(1200)]
    return [text for before, text in zip(["", *told], told, strict=False) if text != before and text]


def test_each_hint_comes_once_for_some_seconds():
    assert shown([FIRST_START]) == [text for _, _, text in HINTS]
    assert sum(bool(hint(seconds / 10, [])) for seconds in range(1200)) == len(HINTS) * HINT_SHOWN * 10


def test_who_has_done_it_is_not_told_how():
    for known, event in enumerate(
        [Event("pause", 1, 3, 0.1), Event("set_h", 1, 3, 0.1, h=0.1), Event("start", 2, 0, 0.0)]
    ):
        assert shown([FIRST_START, event]) == [text for n, (_, _, text) in enumerate(HINTS) if n != known]


async def test_hints_are_on_the_insight_line_and_leave_it_again():
    async with lab(size=(60, 16)) as theatre:
        said = []
        for _ in range(31):
            await theatre.run(2)
            said.append(theatre.text(InsightLine).strip())
    assert [text for text in dict.fromkeys(said) if text in {text for _, _, text in HINTS}] == [
        text for _, _, text in HINTS
    ]
    assert len([text for text in said if text == HINTS[0][2]]) == HINT_SHOWN / 2
