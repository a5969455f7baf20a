import csv
import io
import itertools
import json
import math

import pytest
from rich.cells import cell_len
from rich.console import Console

from pendu_tui.tui.cli.errors import progress, warn
from pendu_tui.tui.commands.report import Column, Report, Table

ROWS = [
    {"method": "rk4", "error": 0.1 + 0.2, "why": "it loses a little energy at every step"},
    {"method": "verlet", "error": None, "why": "\x1b[2J\u674e"},
]
COLUMNS = (Column("method", "method"), Column("largest", "error", ".2e"), Column("why", "why"))


def report(**changes):
    usual = {"name": "test", "columns": COLUMNS, "rows": ROWS, "fields": {"methods": ROWS}}
    return Report(**(usual | changes))


def printed(report, form, capsys):
    report.show(form)
    return capsys.readouterr().out


def test_a_table_has_a_line_for_each_row_between_title_and_notes(capsys):
    more = Table([Column("twice", lambda h: 2 * h, "g")], [0.25])
    text = printed(report(title="a title", notes=["a note", more]), "table", capsys)
    title, head, first, second, *notes = [line.split() for line in text.splitlines()]
    assert (title, head[:2]) == (["a", "title"], ["method", "largest"])
    assert (first[:2], second[:2]) == (["rk4", "3.00e-01"], ["verlet", "-"])
    assert notes == [["a", "note"], ["twice"], ["0.5"]]
    assert "\x1b" not in text  # no cell steers the terminal


def test_a_table_is_folded_to_the_terminal_and_keeps_every_word():
    on = Console(width=40, file=io.StringIO(), record=True)
    on.print(Table(COLUMNS, ROWS))
    table = on.export_text()
    assert max(cell_len(line) for line in table.splitlines()) <= 40
    assert all(word in table for word in ("rk4", *ROWS[0]["why"].split()))


def test_json_is_one_object_with_a_schema(capsys):
    found = json.loads(printed(report(version=2), "json", capsys))
    assert found == {"schema": "pendu.test/2", "methods": ROWS}
    with pytest.raises(ValueError, match="not JSON compliant"):
        report(fields={"value": math.nan}).show("json")
    assert capsys.readouterr().out == ""


def test_csv_has_a_line_for_each_row_and_numbers_that_read_back_the_same(capsys):
    read = list(csv.DictReader(io.StringIO(printed(report(), "csv", capsys))))
    assert float(read[0]["error"]) == ROWS[0]["error"]
    assert read[1] == {key: "" if value is None else value for key, value in ROWS[1].items()}
    assert printed(report(records=iter([{"a": 1}, {"a": 2}])), "csv", capsys) == "a\n1\n2\n"


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
