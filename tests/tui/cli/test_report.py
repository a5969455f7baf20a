import csv
import io
import itertools
import json
import math

import pytest
from rich.cells import cell_len
from rich.console import Console

from tui.cli.report import Column, Report, Table, progress, warn

ROWS = [
    {"method": "rk4", "error": 0.1 + 0.2, "why": "it loses a little energy at every step"},
    {"method": "verlet", "error": None, "why": "\x1b[2J\u674e"},
]
COLUMNS = (Column("method", "method"), Column("largest", "error", ".2e"), Column("why", "why"))


def report(**changes):
    return Report(
        **{"name": "test", "columns": COLUMNS, "rows": ROWS, "fields": {"methods": ROWS}, **changes}
    )


def printed(report, form, capsys):
    report.show(form)
    return capsys.readouterr().out


def test_a_table_has_a_line_for_each_row_between_title_and_notes(capsys):
    lines = printed(report(title="a title", notes=["a note"]), "table", capsys).splitlines()
    assert (lines[0], lines[-1]) == ("a title", "a note")
    assert [line.split()[:2] for line in lines[1:-1]] == [
        ["method", "largest"],
        ["rk4", "3.00e-01"],
        ["verlet", "-"],
    ]


def test_no_cell_steers_the_terminal(capsys):
    assert "\x1b" not in printed(report(), "table", capsys)


def test_a_note_may_be_a_table_of_its_own(capsys):
    more = Table(
        [Column("h", "h", ".3g"), Column("twice", lambda row: str(2 * row["h"]), right=True)],
        [{"h": 0.25}],
    )
    assert printed(report(notes=[more]), "table", capsys).splitlines()[-1].split() == [
        "0.25",
        "0.5",
    ]


@pytest.mark.parametrize("columns", [40, 60, 80])
def test_a_table_is_folded_to_the_terminal_and_keeps_every_word(columns):
    on = Console(width=columns, file=io.StringIO(), record=True)
    on.print(Table(COLUMNS, ROWS))
    table = on.export_text()
    assert max(cell_len(line) for line in table.splitlines()) <= columns
    assert all(word in table for word in ("rk4", *ROWS[0]["why"].split()))


def test_json_is_one_object_with_a_schema(capsys):
    assert json.loads(printed(report(version=2), "json", capsys)) == {
        "schema": "pendu.test/2",
        "methods": ROWS,
    }


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_json_refuses_numbers_that_are_not_finite(value, capsys):
    with pytest.raises(ValueError, match="not JSON compliant"):
        report(fields={"value": value}).show("json")
    assert capsys.readouterr().out == ""


def test_csv_has_a_line_for_each_row_and_numbers_that_read_back_the_same(capsys):
    read = list(csv.DictReader(io.StringIO(printed(report(), "csv", capsys))))
    assert float(read[0]["error"]) == ROWS[0]["error"]
    assert read[1] == {key: "" if value is None else value for key, value in ROWS[1].items()}


def test_csv_of_other_records_than_the_rows(capsys):
    assert printed(report(records=iter([{"a": 1}, {"a": 2}])), "csv", capsys) == "a\n1\n2\n"
    assert printed(report(records=()), "csv", capsys) == ""


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def shown(stream: io.StringIO, seconds_per_call: float, monkeypatch) -> str:
    clock = itertools.count(0, seconds_per_call)
    monkeypatch.setattr("sys.stderr", stream)
    monkeypatch.setattr("tui.cli.report.monotonic", lambda: next(clock))
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
    sentence = (
        "the recording will be about 30 MB; --sample-every 4 would reduce it to a quarter of that."
    )
    monkeypatch.setenv("COLUMNS", "30")
    warn(sentence)
    assert capsys.readouterr().err == f"pendu-tui: {sentence}\n"
    monkeypatch.setattr("sys.stderr", terminal := Terminal())
    warn(sentence)
    lines = terminal.getvalue().splitlines()
    assert (max(map(len, lines)) <= 30, " ".join(lines)) == (True, f"pendu-tui: {sentence}")
