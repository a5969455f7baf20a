import io
import math

import pytest
from rich.cells import cell_len
from rich.console import Console

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
