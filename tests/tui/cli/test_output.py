import io
import itertools
import math

import pytest
from rich.console import Console

from tui.cli.output import print_table, progress, warn, write_json


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_json_refuses_numbers_that_are_not_finite(value, capsys):
    with pytest.raises(ValueError, match="not JSON compliant"):
        write_json("test", {"value": value})
    assert capsys.readouterr().out == ""


def test_a_table_in_a_pipe_has_room_for_every_column(capsys):
    print_table("lr", ("name", "number"), [("x" * 150, "1"), ("y", "23")])
    lines = capsys.readouterr().out.splitlines()
    assert lines[1].startswith("x" * 150)
    assert [line[-2:] for line in lines] == ["er", " 1", "23"]


def shown(stream: io.StringIO, seconds_per_call: float, monkeypatch) -> str:
    clock = itertools.count(0, seconds_per_call)
    monkeypatch.setattr("sys.stderr", stream)
    monkeypatch.setattr("tui.cli.output.monotonic", lambda: next(clock))
    with progress("working") as show:
        for done in range(5):
            show(done, 5)
    return stream.getvalue()


def test_work_of_more_than_a_second_shows_a_bar_and_the_time_left_on_a_terminal(monkeypatch):
    bar = shown(Terminal(), 0.5, monkeypatch)
    assert "working" in bar
    assert "left" in bar


def test_work_of_less_than_a_second_shows_no_bar(monkeypatch):
    assert shown(Terminal(), 0.1, monkeypatch) == ""


def test_in_a_pipe_there_is_no_bar(monkeypatch):
    assert shown(io.StringIO(), 10.0, monkeypatch) == ""


def test_where_there_is_no_terminal_a_sentence_says_what_takes_over_two_minutes_and_only_once(monkeypatch):
    assert shown(io.StringIO(), 20.0, monkeypatch) == (
        "pendu-tui: working will take about 3 minutes more; an interrupt (Ctrl+C) ends it.\n"
    )
    assert shown(io.StringIO(), 2.0, monkeypatch) == ""


@pytest.mark.parametrize(("width", "left_out"), [(48, 2), (60, 1), (80, 0)])
def test_a_table_fits_the_terminal_by_leaving_out_columns_and_breaks_no_word(monkeypatch, capsys, width, left_out):
    monkeypatch.setattr("tui.cli.output.console", lambda piped: Console(width=width, highlight=False))
    headers = ("method", "energy error", "largest of all steps", "why", "also called")
    row = ("Symplectic Euler", "+1.0e+00", "2.25e-01", "still 1.2e-02 after 828 evaluations", "semi-implicit Euler")
    print_table("lrrll", headers, [row])
    told = capsys.readouterr().out
    table, _, left = told.partition("Only in a wider terminal, or with --json: ")
    assert " ".join(left.split()) == ", ".join(headers[5 - left_out :]) + "." * bool(left_out)
    assert max(len(line.rstrip()) for line in table.splitlines()) <= width
    words = [word for text in (*headers[: 5 - left_out], *row[: 5 - left_out]) for word in text.split()]
    assert sorted(table.split()) == sorted(words)


def test_a_sentence_on_a_terminal_is_wrapped_between_words_and_whole_elsewhere(monkeypatch, capsys):
    sentence = "the recording will be about 30 MB; --sample-every 4 would reduce it to a quarter of that."
    monkeypatch.setenv("COLUMNS", "30")
    warn(sentence)
    assert capsys.readouterr().err == f"pendu-tui: {sentence}\n"
    monkeypatch.setattr("sys.stderr", terminal := Terminal())
    warn(sentence)
    lines = terminal.getvalue().splitlines()
    assert (max(map(len, lines)) <= 30, " ".join(lines)) == (True, f"pendu-tui: {sentence}")
