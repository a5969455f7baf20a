"""How sentences and progress are shown."""

import io
import itertools

from pendu_tui.tui.cli.errors import progress, say, warn


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def shown(stream: io.StringIO, seconds_per_call: float, monkeypatch) -> str:
    clock = itertools.count(0, seconds_per_call)
    monkeypatch.setattr("sys.stderr", stream)
    monkeypatch.setattr("pendu_tui.tui.cli.errors.monotonic", lambda: next(clock))
    with progress("[b]working") as show:
        for done in range(5):
            show(done, 5)
    return stream.getvalue()


def test_a_terminal_shows_a_bar_and_the_time_left_for_work_of_more_than_a_second(monkeypatch):
    bar = shown(Terminal(), 0.5, monkeypatch)
    assert all(words in bar for words in ("[b]working", " 80%", "left"))
    assert bar.endswith("\x1b[2K")  # it goes at the end
    assert bar.count("\x1b[?25l") == 1
    assert shown(Terminal(), 0.1, monkeypatch) == ""
    assert shown(io.StringIO(), 0.5, monkeypatch) == ""


def test_a_sentence_on_a_terminal_is_wrapped_between_words_and_whole_elsewhere(monkeypatch, capsys):
    sentence = f"{'x' * 30}.mcap would be reduced by --sample-every 4 to a quarter of its size."
    monkeypatch.setenv("COLUMNS", "30")
    warn(sentence.replace("reduced ", "reduced\n"))
    assert capsys.readouterr().err == f"pendu-tui: {sentence}\n"
    terminal = Terminal()
    monkeypatch.setattr("sys.stderr", terminal)
    warn(sentence)
    lines = terminal.getvalue().splitlines()
    assert (len(lines), " ".join(lines)) == (5, f"pendu-tui: {sentence}")
    say(f"\x1b[2J\n{1001 * '1'}")
    assert capsys.readouterr().out == f"\N{REPLACEMENT CHARACTER}[2J\n{999 * '1'}…\n"
