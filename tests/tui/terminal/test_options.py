import itertools
import sys
from contextlib import nullcontext
from types import SimpleNamespace

import pytest

from pendu_tui.tui.cli.errors import UserError
from pendu_tui.tui.commands.options import parser_of
from pendu_tui.tui.terminal import options
from pendu_tui.tui.terminal.options import (
    CHARACTER_SETS,
    TerminalOptions,
    cells,
    check_terminal,
    colours,
    terminal_options_of,
)

XTERM = {"TERM": "xterm-256color"}


def chosen(arguments: str = "", encoding: str = "utf-8", **environment: str) -> TerminalOptions:
    given = parser_of("live").parse_args(arguments.split())
    return terminal_options_of(given, XTERM | environment, encoding)


def test_what_is_asked_for_is_taken_whatever_the_terminal_says():
    asked = "--theme light --pixels half --no-mouse --fps 12"
    taken = TerminalOptions("light", "half", mouse=False, fps=12)
    assert chosen(asked, encoding="ascii", NO_COLOR="1", TEXTUAL_ANIMATIONS="none") == taken


@pytest.mark.parametrize(
    ("environment", "theme"),
    [
        ({"COLORFGBG": "15;0"}, "dark"),
        ({"COLORFGBG": "0;15"}, "light"),
        ({"COLORFGBG": "0;default;7"}, "light"),
        ({"COLORFGBG": "0;8"}, "dark"),
        ({"COLORFGBG": "0;9"}, "light"),
        ({"COLORFGBG": "nonsense"}, "dark"),
        ({"TERM": "linux", "COLORFGBG": "0;15"}, "ansi"),
        ({"NO_COLOR": "1", "COLORTERM": "truecolor"}, "ansi"),
    ],
)
def test_the_theme_follows_what_the_terminal_says(environment, theme):
    assert chosen(**environment).theme == theme


@pytest.mark.parametrize(
    ("term", "number"),
    [
        ("xterm-256color", 256),
        ("xterm-Kitty", 256),
        ("screen", 16),
        ("", 0),
        ("dumb", 0),
        ("unknown", 0),
    ],
)
def test_colours_are_counted_by_what_the_terminal_is_called(term, number):
    assert colours({"TERM": term}) == number
    for value in ("truecolor", " 24Bit"):
        assert colours({"TERM": term, "COLORTERM": value}) == 1 << 24


@pytest.fixture
def ask(monkeypatch):
    """Ask a terminal for its background; return that, what was sent, and how long was waited."""

    def ask(*answers: bytes, can_wait=True):
        sent, waits = [], []
        parts = iter(answers)

        def select(*asked):
            waits.append(asked[-1])
            return asked[0] * (asked[-1] > 0), [], []

        clock = SimpleNamespace(monotonic=itertools.count(0.0, 0.375).__next__)
        files = SimpleNamespace(
            write=lambda _, text: sent.append(text), read=lambda *_: next(parts)
        )
        monkeypatch.setattr(options, "os", files)
        monkeypatch.setattr(options, "time", clock)
        monkeypatch.setattr(options, "select", SimpleNamespace(select=select))
        monkeypatch.setattr(options, "key_by_key", lambda _: nullcontext(can_wait))
        return options.background(), sent, waits

    return ask


@pytest.mark.parametrize(
    ("colour", "ground"),
    [
        (b"rgb:ffff/ffff/ffff", "light"),
        (b"rgb:f/7/0", "light"),  # green is the brightest
        (b"rgb:0/9/f", "light"),
        (b"rgb:f/0/0", "dark"),
        (b"rgba:0000/8888/ffff", "dark"),
        (b"", None),
    ],
)
def test_the_background_is_what_the_terminal_answers(colour, ground, ask):
    answer = b"\x1b]11;" + colour + b"\x1b\\\x1b[?6c"
    assert ask(answer[:9], answer[9:]) == (ground, [b"\x1b]11;?\x1b\\\x1b[c"], [0.625, 0.25])


def test_a_terminal_that_does_not_answer_is_awaited_for_a_second(ask):
    _, _, waits = ask(b"\x1b", b"]")
    assert waits == [0.625, 0.25, 0.0]
    assert ask(can_wait=False) == (None, [], [])


def test_without_utf_8_all_is_ascii_and_reduced_motion_is_fewer_frames():
    usual = TerminalOptions("dark", "braille", mouse=True, fps=30)
    assert chosen(encoding="UTF_8") == TerminalOptions() == usual
    assert CHARACTER_SETS == ("braille", "half", "ascii")  # as a key takes them
    assert chosen("--fps 60").fps == 60
    assert chosen(encoding="latin-1").character_set == "ascii"
    assert chosen(TEXTUAL_ANIMATIONS="None").fps == 10


@pytest.mark.parametrize("text", ["59x16", "60x15", "401x200", "400x201", "80", "80x24x2"])
def test_a_screen_has_60x16_to_400x200_cells(text):
    assert [cells("60x16"), cells("400×200")] == [(60, 16), (400, 200)]
    with pytest.raises(ValueError, match="is not a size; use, for example, 120x40, from 60x16"):
        cells(text)


@pytest.mark.parametrize(
    "lacks", ["stdin", "stdout", "stderr", "TERM=", "TERM=dumb", "TERM=unknown"]
)
def test_the_lab_needs_a_terminal_for_all_that_it_reads_and_writes(lacks, monkeypatch):
    monkeypatch.setattr(options, "environment", lambda: {"TERM": lacks.removeprefix("TERM=")})
    for name in ("stdin", "stdout", "stderr"):
        terminal = SimpleNamespace(isatty=lambda is_one=name != lacks: is_one)
        monkeypatch.setattr(sys, name, terminal)
    why = rf"\({lacks}\)" if "TERM" in lacks else "not a term"
    with pytest.raises(UserError, match=why) as error:
        check_terminal()
    assert error.value.code == 4


@pytest.mark.parametrize("arguments", ["--fps 0", "--fps 61", "--fps 1.5", "--theme pink"])
def test_what_cannot_be_is_refused(arguments):
    with pytest.raises(UserError, match=arguments.split()[0]):
        chosen(arguments)
