"""`pendu-tui judge`: energies of other programs, from tables of any form."""

import io
import math
import os
import shlex
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.tui.cli.errors import UserError
from pendu_tui.tui.cli.reader import read_sheets
from pendu_tui.tui.cli.tables import Wanted
from pendu_tui.tui.commands import judge as command
from tests.tui.command_line import pendu, shortened

pytestmark = pytest.mark.usefixtures("here")
ROWS = [(n / 10, 100 + math.sin(n)) for n in range(300)]


def lines(form: str, rows: list[tuple[float, float]] = ROWS) -> str:
    return "".join(form.format(n=n, t=t, e=e) + "\n" for n, (t, e) in enumerate(rows))


TABLE = "t,E\n" + lines("{t},{e}")


FIRST = [(t, e - 9) for t, e in ROWS[:200]]
LOG = "LAMMPS (2 Aug 2023)\nthermo_style custom step temp etotal\n   Step   Temp   TotEng\n"
LOG += lines("  {t:.1f} 300. {e!r}", FIRST) + "Loop time of 1 on 1 procs\n\n"
LOG += "Step TotEng Temp\n" + lines("  {t:.1f} {e!r} 300.") + "Loop time\n"
FILES = {
    "md.log": LOG.replace("  15.0 ", "  15.0x "),
    "lost.log": LOG + f"ERROR: Lost atoms: original 648 current 612{99 * '!'}\n",
    "again.log": LOG + "ERROR: Lost atoms: original 648 current 612\n" + LOG,
    "table.csv": TABLE,
    "both.log": f"{LOG}\nStep Temp Press\n" + lines("{n} {e} {e}"),
    "printed.txt": lines("t = {t}, E1 = {e}, E2 = {e}"),
    "errors.csv": "t,dE/E\n"
    + lines("{t},{e}", [(t, 1e-6 * (e - 100) + (t == 9)) for t, e in ROWS]),
    "steps.txt": "Step E\n" + lines("{n} {e}", [(t, e + t) for t, e in ROWS]),
    "faster.txt": "Step E\n" + lines("{n} {e}", [(t, 4 * e - 300 + 2 * t) for t, e in ROWS]),
    "units.csv": "Time (ps),E (eV),K\n" + lines("{t},{e},-{n}", [(t, e + t) for t, e in ROWS]),
    "mixed.csv": "t,E [kJ/mol],K [kJ/mole],P [units of a great length]\n" + lines("{t},{e},5,{e}"),
    "zero.csv": "t,E\n" + lines("{n},{e}", [(n, (n * 7919) % 13 - 6.5) for n in range(300)]),
    "spike.csv": "t,E\n"
    + lines("{n},{e}", [(n, {0: 16, 9: 6}.get(n, n / 99)) for n in range(300)]),
    "settled.csv": "t,E\nps,eV\n"
    + lines("{t},{e}", [(t, e + 99 * math.exp(-9 * t)) for t, e in ROWS]),
    "failed.csv": TABLE + "30.0,-1e999\n31.0,nan\n32,100\n",
    "ended.csv": TABLE + TABLE + "nan,nan\n",
    "huge.csv": "t,E\n" + lines("{t},-{e}e200"),
    "steep.csv": "t,E\n" + lines("{t}e-99,{e}", [(t, 1e290 * (1 + t)) for t, _ in ROWS]),
    "tables.log": 31 * "Step TotEng\n1 2\n2 3\nLoop time\n",
    "columns.csv": ",".join(f"c{n}" for n in range(31)) + "\n" + 2 * (30 * "1," + "2\n"),
    "cold.csv": "t,E,K\n" + lines("{t},{e},5") + "30,100,nan\n",
    **{
        name: "t,E\n"
        + lines("{t},{e}", [(n, 100 + 4 * math.cos(3 * n) + rise * n) for n in range(300)])
        for name, rise in (("coarse.csv", 0.0), ("falling.csv", -0.01), ("falls.csv", -0.02))
    },
}
PER_ATOM = "--step 2fs --units energy=eV --atoms 10 --temperature 300"
PRINTED = f"""\
md.log
md.log --table 1 --time Step --energy TotEng --json
lost.log --fail-if 'max_energy_error > 0.001 and (trend < -1 or verdict == bounded)'
again.log --table 3
table.csv --time 1 --energy E --from 5 --to 20 --fail-if 'skipped > 0 or samples < 151'
table.csv --table 1 --time t --from 5 --to 20 --fail-if 'samples > 150'
table.csv --energy E+Energy --units time=ps
both.log
tables.log
columns.csv
printed.txt
printed.txt --json
printed.txt --energy E2
errors.csv
steps.txt --step 2 --units time=ps
steps.txt {PER_ATOM} --fail-if 'energy_per_ns_per_atom > 5005 or skipped > 0'
steps.txt {PER_ATOM} --fail-if 'kt_per_ns_per_atom > 194000'
steps.txt faster.txt --steps 1,2 --atoms 10 --step 1fs --units energy=eV --json
units.csv --atoms 100 --from 5000fs
units.csv --scale kinetic:K
mixed.csv --scale kinetic:K
mixed.csv --energy P --units energy=eV
mixed.csv --energy P
zero.csv
zero.csv --scale std
zero.csv --scale 50
settled.csv
ended.csv
huge.csv
cold.csv --scale kinetic:K
steps.txt --to 0 --atoms 10 --step 1fs --units energy=eV
table.csv coarse.csv --steps 1,2 --fail-if 'fluctuation_order < 2.02'
table.csv coarse.csv --steps 1,1.02 --fail-if 'fluctuation_order < 50'
coarse.csv table.csv --steps 1,2 --energy E --fail-if 'fluctuation_order < 0'
table.csv failed.csv --steps 1,2
spike.csv table.csv --steps 1,2
steep.csv steep.csv --steps 1,2
falling.csv falls.csv --steps 1,2
"""


def test_answers_as_they_are_stored(snapshot):
    for name, text in FILES.items():
        Path(name).write_text(text, encoding="utf-8")
    texts = []
    for line in PRINTED.splitlines():
        outcome = pendu("judge", *shlex.split(line))
        texts.append(f"$ judge {line}\n{outcome.out}[{outcome.code}] {outcome.err}")
    snapshot("judge.txt", shortened("\n".join(texts)))


UNITS = "t,E [kJ/mol],K [kcal/mol]\n" + lines("{t},{e},5")
UNIT_GIVEN = "t E --scale kinetic:K --units energy=kJ/mol"
WIDE = f"t,{50 * 'E'}{20 * ',n'}\n1{21 * ',1'}\n"


@pytest.mark.parametrize(
    ("data", "names", "code", "words"),
    [
        ("", "t E", 3, "no rows of numbers"),
        (WIDE, f"t {50 * 'x'}", 2, f"{39 * 'x'}…'; choose from t, {39 * 'E'}…{18 * ', n'}."),
        (TABLE.replace("E", "energy"), "t enrgy", 2, "'enrgy': did you mean energy?"),
        ("1 2\n", "1 2+", 2, "there is no column ''"),
        ("1 2\n", "1 3", 2, "there is no column '3'; choose from 1, 2."),
        (TABLE, "t E --table 2", 2, "no table 2; the input has 1"),
        (TABLE, "t E --atoms 10", 2, "--step 0.5fs"),
        ("t,E\n0,0\n1,1\n", "t E", 2, "scale = 'first' is 0; give a typical energy"),
        (UNITS, "t E --scale kinetic:K", 2, "of K and the energy differ (kJ/mol, kcal/mol)"),
        (UNITS.replace(" [kJ/mol]", ""), UNIT_GIVEN, 2, "(kJ/mol, kcal/mol)"),
    ],
)
def test_what_cannot_be_judged_is_one_sentence(data, names, code, words):
    time, energy, *more = names.split(" ")
    Path("energies.csv").write_bytes(data.encode() if isinstance(data, str) else data)
    outcome = pendu("judge", "energies.csv", "--time", time, "--energy", energy, *more)
    assert outcome.refused(code, "energies.csv", words)


def test_stdin_is_read_where_it_is_open():
    Path("energies.csv").write_text(TABLE)
    stdin = os.dup(0)
    try:
        with Path("energies.csv").open() as file:
            os.dup2(file.fileno(), 0)
        assert pendu("judge", "-").out.startswith("stdin: 300 samples from 0 to 29.9")
        os.close(0)
        assert pendu("judge", "-").refused(3, "stdin: ", "; give a log")
    finally:
        os.dup2(stdin, 0)
        os.close(stdin)


def test_a_terminal_shows_a_chart_above_the_answer(snapshot, monkeypatch):
    Path("units.csv").write_text(FILES["units.csv"], encoding="utf-8")
    stdout = SimpleNamespace(isatty=lambda: True)
    monkeypatch.setattr(command, "sys", SimpleNamespace(stdout=stdout))
    snapshot("judge-chart.txt", pendu("judge", "units.csv").out)
    for height, rows in ((12, 10), (25, 15), (40, 20)):  # with room for the answer
        monkeypatch.setenv("LINES", str(height))
        chart, _, _ = pendu("judge", "units.csv").out.partition("units.csv")
        assert chart.count("\n") == rows
    monkeypatch.setattr(command, "_chart", None)
    assert pendu("judge", "units.csv", "--json").json


@given(
    st.binary(max_size=300) | st.text(st.sampled_from('0123456789.,;\t \n"#@tEnai-+'), max_size=300)
)
def test_any_input_is_columns_or_one_sentence(data):
    stream = data if isinstance(data, bytes) else data.encode()
    for wanted in (Wanted(), Wanted("1", "2"), Wanted("t", "E")):
        found = []
        sentence = "none"
        try:
            for sheet in read_sheets(io.BufferedReader(io.BytesIO(stream)), wanted):
                found += sheet.series() if sheet.choice else []
            for series in found:
                series.finish()
        except UserError as error:
            sentence = str(error)
            found = []
        assert sentence.isprintable()
        for series in found:
            assert all(map(math.isfinite, series.energies))
            assert all(a < b for a, b in pairwise(series.times))
