"""`pendu-tui judge`: energies of other programs, from tables of any form."""

import io
import math
import shutil
import subprocess
import sys
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.tui.cli.errors import UserError
from pendu_tui.tui.cli.reader import read_sheets
from pendu_tui.tui.cli.tables import Wanted
from pendu_tui.tui.commands import judge as command
from tests.tui.command_line import Outcome, pendu

ROWS = [(n / 10, 100 + math.sin(n)) for n in range(300)]


def lines(form: str, rows: list[tuple[float, float]] = ROWS) -> str:
    return "".join(form.format(n=n, t=t, e=e) + "\n" for n, (t, e) in enumerate(rows))


TABLE = "t,E\n" + lines("{t},{e}")
WIDER = "t,E\n" + "".join(f"{t},1{',1' * (t > 29)}\n" for t in range(70))


def guess(text: str | bytes, *more: object) -> Outcome:
    Path("energies.csv").write_bytes(text.encode() if isinstance(text, str) else text)
    return pendu("judge", "energies.csv", *more)


def judge(text: str | bytes, *more: object, time="t", energy="E") -> Outcome:
    return guess(text, "--time", time, "--energy", energy, *more)


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


FIRST = [(t, e - 9) for t, e in ROWS[:200]]
LOG = "LAMMPS (2 Aug 2023)\nthermo_style custom step temp etotal\n   Step   Temp   TotEng\n"
LOG += lines("  {t:.1f} 300. {e!r}", FIRST) + "Loop time of 1 on 1 procs\n\n"
LOG += "Step TotEng Temp\n" + lines("  {t:.1f} {e!r} 300.") + "Loop time\n"


def test_one_table_is_judged_and_named():
    names = {"time": "Step", "energy": "TotEng"}
    log = LOG.replace("  15.0 ", "  15.0x ")
    words = "299 samples from 0 to 29.9, table 2 of 2; skipped: 1 row "
    assert words in judge(log, **names).out
    for skipped, code in ((0, 1), (1, 0)):
        gate = f"skipped > {skipped} or samples < 299"
        assert judge(log, "--fail-if", gate, **names).code == code
    answer = judge(LOG, "--json", "--table", 1, **names).json
    assert (answer["table"], answer["tables"], answer["samples"]) == (1, 2, 200)
    assert answer["energy_error"] == pytest.approx(math.sin(199) / 91)
    assert (answer["lowest_energy"], answer["highest_energy"]) == pytest.approx((90, 92), abs=1e-3)
    assert judge(LOG, "--table", 3, **names).refused(2, "no table 3; the input has 2")


def test_a_file_alone_is_listed_guessed_and_judged():
    outcome = guess(LOG)
    for words in ("table 1 ", "Step, TotEng, Temp", "TotEng over Step", "per step"):
        assert words in outcome.out
    answer = guess(LOG, "--json").json
    assert (answer["time"], answer["energy"], answer["is_guess"]) == ("Step", "TotEng", True)
    assert [each["rows"] for each in answer["seen"]] == [200, 300]
    assert answer["seen"][1]["columns"][2] == {"name": "Temp", "unit": ""}


@pytest.mark.parametrize(
    "text", ["t,E1,E2\n" + lines("{t},{e},{e}"), lines("t = {t}, E1 = {e}, E2 = {e}")]
)
def test_what_is_not_certain_is_listed_and_asked_for(text):
    outcome = guess(text)
    assert (outcome.code, "E1, E2" in outcome.out) == (2, True)
    assert outcome.err.startswith("pendu-tui: energies.csv: ")
    assert "--energy" in outcome.err
    assert guess(text, "--json").json["seen"][0]["energy"] == "row"
    assert guess(text, "--energy", "E2").code == 0


BODIES = "body,E\n" + "".join(f"{n % 3},-1.{n % 7}\n" for n in range(30))


@pytest.mark.parametrize("text", ["x,y,E\n" + lines("{t},{t},{e}"), BODIES])
def test_where_the_time_is_not_certain_nothing_is_judged(text):
    outcome = guess(text)
    assert (outcome.code, "which column is the time;" in outcome.err) == (2, True)


def test_an_error_below_the_last_row_is_shown():
    log = LOG + "ERROR: Lost atoms: original 648 current 612\n"
    assert "log ends      with ERROR: Lost atoms: original 648" in guess(log).out
    for more in (LOG, "  30.0 100.5 300.\n"):
        assert guess(log + more, "--json").json["log_error"] == ""


def test_rows_are_counted_where_a_column_is_only_a_flag_or_a_step_is_given():
    flags = "E,flag\n" + "".join(f"-1.{n % 7},{int(n % 9 == 0)}\n" for n in range(90))
    assert guess(flags, "--json").json["time"] == "row"
    assert guess(BODIES, "--json", "--step", "1fs").json["last_time"] == 29


def test_only_rows_in_the_range_of_time_are_judged():
    answer = judge(TABLE, "--json", "--from", 5, "--to", 20).json
    assert (answer["first_time"], answer["last_time"], answer["samples"]) == (5, 20, 151)
    assert judge(TABLE, "--from", 5, "--to", 4).refused(2, "no time from 5 to 4")
    assert judge(TABLE, "--from", "5fs").refused(2, "the unit of time is not known")
    assert judge(TABLE, "--from", "1e999").refused(2, "'1e999' is not a time")
    for unit, size, other, by in (("ps", 1, "fs", 1e3), ("fs", 1000, "ps", 1e-3)):
        table = f"t ({unit}),E\n" + lines("{t},{e}", [(t * size, e) for t, e in ROWS])
        cut = ("--from", f"{5 * size * by}{other}", "--to", f"{20 * size * by}{other}")
        answer = guess(table, *cut, "--json").json
        assert (answer["first_time"], answer["last_time"]) == (5 * size, 20 * size)
    assert judge(TABLE, "--to", "nan").refused(2, "nan")
    assert judge(TABLE, "--from", 50).refused(3, "from 0 to 29.9, none from 50")


def test_steps_and_units_give_a_trend_per_nanosecond_and_atom():
    text = "Step E\n" + lines("{n} {e}", [(t, e + t) for t, e in ROWS])
    asked = ("--step", "2fs", "--units", "energy=eV", "--atoms", 10, "--temperature", 300)
    answer = guess(text, "--json", *asked).json
    assert (answer["time_unit"], answer["energy_unit"]) == ("fs", "eV")
    assert answer["energy_per_ns_per_atom"] == pytest.approx(5000, rel=0.01)
    assert answer["kt_per_ns_per_atom"] == pytest.approx(5000 / 0.025852, rel=0.01)
    near = answer["absolute_bound"] / answer["absolute_trend"]
    for kind in ("energy", "kt"):
        trend = answer[f"{kind}_per_ns_per_atom"]
        assert answer[f"{kind}_bound_per_ns_per_atom"] == pytest.approx(near * trend)
        gate = f"{kind}_per_ns_per_atom > {(1 + near) / 2 * trend}"
        assert "cannot tell" in guess(text, *asked, "--fail-if", gate).err
    assert guess(text, "--atoms", 10).refused(2, "--step 0.5fs")
    assert guess(text, "--temperature", 5).refused(2, "belongs to --atoms")
    twice = ("--step", "0.5fs", "--units", "time=ps,energy=eV")
    assert guess(text, *twice).refused(2, "--step already gives", "leave time= out")
    assert guess(text, "--step", 2, "--units", "time=ps", "--json").json["time_unit"] == "ps"
    for option in (("--step", "0"), ("--step", "fs"), ("--temperature", "0", "--atoms", "9")):
        assert guess(text, *option).refused(2, option[0])


def test_relative_errors_are_taken_as_they_are():
    text = "t,dE/E\n" + lines("{t},{e}", [(t, 1e-6 * t) for t, _ in ROWS])
    assert guess(text, "--json").json["max_energy_error"] == pytest.approx(29.9e-6)


def test_hints_say_what_blurs_a_trend_or_an_error():
    spike = guess(lines("{n},{e}", [(n, n / 99 if n else 99) for n in range(300)])).out
    assert ("--scale std" in spike, "1 value far" in spike) == (False, True)
    around_zero = lines("{n},{e}", [(n, (n * 7919) % 13 - 6.5) for n in range(300)])
    assert "--scale std" in guess(around_zero).out


def test_rows_that_cannot_be_used_are_counted():
    bad = "x,1\n1,\n,1\n2\nnan,1\ninf,1\n29,1\n"
    answer = judge(TABLE + bad + "32,100.5\n", "--json", "--from", 10).json
    assert (answer["skipped"], answer["lowest_energy"]) == (7, pytest.approx(99, 1e-5))
    assert (answer["samples"], answer["first_time"], answer["diverged_at"]) == (201, 10.0, None)


def test_the_first_energy_that_is_infinite_or_too_large_has_failed():
    for end in ("-1e999", "-1.79769e+308"):
        text = f"{TABLE}30.0,{end}\n31.0,nan\n32,100\n"
        outcome = judge(text, "--json")
        answer = outcome.json
        assert (outcome.code, answer["verdict"], answer["samples"]) == (1, "failed", 300)
        assert (answer["diverged_at"], answer["skipped"]) == (30, 0)
        assert answer["lowest_energy"] > 0
    assert "end at 30" in judge(text).out
    kinetic = "t,E,K\n" + lines("{t},{e},5") + "30,100,nan\n"
    assert "end at 30" in guess(kinetic, "--scale", "kinetic:K").out
    for energy in ("inf", "1e305"):
        first = f"-0.1,{energy}\n{lines('{t},{e}')}"
        assert guess(first).refused(3, "--from")
        assert guess(first, "--from", 0).code == 0


def test_trends_have_the_units_of_the_heads():
    rows = [(n, 100 + n / 10 + (n * 7919) % 13 / 100) for n in range(200)]
    text = "Time (ps),E (eV),K\n" + lines("{t},{e},5", rows)
    answer = guess(text, "--json", "--atoms", 100).json
    assert (answer["verdict"], answer["trend_unit"]) == ("grows", "1/ps")
    assert answer["energy_per_ns_per_atom"] == pytest.approx(1.0, rel=1e-3)
    assert answer["absolute_trend"] == pytest.approx(0.1, rel=1e-3)
    assert "times the band" in guess(text).out
    assert "eV per ps" in guess(text).out
    assert "% of the band" in judge(TABLE).out


def test_scales():
    zero = "t,E,K\n" + "".join(f"{n},{n},{-3 - n % 2 * 2}\n" for n in range(100))
    assert judge(zero).refused(2, "first' is 0", "--scale")
    still = zero.replace(",-3", ",0").replace(",-5", ",0")
    assert judge(still, "--scale", "kinetic:K").refused(2, "is 0", "--scale")
    for scale, size in (("50", 50), ("kinetic:K", 4), ("std", np.std(range(100)))):
        error = judge(zero, "--json", "--scale", scale).json["max_energy_error"]
        assert error == pytest.approx(99 / size)


def test_units_that_contradict_the_file_are_refused():
    text = "t,E [kJ/mol],K [kcal/mol],P [units]\n" + lines("{t},{e},5,{e}")
    asked = ("--scale", "kinetic:K")
    assert guess(text, *asked).refused(2, "of K and the energy differ (kJ/mol, kcal/mol)")
    assert guess(text, "--units", "energy=eV").refused(2, "E is in kJ/mol, not in eV")
    given = ("--units", "energy=kJ/mol")
    assert guess(text.replace(" [kJ/mol]", ""), *asked, *given).refused(2, "(kJ/mol, kcal/mol)")
    for unit in (" [kJ/mole]", ""):
        assert guess(text.replace(" [kcal/mol]", unit), *asked, *given).code == 0
    assert guess(text, "--energy", "P", "--units", "energy=eV").code == 0


def test_the_fluctuation_of_a_second_order_method_goes_with_the_square_of_the_step():
    for step in (1, 2):
        rows = [(t, 100 + step**2 * (e - 100)) for t, e in ROWS]
        Path(f"{step}.csv").write_text("t,E\n" + lines("{t},{e}", rows))
    files = ("judge", "1.csv", "2.csv")
    answer = pendu(*files, "--steps", "1,2", "--json").json
    assert answer["fluctuation_order"] == pytest.approx(2, abs=1e-6)
    assert answer["drift_order"] is None
    outcome = pendu(*files, "--steps", "1,2", "--fail-if", "fluctuation_order > 1.8")
    assert (outcome.code, "in 2 of 2 files, " in outcome.err) == (1, True)
    assert "goes as h^2.00" in outcome.out
    assert "order of the files" not in outcome.out
    assert "order of the files" in pendu(*files, "--steps", "2,1").out
    assert pendu(*files, "--steps", "1,1").refused(2, "not all the same")
    Path("2.csv").write_text(TABLE + "30,nan\n")
    assert "fluctuation   no clear power" in pendu(*files, "--steps", "1,2").out


def test_a_gate_gives_the_values():
    gate = "max_energy_error > 0.001 and (trend < -1 or verdict == bounded)"
    outcome = judge(TABLE, "--fail-if", gate)
    assert outcome.code == 1
    assert "(max_energy_error is 0.01, verdict is bounded)" in outcome.err
    assert judge(TABLE, "--fail-if", "rk4.verdict == grows").refused(2, "is not understood")
    assert judge(TABLE, "--fail-if", "theta_error > 1").refused(2, "no field 'theta_error'")


PICKLES = io.BytesIO()
np.savez(PICKLES, t=np.arange(3.0), E=np.array([{}, {}, {}], dtype=object))


@pytest.mark.parametrize(
    ("data", "names", "code", "words"),
    [
        ("", "t E", 3, "no row of numbers"),
        (TABLE, "t E+Energy", 2, "there is no column 'Energy'; choose from t, E"),
        (TABLE.replace("E", "energy"), "t enrgy", 2, "'enrgy': did you mean energy?"),
        ("1 2\n", "1 2+", 2, "there is no column ''"),
        (WIDER, "1 2", 3, "the number of columns"),
        (TABLE, "1 3", 2, "there is no column '3'; choose from t, E"),
        ("1 2\n", "t E", 2, "choose from 1, 2"),
        (TABLE, "t E+t", 2, "t is both the time and an energy"),
        ("t,E\nnan,1\n", "t E", 3, "no row of numbers"),
        ("t,E\n0,nan\n1,inf\n2,nan\n", "t E", 3, "at 0 its energy is already nan"),
        ("t,E\n3,1\n2,1\n1,1\n", "t E", 3, "name the column of times"),
        ("t,E\n" + "".join(f"{t},{e}\n" for t in range(5) for e in "12"), "t E", 3, "grep"),
        ("t,E\n" + "".join(f'"{t:,}",{t}\n' for t in range(0, 1500, 99)), "t E", 3, "thousands"),
        (b"\x1f\x8b\x08\x00rest", "1 2", 3, "cannot be unpacked"),
        (b"\x89MCAP0\r\n\0", "1 2", 3, "not text"),
        (b"x" * (1 << 21), "1 2", 3, "longer than 1 MB"),
        (b"t,E\n" + b"y\n" * 1002, "1 2", 3, "lines without a row"),
        (PICKLES.getvalue(), "1 2", 3, "arrays cannot be read"),
        ("1,1\n" * 20_001, "1 2", 3, "more than"),
        ("1 2\n1\n" * 9, "1 2", 3, "more than 9 tables"),
        ('{"t": 1}\n' * 9000, "t E", 3, "more than"),
    ],
)
def test_what_cannot_be_judged_is_one_sentence(data, names, code, words, monkeypatch):
    for name, value in (
        ("LINES_BEFORE", 1000),
        ("LINES", 20_000),
        ("DOCUMENT", 80_000),
        ("TABLES", 9),
    ):
        monkeypatch.setattr(f"pendu_tui.tui.cli.reader.MAX_{name}", value)
    time, energy = names.split(" ")
    assert judge(data, time=time, energy=energy).refused(code, "energies.csv", words)


@pytest.mark.skipif(not shutil.which("bash"), reason="needs bash")
def test_stdin_is_read_where_it_is_open(monkeypatch):
    Path("energies.csv").write_text(TABLE)
    program = Path(sys.executable).with_name("pendu-tui")
    line = f"{program} judge - <&-; {program} judge - < energies.csv"
    done = subprocess.run(["bash", "-c", line], capture_output=True, text=True, check=False)
    assert done.stderr.startswith("pendu-tui: stdin: Bad file descriptor; give ")
    assert "stdin: 300 samples from 0 to 29.9" in done.stdout


def test_a_terminal_shows_a_chart_above_the_answer(monkeypatch):
    stdout = SimpleNamespace(isatty=lambda: True)
    monkeypatch.setattr(command, "sys", SimpleNamespace(stdout=stdout))
    shown = judge(TABLE).out
    assert shown.index("energy error relative to 100") < shown.index("energies.csv: 300 samples")
    assert "\n 0.015┤" in shown  # two standard deviations of this sine are 0.0141


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


def test_a_time_that_is_no_number_is_not_in_the_span_of_a_table():
    (table,) = guess("t,energy\nnan,-5\n1,-5\n2,-5.1\ninf,-5\n", "--json").json["seen"]
    assert (table["rows"], table["span"]) == (4, [1.0, 2.0])
