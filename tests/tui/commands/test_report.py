import io
import math
from functools import partial

import pytest
from rich.cells import cell_len
from rich.console import Console

from pendu_tui.tui.commands import report
from pendu_tui.tui.commands.report import Column, Report

ROWS = [
    {"method": "velocity verlet", "error": 0.1 + 0.2, "why": f"it loses a little {60 * 'x'}"},
    {"method": "verlet", "error": None, "why": ":bug:[b]\u674e"},
]
COLUMNS = (Column("method", "method"), Column("largest", "error", ".2e"), Column("why", "why"))


@pytest.mark.parametrize(("is_terminal", "width"), [(True, 30), (False, 105)])
def test_a_table_is_folded_to_the_terminal_and_keeps_every_word(is_terminal, width, monkeypatch):
    out = io.StringIO()
    out.isatty = lambda: is_terminal
    monkeypatch.setattr("sys.stdout", out)
    usual = partial(Console, height=9, color_system=None, legacy_windows=False)
    monkeypatch.setattr(report, "Console", lambda width, **more: usual(width=width or 30, **more))
    Report(name="test", columns=COLUMNS, rows=ROWS, fields={}).show("table")
    table = out.getvalue()
    assert max(cell_len(line.rstrip()) for line in table.splitlines()) == width
    assert "velocity verlet " in table
    assert (":bug:[b]" in table) != is_terminal
    assert (table.count("x"), table.count("little")) == (60, 1)


def test_json_has_no_nan(capsys):
    with pytest.raises(ValueError, match="not JSON compliant"):
        Report(name="test", fields={"value": math.nan}).show("json")
    assert capsys.readouterr().out == ""
