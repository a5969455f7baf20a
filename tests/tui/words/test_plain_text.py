"""The lab in words, held against the lab; and the list of events, in order and with their times."""

import re
from pathlib import Path
from types import SimpleNamespace

import pytest

from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES
from pendu_tui.recordings.files import GOLDEN
from pendu_tui.recordings.recording import Recording
from pendu_tui.tui.cli.errors import UserError
from pendu_tui.tui.playback.lesson import Lesson, tour
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.replay import Replay
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.words.insight import insight
from pendu_tui.tui.words.plain_text import (
    description,
    event_lines,
    method_sentence,
    numbered,
    tell,
)
from tests.tui.harness import after

DRIFT = SCENES["drift"]


class Hour:
    """A clock that goes on by sleeping."""

    now = 100.0

    def read(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += seconds


def said(source: Source, seconds: float) -> list[str]:
    """The sentences on so many seconds of the clock, after the description."""
    clock, sentences = Hour(), []
    end = clock.now + seconds
    tell(source, sentences.append, lambda: clock.now >= end, clock.read, clock.sleep)
    last = next(at for at, text in enumerate(sentences) if "ecording" in text)
    return sentences[last + 1 :]


def test_descriptions_as_they_are_stored(snapshot):
    live = after(DRIFT, 3)
    texts = [*description(live), "", description(live, stands_still=True)[0], ""]

    def record(failed: str | None) -> None:
        path = Path("mine.mcap")
        live.recorder = SimpleNamespace(path=path, seconds=75, failed=failed, add=lambda *_: None)

    for act in (
        lambda: record(None),
        lambda: live.step(340),
        lambda: live.set_speed(0.5) or live.pause(False),
        lambda: record("the disk is full."),
        lambda: live.change(Stepping(0.1)) or live.restart(),
        lambda: live.change(Stepping(0.2, equal_cost=True)),
        lambda: live.change(Stepping(-0.05)),
        lambda: live.start(SCENES["spin"]),
        lambda: live.start(SCENES["stiff-limit"]),
        lambda: setattr(live, "failure", "mine fails."),
        lambda: live.start(SCENES["damped"].altered(theta=3.1, h=0.2)) or live.step(200),
    ):
        act()
        texts += [*description(live), *map(str, event_lines(live)[-3:]), ""]
    snapshot("descriptions.txt", "\n".join(texts))
    live.judgements[1] = live.judgements[1]._replace(progress=None)
    assert method_sentence(live, 1).endswith("; undecided: " + live.judgements[1].reason + ".")


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_sentences_and_events_of_a_scene_fit_the_smallest_pane(scene):
    live = Live(scene, clock=lambda: 0.0)
    for steps in (0, 300):
        live.step(steps)
        for index, method in enumerate(scene.cast):
            sentence = method_sentence(live, index)
            assert re.fullmatch(r"[A-Zr].*\.", sentence)
            assert method.label.split()[-1] in sentence
        assert 10 < len(insight(live).text) <= 110
    assert all(len(str(line)) <= 46 for line in event_lines(live))


def test_every_event_has_a_sentence_also_at_another_speed():
    live = Live(DRIFT, clock=lambda: 0.0)
    sentences = said(live, 20.5)
    times = [text.partition(" s: ")[0] for text in sentences]
    assert times == ["7.15", "8.75", "8.75", "17.25", "17.25"]
    assert sentences[0].endswith("Explicit Euler over the top, 5.1 E0.")
    assert said(Live(DRIFT, 4.0, clock=lambda: 0.0), 20.5 / 4) == sentences
    live.failure = "mine fails."
    with pytest.raises(UserError, match="mine fails"):
        said(live, 1)


def test_a_lesson_gives_time_to_read_asks_at_its_moment_answers_and_ends():
    clock = Hour()
    told = []
    page = tour().page
    begin = clock.now
    live = Live(SCENES["spin"], clock=clock.read)

    def emit(sentence):
        told.append((clock.now - begin, sentence))

    lesson = Lesson("Page", [DRIFT, page])
    tell(live, emit, lambda: clock.now > begin + 60, clock.read, clock.sleep, lesson=lesson)
    assert 'the scene "drift"' in told[0][1]
    asked = next(at for at, sentence in told if page.shot.question in sentence)
    answered = next(at for at, sentence in told if page.shot.truth in sentence)
    times = (6 + page.shot.moment, 6, 6)
    assert (asked, answered - asked, clock.now - begin - answered) == pytest.approx(times, abs=0.2)


def test_a_replay_ends_at_its_end():
    with Recording.open(GOLDEN / "drift.mcap") as recording:
        replay = Replay(recording)
        assert description(replay)[0].startswith("The replay runs at 1× speed and is at 0.00 s")
        assert description(replay)[-1] == "The recording drift.mcap is 15.00 s long."
        clock = Hour()
        end = clock.now + recording.length
        tell(replay, id, lambda: clock.now > end + 1, clock.read, clock.sleep)
        assert clock.now == pytest.approx(end, abs=0.1)
        assert replay.playhead.position == recording.length


def test_events_of_hidden_methods_are_not_listed():
    live = after(SCENES["crossover"], 36)
    assert "33.40 s RK4's error > Verlet's" in map(str, event_lines(live))
    shown = "".join(map(str, event_lines(live, {"velocity_verlet"})))
    assert "RK4: - loses" in shown
    assert "Verlet" not in shown


def test_changes_and_marks_are_listed_pauses_are_not_and_a_step_back_removes_what_comes_later(
    snapshot,
):
    live = after(DRIFT, 8)
    live.mark()
    live.pause(True)
    live.set_speed(2)
    live.change(Stepping(0.1))
    live.step(1)
    live.mark("question 2")
    live.change(Stepping(-0.1))
    live.change(Stepping(0.4, equal_cost=True))
    live.start(DRIFT.altered(theta=2.0))
    live.step(50)
    live.mark()
    live.step(150)
    snapshot("events.txt", "\n".join(numbered(event_lines(live))) + "\n")
    live = after(DRIFT.altered(theta=1.001), 8)
    live.step(-20)
    assert numbered(event_lines(live)) == [" 0.00 s start 57.35° 0 rad/s, h 0.05 s"]
    ways = []
    for h in (-0.05, 0.05, 0.1, -0.1):
        live.change(Stepping(h))
        ways += re.findall("backwards|forwards|$", str(event_lines(live)[-1]))[:1]
    live.start(DRIFT)
    live.change(Stepping(0.2))
    assert ways == ["backwards", "forwards", "", "backwards"]
    assert "forwards" not in str(event_lines(live)[-1])
