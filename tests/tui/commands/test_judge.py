"""`pendu-tui judge`: energies of other programs, from tables of any form."""

import io
import math
import shutil
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.tui.cli.errors import UserError
from pendu_tui.tui.cli.reader import read_sheets
from pendu_tui.tui.cli.tables import Series, Wanted
from tests.tui.command_line import Outcome, pendu

ROWS = [(n / 10, 100 + math.sin(n)) for n in range(300)]


def lines(form: str, rows: list[tuple[float, float]] = ROWS) -> str:
    return "".join(form.format(n=n, t=t, e=e) + "\n" for n, (t, e) in enumerate(rows))


def table(form: str = "{t},{e}", head: str = "t,E") -> str:
    return f"{head}\n{lines(form)}"


def read(data: str | bytes, time: str | None = None, energy: str | None = None) -> Series:
    """Return the last table, finished."""
    stream = io.BytesIO(data.encode() if isinstance(data, str) else data)
    sheets = read_sheets(io.BufferedReader(stream), Wanted(time, energy))
    found = [series for sheet in sheets for series in sheet.series() if sheet.choice]
    if not found:
        raise UserError("nothing")
    found[-1].finish()
    return found[-1]


def judge(text: str | bytes, *more: object, time="t", energy="E") -> Outcome:
    Path("energies.csv").write_bytes(text.encode() if isinstance(text, str) else text)
    return pendu("judge", "energies.csv", "--time", time, "--energy", energy, *more)


def guess(text: str, *more: object) -> Outcome:
    Path("energies.csv").write_text(text)
    return pendu("judge", "energies.csv", *more)


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


FIRST = [(t, e - 9) for t, e in ROWS[:200]]
LOG = "LAMMPS (2 Aug 2023)\nthermo_style custom step temp etotal\n   Step   Temp   TotEng\n"
LOG += lines("  {t:.1f} 300. {e!r}", FIRST) + "Loop time of 1 on 1 procs\n\n"
LOG += table("  {t:.1f} {e!r} 300.", "Step TotEng Temp") + "Loop time\n"


PICKLES = io.BytesIO()
np.savez(PICKLES, t=np.arange(3.0), E=np.array([{}, {}, {}], dtype=object))


def test_one_table_is_judged_and_named():
    names = {"time": "Step", "energy": "TotEng"}
    log = LOG.replace("  15.0 ", "  15.0x ")
    words = "299 samples from 0 to 29.9, table 2 of 2; skipped: 1 row without numbers"
    assert words in judge(log, **names).out
    for skipped, code in ((0, 1), (1, 0)):
        gate = f"skipped > {skipped} or samples < 299"
        assert judge(log, "--fail-if", gate, **names).code == code
    answer = judge(LOG, "--json", "--table", 1, **names).json
    assert (answer["table"], answer["tables"], answer["samples"]) == (1, 2, 200)
    assert answer["energy_error"] == pytest.approx(math.sin(199) / 91)
    assert (answer["lowest_energy"], answer["highest_energy"]) == pytest.approx((90, 92), abs=1e-3)
    assert judge(LOG, "--table", 2, **names).code == 0
    assert judge(LOG, "--table", 3, **names).refused(3, "no table 3; the input has 2")


def test_a_file_alone_is_listed_guessed_and_judged():
    outcome = guess(LOG)
    assert outcome.code == 0
    for words in ("table 1 ", "Step, TotEng, Temp", "time Step, energy TotEng", "--energy"):
        assert words in outcome.out
    answer = guess(LOG, "--json").json
    assert (answer["time"], answer["energy"], answer["is_guess"]) == ("Step", "TotEng", True)
    assert [each["rows"] for each in answer["seen"]] == [200, 300]
    assert answer["seen"][1]["columns"][2] == {"name": "Temp", "unit": ""}


def test_what_is_not_certain_is_listed_and_asked_for():
    text = table("{t},{e},{e}", "t,E1,E2")
    outcome = guess(text)
    assert outcome.code == 2
    assert "E1, E2" in outcome.out
    assert outcome.err.startswith("pendu-tui: energies.csv: ")
    assert "--energy" in outcome.err
    assert guess(text, "--json").json["seen"][0]["energy"] == "row"
    assert guess(text, "--energy", "E2").code == 0


def test_only_rows_in_the_range_of_time_are_judged():
    answer = judge(table(), "--json", "--from", 5, "--to", 20).json
    assert (answer["first_time"], answer["last_time"], answer["samples"]) == (5, 20, 151)
    assert judge(table(), "--from", 5, "--to", 4).refused(2, "no time from 5 to 4")
    assert judge(table(), "--to", "nan").refused(2, "nan")


def test_steps_and_units_give_a_trend_per_nanosecond_and_atom():
    text = "Step E\n" + lines("{n} {e}", [(t, e + t) for t, e in ROWS])
    asked = ("--step", "2fs", "--units", "energy=eV", "--atoms", 10, "--temperature", 300)
    answer = guess(text, "--json", *asked).json
    assert (answer["time_unit"], answer["energy_unit"]) == ("fs", "eV")
    assert answer["energy_per_ns_per_atom"] == pytest.approx(5000, rel=0.01)
    assert guess(text, "--atoms", 10).refused(2, "--step 0.5fs")
    for option in (("--step", "0"), ("--step", "fs"), ("--units", "ps"), ("--units", "mass=u")):
        assert guess(text, *option).refused(2, option[0])


def test_relative_errors_are_taken_as_they_are():
    text = "t,dE/E\n" + lines("{t},{e}", [(t, 1e-6 * t) for t, _ in ROWS])
    assert guess(text, "--json").json["max_energy_error"] == pytest.approx(29.9e-6)
    assert guess(text.replace("dE/E", "E")).refused(2, "first' is 0")


def test_only_energies_around_zero_are_advised_to_use_their_spread():
    spike = "".join(f"{n},{9 if n == 99 else 1 + n % 2 / 1000}\n" for n in range(300))
    around_zero = "".join(f"{n},{(n * 7919) % 13 - 6.5}\n" for n in range(300))
    names = {"time": "1", "energy": "2"}
    assert "--scale std" not in judge(spike, **names).out
    assert "--scale std" in judge(around_zero, **names).out


def test_rows_that_cannot_be_used_are_counted():
    bad = "x,1\n1,\n,1\n2\nnan,1\ninf,1\n29,1\n"
    answer = judge(table() + bad + "32,100.5\n", "--json", "--from", 10).json
    assert answer["skipped"] == {
        "without_numbers": 4,
        "energy_not_finite": 0,
        "time_not_finite": 2,
        "time_not_later": 1,
        "out_of_range": 100,
    }
    assert (answer["samples"], answer["first_time"], answer["diverged_at"]) == (201, 10.0, None)


@pytest.mark.parametrize("energy", ["nan", "-inf", "1e999"])
def test_the_first_energy_that_is_nan_or_inf_has_failed(energy):
    text = table() + f"30.0,{energy}\n31.0,{energy}\n32,100\n"
    outcome = judge(text, "--json")
    assert (outcome.code, outcome.json["verdict"], outcome.json["samples"]) == (1, "failed", 300)
    assert outcome.json["diverged_at"] == 30
    assert outcome.json["skipped"]["energy_not_finite"] == 3
    assert "end at 30" in judge(text).out
    first = f"-0.1,{energy}\n{lines('{t},{e}')}"
    assert judge(first, time="1", energy="2").refused(3, "--from")
    assert judge(first, "--from", 0, time="1", energy="2").code == 0


GROWING = "Time (ps),E (eV),K\n" + "".join(
    f"{n},{100 + n / 10 + (n * 7919) % 13 / 100},5\n" for n in range(200)
)


def test_trends_have_the_units_of_the_heads():
    names = {"time": "Time", "energy": "E"}
    atoms = ("--atoms", 100, "--temperature", 300)
    answer = judge(GROWING, "--json", *atoms, **names).json
    assert answer["verdict"] == "grows"
    assert (answer["trend_unit"], answer["energy_unit"]) == ("1/ps", "eV")
    assert answer["energy_per_ns_per_atom"] == pytest.approx(1.0, rel=1e-3)
    assert answer["kt_per_ns_per_atom"] == pytest.approx(1 / 0.025852, rel=1e-3)
    assert "times the band" in judge(GROWING, **names).out
    assert "% of the band" in judge(table()).out
    assert "kT per ns" in judge(GROWING, *atoms, **names).out
    assert judge(table(), "--atoms", 5).refused(2, "--atoms needs the unit of time")
    assert judge(GROWING, "--temperature", 5, **names).refused(2, "belongs to --atoms")


def test_with_a_scale_of_std_nothing_depends_on_the_zero_of_the_energies():
    gate = ("--fail-if", "trend > 0.05 and verdict == grows")
    answers = []
    for zero in (-100, 0, 1e5):
        text = "t,E\n" + lines("{t},{e:.9f}", [(t, e + t / 9 + zero) for t, e in ROWS])
        outcome = judge(text, "--scale", "std", "--json", *gate)
        assert (outcome.code, outcome.json["verdict"]) == (1, "grows")
        answers.append(outcome.json)
    for name in ("trend", "uncertainty", "max_energy_error"):
        values = [answer[name] for answer in answers]
        assert values == pytest.approx([values[0]] * 3, rel=1e-6)


def test_scales():
    zero = "t,E,K\n" + "".join(f"{n},{n},{-3 - n % 2 * 2}\n" for n in range(100))
    assert judge(zero).refused(2, "first' is 0", "--scale")
    still = zero.replace(",-3", ",0").replace(",-5", ",0")
    assert judge(still, "--scale", "kinetic:K").refused(2, "is 0", "--scale")
    for scale, size in (("50", 50), ("kinetic:K", 4)):
        assert judge(zero, "--json", "--scale", scale).json["max_energy_error"] == 99 / size


def test_the_fluctuation_of_a_second_order_method_goes_with_the_square_of_the_step():
    for step in (1, 2):
        rows = [(t, 100 + step**2 * (e - 100)) for t, e in ROWS]
        Path(f"{step}.csv").write_text("t,E\n" + lines("{t},{e}", rows))
    names = ("judge", "1.csv", "2.csv", "--time", "t", "--energy", "E")
    answer = pendu(*names, "--steps", "1,2", "--json").json
    assert answer["fluctuation_order"] == pytest.approx(2, abs=1e-6)
    assert answer["drift_order"] is None
    outcome = pendu(*names, "--steps", "1,2", "--fail-if", "fluctuation_order > 1.8")
    assert "fluctuation_order is 2.00 ± " in outcome.err + outcome.out
    assert outcome.code == 1
    assert "goes as h^2.00" in outcome.out
    assert "order of the files" not in outcome.out
    assert "order of the files" in pendu(*names, "--steps", "2,1").out
    assert pendu(*names, "--steps", "1,1").refused(2, "a step size for each")


@pytest.mark.parametrize(
    ("expression", "found"),
    [
        ("verdict != bounded", ""),
        (
            "max_energy_error > 0.001 and (trend < -1 or verdict == bounded)",
            "max_energy_error is 0.01, verdict is bounded",
        ),
    ],
)
def test_a_gate_gives_the_values(expression, found):
    outcome = judge(table(), "--fail-if", expression)
    assert outcome.code == bool(found)
    assert f"({found})" in outcome.err or not found


@pytest.mark.parametrize(
    ("text", "names", "code", "words"),
    [
        ("", "t E", 3, "the input is empty"),
        (table(), "t Energy", 2, "there is no column 'Energy'; choose from t, E"),
        (table(), "t E+Energy", 2, "there is no column 'Energy'; choose from t, E"),
        (table(head="time,energy"), "time enrgy", 2, "'enrgy': did you mean energy?"),
        (table(), "1 3", 3, "no row has a number in each column; columns count from 1"),
        ("1 2\n", "t E", 2, "give columns by number"),
        ("t,E\n1,nan\n", "t E", 3, "no row has a usable"),
        ("t,E\n3,1\n2,1\n1,1\n", "t E", 3, "its time never increases"),
        ("\x1b[31m,\x07\n", "t E", 3, "no row of numbers"),
        ("t,E\n" + "".join(f"{t},{e}\n" for t in range(5) for e in "123"), "t E", 3, "grep"),
    ],
)
def test_what_cannot_be_judged_is_one_sentence(text, names, code, words):
    times, energies = names.split(" ")
    assert judge(text, time=times, energy=energies).refused(code, words)


@pytest.mark.skipif(not shutil.which("bash"), reason="needs bash")
@pytest.mark.parametrize(
    ("end", "code", "word"), [("< energies.csv", 0, "bounded"), ("<&-", 3, "Bad file descr")]
)
def test_stdin_is_read_where_it_is_open(end, code, word):
    Path("energies.csv").write_text(table())
    program = Path(sys.executable).with_name("pendu-tui")
    line = f"{program} judge - --time t --energy E {end}"
    done = subprocess.run(["bash", "-c", line], capture_output=True, text=True, check=False)
    assert done.returncode == code
    assert word in done.stdout + done.stderr
    assert "Traceback" not in done.stderr


def test_a_file_or_a_gate_that_cannot_be_read_is_one_sentence():
    names = ("--time", "1", "--energy", "2")
    assert pendu("judge", "absent.csv", *names).refused(3, "absent.csv", "No such file")
    assert judge(table(), "--fail-if", "rk4.verdict == grows").refused(2, "write FIELD > NUMBER")
    assert judge(table(), "--fail-if", "theta_error > 1").refused(2, "no field 'theta_error'")


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"\x1f\x8b\x08\x00rest", "cannot be unpacked"),
        (b"PAR1rest", "Parquet"),
        (b"\x89MCAP0\r\nrest", "a recording"),
        (b"\0" * 5000, "not text"),
        (b"x" * (1 << 21), "longer than 1 MB"),
        (b"t,E\n" + b"y\n" * 1002, "lines without a row"),
        (PICKLES.getvalue(), "arrays cannot be read"),
        ("1,1\n" * 2001, "more than"),  # an input that never ends
    ],
)
def test_what_is_no_table_is_refused_within_bounds(data, words, monkeypatch):
    monkeypatch.setattr("pendu_tui.tui.cli.reader.MAX_LINES_BEFORE", 1000)
    monkeypatch.setattr("pendu_tui.tui.cli.reader.MAX_LINES", 2000)
    assert judge(data, time="1", energy="2").refused(3, words)


@given(
    st.binary(max_size=300) | st.text(st.sampled_from('0123456789.,;\t \n"#@tEnai-+'), max_size=300)
)
def test_any_input_is_columns_or_one_sentence(data):
    text = data if isinstance(data, str) else data.decode("utf-8", "replace")
    for names in (("1", "2"), ("t", "E")):
        sentence = ""
        columns: object = ((), ())
        try:
            read(text)
            found = read(text, *names)
            columns = (found.times, found.energies)
        except UserError as error:
            sentence = str(error)
        assert sentence == "" or sentence.isprintable()
        times, energies = columns
        assert len(times) == len(energies)
        assert all(map(math.isfinite, energies))
        assert all(a < b for a, b in pairwise(times))
