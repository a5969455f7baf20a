import io
import math
from types import SimpleNamespace

import pytest
from rich.cells import cell_len
from rich.console import Console

from pendu_tui.tui.commands import report
from pendu_tui.tui.commands.report import Column, Report, Table

ROWS = [
    {"method": "velocity verlet", "error": 0.1 + 0.2, "why": f"it loses a little {60 * 'x'}"},
    {"method": "verlet", "error": None, "why": "\x1b[2J\u674e"},
]
COLUMNS = (Column("method", "method"), Column("largest", "error", ".2e"), Column("why", "why"))


def test_a_table_is_folded_to_the_terminal_and_keeps_every_word():
    on = Console(width=30, file=io.StringIO(), record=True)
    on.print(Table(COLUMNS, ROWS))
    table = on.export_text()
    assert max(cell_len(line) for line in table.splitlines()) <= 30
    assert "velocity verlet " in table
    assert (table.count("x"), table.count("little")) == (60, 1)


@pytest.mark.parametrize(("is_terminal", "width"), [(True, 33), (False, 240)])
def test_a_table_is_as_wide_as_the_terminal_if_there_is_one(is_terminal, width, monkeypatch):
    stdout = SimpleNamespace(isatty=lambda: is_terminal)
    monkeypatch.setattr(report, "sys", SimpleNamespace(stdout=stdout))
    monkeypatch.setenv("COLUMNS", "33")
    assert report.console(240).width == width


def test_json_has_no_nan(capsys):
    with pytest.raises(ValueError, match="not JSON compliant"):
        Report(name="test", fields={"value": math.nan}).show("json")
    assert capsys.readouterr().out == ""
