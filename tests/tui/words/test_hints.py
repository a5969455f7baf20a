"""Each hint is shown once, unless the user knows it already."""

from recordings.events import Event
from tests.tui.harness import lab
from tui.screens.insight_line import InsightLine
from tui.words.insight import HINT_SHOWN, HINTS, hint

FIRST_START = Event("start", 1, 0, 0.0)


def shown(events: list[Event]) -> list[str]:
    """The hints of two minutes, in the order in which they come and go."""
    told = [hint(seconds / 10, events) for seconds in range(1200)]
    return [text for before, text in zip(["", *told], told, strict=False) if text != before and text]


def test_each_hint_is_shown_once_for_some_seconds():
    assert shown([FIRST_START]) == [text for _, _, text in HINTS]
    assert sum(bool(hint(seconds / 10, [])) for seconds in range(1200)) == len(HINTS) * HINT_SHOWN * 10


def test_a_hint_is_left_out_once_its_key_was_used():
    for event in Event("pause", 1, 3, 0.1), Event("set_h", 1, 3, 0.1, h=0.1), Event("start", 2, 0, 0.0):
        left = [text for _, kind, text in HINTS if kind != event.kind]
        assert shown([FIRST_START, event]) == left
        assert len(left) < len(HINTS)


async def test_hints_come_and_go_on_the_insight_line():
    async with lab(size=(60, 16)) as theatre:
        said = []
        for _ in range(31):
            await theatre.run(2)
            said.append(theatre.text(InsightLine).strip())
    assert [text for text in dict.fromkeys(said) if text in {text for _, _, text in HINTS}] == [
        text for _, _, text in HINTS
    ]
    assert len([text for text in said if text == HINTS[0][2]]) == HINT_SHOWN / 2
