import io
import itertools
import math

import pytest
from rich.cells import cell_len
from rich.console import Console

from pendu_tui.tui.cli.errors import progress, warn
from pendu_tui.tui.commands.report import Column, Report, Table

ROWS = [
    {"method": "rk4", "error": 0.1 + 0.2, "why": f"it loses a little {60 * 'x'}"},
    {"method": "verlet", "error": None, "why": "\x1b[2J\u674e"},
]
COLUMNS = (Column("method", "method"), Column("largest", "error", ".2e"), Column("why", "why"))


def test_a_table_is_folded_to_the_terminal_and_keeps_every_word():
    on = Console(width=40, file=io.StringIO(), record=True)
    on.print(Table(COLUMNS, ROWS))
    table = on.export_text()
    assert max(cell_len(line) for line in table.splitlines()) <= 40
    assert (table.count("x"), table.count("little")) == (60, 1)


def test_json_has_no_nan(capsys):
    with pytest.raises(ValueError, match="not JSON compliant"):
        Report(name="test", fields={"value": math.nan}).show("json")
    assert capsys.readouterr().out == ""


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def shown(stream: io.StringIO, seconds_per_call: float, monkeypatch) -> str:
    clock = itertools.count(0, seconds_per_call)
    monkeypatch.setattr("sys.stderr", stream)
    monkeypatch.setattr("pendu_tui.tui.cli.errors.monotonic", lambda: next(clock))
    with progress("working") as show:
        for done in range(5):
            show(done, 5)
    return stream.getvalue()


def test_a_terminal_shows_a_bar_and_the_time_left_for_work_of_more_than_a_second(monkeypatch):
    bar = shown(Terminal(), 0.5, monkeypatch)
    assert "working" in bar
    assert "left" in bar
    assert shown(Terminal(), 0.1, monkeypatch) == ""
    assert shown(io.StringIO(), 0.5, monkeypatch) == ""


def test_a_sentence_on_a_terminal_is_wrapped_between_words_and_whole_elsewhere(monkeypatch, capsys):
    sentence = "the recording will be about 30 MB; --sample-every 4 would reduce it to a quarter."
    monkeypatch.setenv("COLUMNS", "30")
    warn(sentence)
    assert capsys.readouterr().err == f"pendu-tui: {sentence}\n"
    monkeypatch.setattr("sys.stderr", terminal := Terminal())
    warn(sentence)
    lines = terminal.getvalue().splitlines()
    assert (max(map(len, lines)) <= 30, " ".join(lines)) == (True, f"pendu-tui: {sentence}")
