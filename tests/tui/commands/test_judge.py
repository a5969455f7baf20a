import io
import math
import subprocess
import sys
import time
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tui.command_line import pendu
from tui.cli.columns import Table, read_table
from tui.cli.errors import UserError

ROWS = [(n / 10, 100 + math.sin(n)) for n in range(300)]


def table(delimiter: str = ",", header: str = "t,E", end: str = "\n") -> str:
    return header + end + "".join(f"{t!r}{delimiter}{energy!r}{end}" for t, energy in ROWS)


def read(data: str | bytes, *wanted: str, **how: float) -> Table:
    stream = io.BytesIO(data.encode() if isinstance(data, str) else data)
    return read_table(io.BufferedReader(stream), wanted, **how)


def judge(text: str | bytes, *more: object, time: str = "t", energy: str = "E") -> object:
    Path("energies.csv").write_bytes(text.encode() if isinstance(text, str) else text)
    return pendu("judge", "energies.csv", "--time", time, "--energy", energy, *more)


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


XVG = '# by gmx energy\n@ title "E"\n@    xaxis  label "Time (ps)"\n@TYPE xy\n@ s0 legend "Potential"\n'
XVG += '@ s1 legend "Total Energy"\n' + "".join(
    f"  {t:.6f}  -3.0  {energy!r}\n" for t, energy in ROWS
)
LOG = "LAMMPS (2 Aug 2023)\nthermo_style custom step temp etotal\n   Step   Temp   TotEng\n"
LOG += (
    "".join(f"  {t:.1f} 300. {energy - 9!r}\n" for t, energy in ROWS[:200])
    + "Loop time of 1 on 1 procs\n\n"
)
LOG += (
    "Step TotEng Temp\n"
    + "".join(f"  {t:.1f} {energy!r} 300.\n" for t, energy in ROWS)
    + "Loop time\n"
)


@pytest.mark.parametrize(
    ("text", "names", "skipped"),
    [
        (table(), ("t", "E"), 0),
        (table(), ("1", "2"), 0),
        (table(), ("T", "2"), 0),
        (table(end="\r\n"), ("t", "E"), 0),
        ("\ufeff" + table(), ("t", "E"), 0),
        (table("\t", '"t"\t"E"'), ("t", "E"), 0),
        (table(";", "t;E").replace(".", ","), ("t", "E"), 0),
        (table(" ; ", "t [s] ; E (kJ/mol)"), ("t", "e"), 0),
        (table(",", '"time, s","energy, J"'), ("time, s", "energy, J"), 0),
        (table(",", "t,E\ns,J"), ("t", "E"), 0),
        (table("   ", "  t    E"), ("t", "E"), 0),
        (table(" ", "# t, E"), ("t", "E"), 0),
        (table(" ", "# a remark"), ("1", "2"), 0),
        (table(" ", "").lstrip(), ("1", "2"), 0),
        (table().replace("\n", "\n\n# remark\n"), ("t", "E"), 0),
        ("".join(f'"{t!r}","{energy!r}"\n' for t, energy in ROWS), ("1", "2"), 0),
        (XVG, ("1", "Total Energy"), 0),
        (XVG, ("Time", "total energy"), 0),
        (XVG, ("1", "3"), 0),
    ],
)
def test_a_table_is_read_whatever_its_form(text, names, skipped):
    found = read(text, *names)
    assert list(zip(*found.columns, strict=True)) == ROWS
    assert sum(found.skipped.values()) == skipped
    answer = judge(text, "--json", time=names[0], energy=names[1]).json
    assert (answer["samples"], answer["verdict"], answer["first_energy"]) == (300, "bounded", 100.0)


def test_fortran_writes_its_exponents_with_a_d():
    found = read("t E\n0.0D0 1.5D+02\n1.0d-1 1.5d+02\n", "t", "E")
    assert [list(column) for column in found.columns] == [[0.0, 0.1], [150.0, 150.0]]


CP2K = (
    "#   Step Nr.     Time[fs]     Kin.[a.u.]     Pot.[a.u.]     Cons Qty[a.u.]     UsedTime[s]\n"
)
CP2K += "".join(f"  {n}  {n / 2}  0.5  -17.5  {-17 + n / 8}  1.0\n" for n in range(9))
LINES = '{"t": 0, "E": 1.5}\n{"t": 1, "E": 1.5, "x": null}\n\nrubbish\n{"t": 2, "E": "1.5"}\n'
MDOUT = "  4.  RESULTS\n"
for ps in range(3):
    MDOUT += f" NSTEP = {ps * 500:8} TIME(PS) =  {ps:.3f} TEMP(K) = 300.38 PRESS =     0.0\n"
    MDOUT += (
        " Etot   =  -5606.5 EKtot   =   1234.5 EPtot      =  -6841.0\n 1-4 NB =  1.0\n ------\n"
    )
MDOUT += "   A V E R A G E S   O V E R 3 S T E P S\n NSTEP = 1 TIME(PS) = 9.0 TEMP(K) = 1\n Etot = 0 EKtot = 1\n"
NPZ = io.BytesIO()
np.savez(NPZ, time=np.arange(3.0), E=np.full(3, 1.5))


@pytest.mark.parametrize(
    ("data", "names", "units", "times", "energies"),
    [
        (
            CP2K,
            ("Time", "Cons Qty[a.u.]"),
            ("fs", "a.u."),
            [n / 2 for n in range(9)],
            [-17 + n / 8 for n in range(9)],
        ),
        (CP2K, ("step nr.", "Kin.+Pot."), ("", "a.u."), list(range(9)), [-17.0] * 9),
        (CP2K, ("Time", "Pot."), ("fs", "a.u."), [n / 2 for n in range(9)], [-17.5] * 9),
        (LINES, ("t", "E"), ("", ""), [0, 1, 2], [1.5] * 3),
        (MDOUT, ("TIME(PS)", "Etot"), ("PS", "kcal/mol"), [0, 1, 2], [-5606.5] * 3),
        (MDOUT, ("time", "EKtot+EPtot"), ("PS", "kcal/mol"), [0, 1, 2], [-5606.5] * 3),
        (NPZ.getvalue(), ("time", "E"), ("", ""), [0, 1, 2], [1.5] * 3),
    ],
)
def test_other_forms_are_read_and_columns_added(data, names, units, times, energies):
    found = read(data, *names)
    assert found.units == units
    assert [list(column) for column in found.columns] == [times, energies]


def test_one_table_is_judged_and_named():
    assert judge(LOG, "--json", time="Step", energy="TotEng").json["first_energy"] == 100
    outcome = judge(LOG, time="Step", energy="TotEng")
    assert "300 samples from 0 to 29.9, table 2 of 2; skipped: 1 row without numbers" in outcome.out
    for skipped, code in ((0, 1), (1, 0)):
        gate = f"skipped > {skipped} or samples < 300"
        assert judge(LOG, "--fail-if", gate, time="Step", energy="TotEng").code == code
    answer = judge(LOG, "--json", "--table", 1, time="Step", energy="TotEng").json
    assert (answer["table"], answer["tables"], answer["samples"]) == (1, 2, 200)
    assert judge(LOG, "--table", 3, time="Step", energy="TotEng").refused(
        3, "no table 3; the input has 2"
    )


def test_a_time_that_starts_again_begins_a_table():
    again = (
        table() + "".join(f"{t!r},{energy + 7!r}\n" for t, energy in ROWS) + "29.95"
    )  # cut while it was written
    answer = judge(again, "--json").json
    assert (answer["table"], answer["tables"], answer["first_energy"], answer["samples"]) == (
        2,
        2,
        107,
        300,
    )


FOOTER = "Loop time of 1 on 1 procs for 9 steps with 9 atoms\nNlocal: 9 ave 9 max 9 min\nHistogram: 1 0 0 0 0 0 0 0\n"


@pytest.mark.parametrize("names", [("Time", "TotEng"), ("2", "4")])
def test_a_second_header_begins_a_table_and_a_footer_none(names):
    head = "   Step   Time   Temp   TotEng\n"
    first = (
        "1 by 1 by 1 grid\n"
        + head
        + "".join(f"{n} {t} 300. {energy - 9}\n" for n, (t, energy) in enumerate(ROWS))
        + FOOTER
    )
    second = (
        head
        + "".join(f"{n} {t + 30} 300. {energy}\n" for n, (t, energy) in enumerate(ROWS))
        + FOOTER
    )
    found = read(first + second, *names)
    assert (found.number, found.count, len(found.columns[0]), found.columns[1][0]) == (
        2,
        2,
        300,
        100,
    )


def test_a_header_on_each_page_begins_no_table():
    pages = [ROWS[at : at + 20] for at in range(0, 300, 20)]
    rows = ["".join(f"ENERGY: {t} 1.5 {energy}\n" for t, energy in page) for page in pages]
    found = read("".join(f"ETITLE: TS BOND TOTAL\n{page}\n" for page in rows), "TS", "TOTAL")
    assert (found.count, len(found.columns[0])) == (1, 300)


def test_rows_before_a_time_are_left_out():
    answer = judge(table(), "--from", 10, "--json").json
    assert (answer["samples"], answer["first_time"], answer["skipped"]["before_start"]) == (
        200,
        10.0,
        100,
    )


def test_rows_that_cannot_be_used_are_counted():
    bad = "x,1\n1,\n,1\n2\n30.0,nan\n31.0,inf\nnan,1\ninf,1\n31.0,1\n"
    outcome = judge(table() + bad + "32,100.5\n", "--json")
    assert outcome.json["skipped"] == {
        "without_numbers": 4,
        "energy_not_finite": 2,
        "time_not_finite": 2,
        "time_not_later": 1,
        "before_start": 0,
    }
    assert (outcome.json["samples"], outcome.json["diverged_at"]) == (301, None)


@pytest.mark.parametrize("end", ["inf", "nan", "-inf", "1e999"])
def test_energies_that_end_in_nan_or_inf_have_failed(end):
    text = table() + f"30.0,{end}\n31.0,{end}\n"
    outcome = judge(text, "--json")
    assert outcome.code == 1
    assert (outcome.json["verdict"], outcome.json["diverged_at"], outcome.json["samples"]) == (
        "failed",
        30.0,
        300,
    )
    assert "nan or inf from 30 on" in judge(text).out
    assert judge(text, "--fail-if", "max_energy_error > 1e9").code == 1


RISING = "Time (ps),E (eV),K\n" + "".join(
    f"{n},{100 + n / 10 + (n * 7919) % 13 / 100},5\n" for n in range(200)
)


def test_trends_have_the_units_of_the_heads():
    names = {"time": "Time", "energy": "E"}
    answer = judge(RISING, "--json", **names).json
    assert (answer["schema"], answer["verdict"], answer["samples"]) == (
        "pendu.judge/1",
        "grows",
        200,
    )
    assert answer["trend"] == pytest.approx(0.001, rel=1e-3)
    assert answer["absolute_trend"] == pytest.approx(0.1, rel=1e-3)
    assert (answer["trend_unit"], answer["energy_unit"]) == ("1/ps", "eV")
    assert "eV per ps" in judge(RISING, **names).out
    answer = judge(RISING, "--json", "--atoms", 100, "--temperature", 300, **names).json
    assert answer["energy_per_ns_per_atom"] == pytest.approx(1.0, rel=1e-3)
    assert answer["kt_per_ns_per_atom"] == pytest.approx(1 / 0.025852, rel=1e-3)
    assert judge(table(), "--atoms", 5).refused(2, "--atoms needs the unit of the times")
    assert judge(RISING, "--temperature", 5, **names).refused(2, "belongs to --atoms")


def test_with_a_scale_of_std_nothing_depends_on_the_zero_of_the_energies():
    found = [
        judge(
            "t,E\n" + "".join(f"{t},{energy + t / 9 + zero:.9f}\n" for t, energy in ROWS),
            *("--scale", "std", "--json", "--fail-if", "trend > 0.05 and verdict == grows"),
        )
        for zero in (-100, 0, 1e5)
    ]
    assert {(each.code, each.json["verdict"]) for each in found} == {(1, "grows")}
    for name in ("trend", "uncertainty", "max_energy_error"):
        values = [each.json[name] for each in found]
        assert values == pytest.approx([values[0]] * 3, rel=1e-6)


def test_scales():
    zero = "t,E,K\n" + "".join(f"{n},{n},-4\n" for n in range(100))
    assert judge(zero).refused(2, "the first energy is 0", "--scale")
    assert judge(zero, "--json", "--scale", "50").json["max_energy_error"] == 99 / 50
    assert judge(zero, "--json", "--scale", "kinetic:K").json["max_energy_error"] == 99 / 4
    assert judge(zero, "--scale", "-1").refused(2, "none of first, std, kinetic:COLUMN")


def test_the_fluctuation_of_a_second_order_method_goes_with_the_square_of_the_step():
    files = []
    for step in (1, 2):
        files.append(f"{step}.csv")
        rows = "".join(f"{t},{100 + step**2 * (energy - 100)}\n" for t, energy in ROWS)
        Path(files[-1]).write_text("t,E\n" + rows)
    command = ["judge", *files, "--steps", "1,2", "--time", "t", "--energy", "E"]
    answer = pendu(*command, "--json").json
    assert (answer["fluctuation_order"], answer["drift_order"]) == (
        pytest.approx(2, abs=1e-6),
        None,
    )
    assert [each["verdict"] for each in answer["files"]] == ["bounded", "bounded"]
    assert "goes as h^2.00" in pendu(*command).out
    assert pendu(*command, "--fail-if", "fluctuation_order < 1.8").code == 0
    assert pendu(*command, "--fail-if", "fluctuation_order > 1.8").code == 1
    assert pendu("judge", *files, "--time", "t", "--energy", "E").refused(2, "--steps")


@pytest.mark.parametrize(
    ("expression", "found"),
    [
        ("verdict != bounded", ""),
        ("verdict == bounded", "verdict is bounded"),
        ("max_energy_error > 0.1", ""),
        (
            "max_energy_error > 0.001 and (trend < -1 or verdict == bounded)",
            "max_energy_error is 0.01, verdict is bounded",
        ),
        ("trend > 1e-2", ""),
    ],
)
def test_fail_if_names_a_field_and_the_failure_gives_its_value(expression, found):
    outcome = judge(table(), "--fail-if", expression)
    assert outcome.code == bool(found)
    assert outcome.err == (
        f"pendu-tui: the check failed: {expression} ({found})\n" if found else ""
    )


def test_a_value_that_is_not_known_yet_fails_the_check():
    assert judge("t,E\n0,1\n1,1\n", "--fail-if", "trend > 1").code == 1
    assert judge("t,E\n0,1\n1,1\n", "--fail-if", "verdict != bounded").code == 1
    assert "too early: 2 of 64 samples" in judge("t,E\n0,1\n1,1\n").out


@pytest.mark.parametrize(
    ("expression", "failures"), [("verdict != bounded", "0"), ("verdict == bounded", "1")]
)
def test_junit_has_the_check_as_a_test_and_replaces_an_older_report(expression, failures):
    Path("judge.xml").write_text("old")
    judge(table(), "--fail-if", expression, "--junit", "judge.xml")
    suite = ElementTree.parse("judge.xml").getroot()
    assert (suite.tag, suite.attrib["tests"], suite.attrib["failures"]) == (
        "testsuite",
        "1",
        failures,
    )
    assert (suite.find("testcase/failure") is not None) == (failures == "1")
    assert "bounded" in suite.findtext("testcase/system-out")
    assert suite.find("testcase").attrib["name"].endswith(expression)


@pytest.mark.parametrize(
    ("text", "names", "code", "words"),
    [
        ("", ("t", "E"), 3, ["the input is empty"]),
        (table(), ("t", "Energy"), 2, ["there is no column 'Energy'", "choose from t, E"]),
        (
            table(header="time,energy"),
            ("time", "enrgy"),
            2,
            ["there is no column 'enrgy': did you mean energy?"],
        ),
        (XVG, ("1", "Total Enrgy"), 2, ["did you mean Total Energy?"]),
        (table(), ("1", "3"), 3, ["no row has a number in each column; columns count from 1"]),
        (table(), ("0", "2"), 3, ["no row has a number in each column"]),
        ("1 2\n", ("t", "E"), 2, ["give columns by number"]),
        ("t,E\na,b\n", ("t", "E"), 3, ["no row has a number in each column"]),
        ("t,E\n1,nan\n", ("t", "E"), 3, ["no row has a usable"]),
        (table(), ("", ""), 2, ["there is no column ''; choose from t, E"]),
        (
            "words\na b c\nStep TotEng\n1 2\na | b | c | d\n",
            ("Step", "E"),
            2,
            ["choose from Step, TotEng."],
        ),
        ("\x1b[31m,\x07\n", ("t", "E"), 2, ["there is no column 't'"]),
    ],
)
def test_what_cannot_be_judged_is_one_sentence(text, names, code, words):
    assert judge(text, time=names[0], energy=names[1]).refused(code, *words)


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


def test_a_file_that_cannot_be_read_is_one_sentence():
    assert pendu("judge", "absent.csv", "--time", "1", "--energy", "2").refused(
        3, "absent.csv", "No such file"
    )
    assert pendu("judge", ".", "--time", "1", "--energy", "2").refused(3, "directory")
    assert judge(table(), "--fail-if", "rk4.verdict == grows").refused(2, "write FIELD > NUMBER")
    assert judge(table(), "--fail-if", "theta_error > 1").refused(
        2, "there is no field 'theta_error'"
    )


def test_a_table_of_several_methods_is_refused():
    Path("all.csv").write_text(
        "t,E\n" + "".join(f"{t},{energy}\n" for t in range(5) for energy in (1, 2, 3))
    )
    assert pendu("judge", "all.csv", "--time", "t", "--energy", "E").refused(
        3, "several methods", "grep"
    )


@pytest.mark.parametrize(
    ("data", "words"),
    [
        ("t,E\n0,1\n".encode("utf-16"), "UTF-16"),
        (b"\x1f\x8b\x08\x00rest", "gzip"),
        (b"\x89MCAP0\r\nrest", "a recording"),
        (b"\0" * 5000, "no text"),
        (b"x" * (1 << 21), "longer than 1 MB"),
        (b"y\n" * 1002, "lines without a row"),
        (b"t,E\n" + b"y\n" * 1002, "lines without a row"),
        (b"PK\x03\x04rest", "npz cannot be read"),
    ],
)
def test_what_is_no_table_is_refused_within_bounds(data, words, monkeypatch):
    monkeypatch.setattr("tui.cli.columns.MAX_LINES_BEFORE", 1000)
    assert judge(data).refused(3, words)


@pytest.mark.parametrize("stretch", [" ( ", " [", ' "', " /", "a ", "\t"])
def test_no_header_takes_long(stretch):
    began = time.process_time()
    assert judge("t,e" + stretch * 50_000 + "\n0,1\n").code in (0, 2, 3)
    assert judge("t,e\n0,1\n", time="t" * 100_000).code in (2, 3)
    assert time.process_time() - began < 2


def test_an_npz_with_pickles_is_refused():
    stream = io.BytesIO()
    np.savez(stream, t=np.arange(3.0), E=np.array([{}, {}, {}], dtype=object))
    assert judge(stream.getvalue()).refused(3, "this .npz cannot be read")


@given(
    st.binary(max_size=300) | st.text(st.sampled_from('0123456789.,;\t \n"#@tEnai-+'), max_size=300)
)
def test_any_input_is_columns_or_one_sentence(data):
    text = data if isinstance(data, str) else data.decode("utf-8", "replace")
    for names in (("1", "2"), ("t", "E")):
        try:
            times, energies = read(text, *names).columns
            sentence = ""
        except UserError as error:
            times, energies = [], []
            sentence = str(error)
        assert sentence == "" or sentence.isprintable()
        assert len(times) == len(energies)
        assert all(map(math.isfinite, energies))
        assert all(a < b for a, b in pairwise(times))


def test_a_hundred_thousand_lines_with_gaps_take_a_fraction_of_a_second():
    rows = (
        f"{n * 0.01:.2f},0.5,{'' if n % 10 == 0 else 1 + 1e-3 * math.sin(n)},1.0\n"
        for n in range(100_000)
    )
    Path("energies.csv").write_text("t,kinetic,E,x\n" + "".join(rows))
    began = time.process_time()
    outcome = pendu("judge", "energies.csv", "--time", "t", "--energy", "E", "--json")
    assert time.process_time() - began < 1.0  # 0.15 s on an idle machine; 10⁶ lines may take 2 s
    assert (outcome.json["samples"], outcome.json["skipped"]["without_numbers"]) == (90_000, 10_000)


def test_an_input_that_never_ends_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("tui.cli.columns.MAX_RECORDS", 100)
    path = tmp_path / "long.csv"
    path.write_text("".join(f"{t},1.0\n" for t in range(101)))
    assert pendu("judge", path, "--time", 1, "--energy", 2).code == 3
