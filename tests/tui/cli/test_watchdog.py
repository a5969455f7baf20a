"""When the watchdog interrupts a step or ends the program, by clocks that the tests set."""

import signal
import time
from types import SimpleNamespace

import pytest

from pendu_tui.engine.methods.own import OwnMethodError, TooLongError
from pendu_tui.tui.cli import watchdog
from pendu_tui.tui.cli.watchdog import ALARM, Watchdog


@pytest.mark.parametrize(
    ("depth", "steps", "happens"), [(1, 0, [(3.0, ALARM), (3.6, 3)]), (1, 1, []), (0, 0, [])]
)
def test_a_step_is_interrupted_after_3_s_and_if_it_goes_on_the_program_ends(
    depth, steps, happens, monkeypatch
):
    now = 0.0
    happened = []

    def sleep(seconds: float) -> None:
        nonlocal now
        now += seconds
        watchdog.USER_CODE.count += steps
        if now > 5.0:
            raise StopIteration

    dog = Watchdog()
    for place, name in ((dog, "end"), (watchdog, "interrupt_main")):
        monkeypatch.setattr(place, name, lambda code, *_: happened.append((round(now, 1), code)))
    monkeypatch.setattr(watchdog.time, "sleep", sleep)
    monkeypatch.setattr(watchdog, "USER_CODE", SimpleNamespace(depth=depth, count=0))
    with pytest.raises(StopIteration):
        dog.run()
    assert happened == happens


def test_the_line_that_takes_too_long_is_named_and_work_between_steps_is_an_error_of_the_method(
    monkeypatch,
):
    watchdog.watchdog()
    assert signal.getsignal(ALARM) == watchdog._interrupt
    begun = []
    monkeypatch.setattr(watchdog, "watchdog", lambda: begun.append("watchdog"))
    line = compile("\nfound = find()", "mine.py", "exec")
    found = {"__name__": "own_method", "find": watchdog._place_in_main}
    exec(line, found)
    assert found["found"].startswith("mine.py, line 2")
    watchdog.USER_CODE.depth = 1  # an interrupt came while a step began
    with pytest.raises(OwnMethodError, match="takes more than 3 s"), watchdog.limited():
        raise TooLongError
    assert (begun, watchdog.USER_CODE.depth) == (["watchdog"], 0)
    watchdog._interrupt()  # comes too late
    with pytest.raises(TooLongError), watchdog.USER_CODE:
        watchdog._interrupt()


def test_the_recording_is_closed_and_the_terminal_restored_before_the_end(monkeypatch):
    done = []
    leave = done.append
    dog = Watchdog()
    dog.close = lambda: leave("closed")
    dog.tell = leave
    monkeypatch.setattr(watchdog.os, "_exit", leave)
    monkeypatch.setattr(watchdog.system, "restore_terminal", lambda _: leave("restored"))
    timer = SimpleNamespace(start=lambda: leave("later"))
    monkeypatch.setattr(watchdog, "Timer", lambda *given: leave(given) or timer)
    dog.end(3, "why.")
    dog.end(130)
    assert done[:6] == [(3.0, leave, (3,)), "later", "closed", "restored", "why.", 3]
    assert done[6:] == [(3.0, leave, (130,)), "later", "closed", "restored", 130]


def test_a_lab_is_asked_to_leave_once_its_terminal_is_gone_and_ended_5_s_later(monkeypatch):
    ended = []
    asked = []
    handled = []
    leave = object()
    close = object()
    ignored = {watchdog.system.ENDING[0]: signal.SIG_IGN}  # as under nohup
    monkeypatch.setattr(signal, "signal", lambda number, _: handled.append(number))
    monkeypatch.setattr(signal, "getsignal", ignored.get)
    dog = Watchdog()
    monkeypatch.setattr(dog, "end", ended.append)
    monkeypatch.setattr(watchdog.system, "is_gone", lambda: False)
    loop = SimpleNamespace(call_soon_threadsafe=asked.append)
    dog.guard(loop, leave, close)
    assert dog.close is close
    assert handled == [*watchdog.system.ENDING[1:]]
    dog._look()
    assert not asked
    for place, name in ((watchdog.os, "getppid"), (watchdog.system, "is_gone")):
        with monkeypatch.context() as changed:
            changed.setattr(place, name, lambda: "another")
            dog._look()
        assert asked.pop() is leave
    for ago, codes in ((4.8, []), (5.2, [130])):
        dog._asked_at = time.monotonic() - ago
        dog._look()
        assert ended == codes


def test_a_process_that_is_silent_for_5_s_is_ended_unless_it_is_stopped(monkeypatch, capfd):
    second = 0
    ended = []

    def poll(_: float) -> bool:
        nonlocal second
        second += 1
        return second == 5

    monkeypatch.setattr(signal, "signal", lambda *given: ended.append(given))
    monkeypatch.setattr(watchdog.system, "restore_terminal", lambda _: ended.append("restored"))
    monkeypatch.setattr(watchdog.system, "is_stopped", lambda _: second in (7, 8))
    monkeypatch.setattr(watchdog.system, "kill", lambda *given: ended.append((second, *given)))
    watchdog._end_if_silent(SimpleNamespace(poll=poll, recv=bool), 123)
    assert ended == [(signal.SIGINT, signal.SIG_IGN), "restored", (5 + 2 + 5, 123, 3)]
    assert capfd.readouterr().err.startswith("pendu-tui: ended: a call in C")
