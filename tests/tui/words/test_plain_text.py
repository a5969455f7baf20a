"""The lab as sentences."""

import re

from engine.methods import RK4, USUAL_CAST, VELOCITY_VERLET, Cast
from engine.scenes import SCENES
from recordings.library import GOLDEN
from recordings.recording import Recording
from tui.playback.live import Live
from tui.playback.replay import Replay
from tui.playback.source import Source
from tui.words.describe import description
from tui.words.plain_text import print_run

DRIFT = SCENES["drift"]


class Hour:
    """A clock that goes on by sleeping."""

    now = 100.0

    def read(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += seconds


def said(source: Source, seconds: float, only: Cast | None = None) -> list[str]:
    """What is said in so many seconds of the clock."""
    clock, sentences = Hour(), []
    end = clock.now + seconds
    print_run(
        source, sentences.append, lambda: clock.now >= end, clock.read, clock.sleep, only=only
    )
    return sentences


def lab(scene=DRIFT, speed=1.0) -> Live:
    return Live(scene, speed, clock=lambda: 0.0)


def test_it_begins_with_a_description():
    live = lab()
    first = description(live)
    assert said(live, 3)[: len(first)] == first


def test_every_second_has_a_sentence_and_every_event_one_more():
    live = lab()
    sentences = said(live, 20.5)[len(description(live)) :]
    events = [text for text in sentences if re.fullmatch(r"[\d.]+ s: (?!energy errors).*", text)]
    assert events == [
        "7.15 s: Explicit Euler over the top, 5.1 E0.",
        "9.00 s: Explicit Euler gains energy.",
        "9.00 s: RK4 loses energy.",
        "18.00 s: Symplectic Euler stays bounded.",
        "18.00 s: Verlet stays bounded.",
    ]
    assert len(sentences) == 20 + len(events)


def test_what_happened_is_explained_within_a_second():
    sentences = said(lab(), 10)
    at = sentences.index("7.15 s: Explicit Euler over the top, 5.1 E0.")
    assert sentences[at + 1].startswith("Explicit Euler went over the top at 7.15 s with ")


def test_the_numbers_are_those_of_the_sample():
    live = lab()
    told = re.findall(
        r"([A-Z][A-Za-z4 ]+) ([-+][\d.e+-]+\d)", said(live, 5.01)[-1].partition("errors ")[2]
    )
    for (name, number), method, reading in zip(told, USUAL_CAST, live.sample.readings, strict=True):
        assert method.label.endswith(name)
        assert float(number) == float(f"{reading.energy_error:+.2g}")


def test_seconds_are_those_of_the_clock_at_any_speed():
    slow, fast = lab(speed=0.25), lab(speed=8)
    assert len(said(slow, 5.1)) == len(description(slow)) + 5
    assert fast.sample.t == 0
    said(fast, 5)
    assert 39 < fast.sample.t < 41


def test_of_some_methods_nothing_is_said_of_the_others():
    sentences = "\n".join(said(lab(), 20.5, (RK4, VELOCITY_VERLET)))
    assert "RK4 loses energy" in sentences
    assert "Verlet stays bounded" in sentences
    assert "Euler" not in sentences


def test_a_replay_ends_at_its_end():
    path = GOLDEN / "drift.mcap"
    with Recording.open(path) as recording:
        replay = Replay(recording)
        sentences = said(replay, 1000)
        assert sentences[0].startswith("The replay runs in real time")
        assert len(sentences) < recording.length + 30
        assert replay.playhead.position == recording.length


def test_sentences_are_whole_and_plain():
    for scene in SCENES.values():
        for text in said(lab(scene), 12):
            assert text.endswith(".")
            assert "\n" not in text
            assert "\x1b" not in text
