import io
import math
import subprocess
import sys
import time
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tui.command_line import pendu
from tui.cli.columns import Columns, read_columns
from tui.cli.errors import UserError

ROWS = [(n / 10, 100 + math.sin(n)) for n in range(300)]


def table(delimiter: str = ",", header: str = "t,E", end: str = "\n") -> str:
    return header + end + "".join(f"{t!r}{delimiter}{energy!r}{end}" for t, energy in ROWS)


def judge(text: str, *more: object, time: str = "t", energy: str = "E") -> object:
    Path("energies.csv").write_bytes(text.encode())
    return pendu("judge", "energies.csv", "--time", time, "--energy", energy, *more)


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


XVG = '# by gmx energy\n@ title "E"\n@    xaxis  label "Time (ps)"\n@TYPE xy\n@ s0 legend "Potential"\n'
XVG += '@ s1 legend "Total Energy"\n' + "".join(f"  {t:.6f}  -3.0  {energy!r}\n" for t, energy in ROWS)
LOG = "LAMMPS (2 Aug 2023)\nthermo_style custom step temp etotal\n   Step   Temp   TotEng\n"
LOG += "".join(f"  {t:.1f} 300. {energy!r}\n" for t, energy in ROWS[:200]) + "Loop time of 1 on 1 procs\n\n"
LOG += "Step TotEng Temp\n" + "".join(f"  {t:.1f} {energy!r} 300.\n" for t, energy in ROWS[199:]) + "Loop time\n"


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
        (table(",", "t,E\ns,J"), ("t", "E"), 1),
        (table("   ", "  t    E"), ("t", "E"), 0),
        (table(" ", "# t, E"), ("t", "E"), 0),
        (table(" ", "# a remark"), ("1", "2"), 0),
        (table(" ", "").lstrip(), ("1", "2"), 0),
        (table().replace("\n", "\n\n# remark\n"), ("t", "E"), 0),
        ("".join(f'"{t!r}","{energy!r}"\n' for t, energy in ROWS), ("1", "2"), 0),
        (XVG, ("1", "Total Energy"), 0),
        (XVG, ("Time", "total energy"), 0),
        (XVG, ("1", "3"), 0),
        (LOG, ("Step", "TotEng"), 3),
    ],
)
def test_a_table_is_read_whatever_its_form(text, names, skipped):
    found = read_columns(io.StringIO(text.removeprefix("\ufeff"), newline=None), *names)
    assert list(zip(found.times, found.energies, strict=True)) == ROWS
    assert sum(found.skipped.values()) == skipped
    answer = judge(text, "--json", time=names[0], energy=names[1]).json
    assert (answer["samples"], answer["verdict"], answer["first_energy"]) == (300, "bounded", 100.0)


def test_fortran_writes_its_exponents_with_a_d():
    found = read_columns(["t E\n", "0.0D0 1.5D+02\n", "1.0d-1 1.5d+02\n"], "t", "E")
    assert (list(found.times), list(found.energies)) == ([0.0, 0.1], [150.0, 150.0])


def test_rows_that_cannot_be_used_are_counted_and_said():
    bad = "x,1\n1,\n,1\n2\n30.0,nan\n31.0,inf\nnan,1\ninf,1\n5,1\n"
    outcome = judge(table() + bad + "32,100.5\n", "--json")
    assert outcome.json["skipped"] == {
        "text_or_gap": 4, "time_not_later": 1, "time_not_finite": 2, "energy_not_finite": 2,
    }  # fmt: skip
    assert (outcome.json["samples"], outcome.json["diverged_at"]) == (301, None)
    assert "; 9 rows skipped (4 text or a gap, 1 time not later than before, 2 " in judge(table() + bad + "32,1\n").out


@pytest.mark.parametrize("end", ["inf", "nan", "-inf", "1e999"])
def test_energies_that_end_in_nan_or_inf_have_failed_and_trip_every_check(end):
    text = table() + f"30.0,{end}\n31.0,{end}\n"
    answer = judge(text, "--json").json
    assert (answer["verdict"], answer["diverged_at"], answer["samples"]) == ("grows", 30.0, 300)
    assert "nan or inf from time 30 on" in judge(text).out
    assert judge(text, "--fail-if", "max_energy_error > 1e9").code == 1


def test_json_has_the_fields_of_the_contract():
    answer = judge("t,E\n" + "".join(f"{n},{100 + n}\n" for n in range(200)), "--json").json
    assert (answer["schema"], answer["verdict"], answer["samples"]) == ("pendu.judge/1", "grows", 200)
    assert answer["trend_per_second"] == pytest.approx(0.01)
    assert answer["uncertainty"] < 1e-9
    assert answer["max_energy_error"] == pytest.approx(1.99)
    assert answer["forecast"]["time"] == 1990
    assert answer["forecast"]["low"] < 19.9 < answer["forecast"]["high"]


@pytest.mark.parametrize(
    ("expression", "code"),
    [
        ("verdict != bounded", 0),
        ("verdict == bounded", 1),
        ("max_energy_error > 0.1", 0),
        ("max_energy_error > 0.001 and (trend_per_second < -1 or verdict == bounded)", 1),
        ("trend_per_second > 1e-2", 0),
    ],
)
def test_fail_if_names_a_field_without_a_method(expression, code):
    outcome = judge(table(), "--fail-if", expression)
    assert outcome.code == code
    assert outcome.err == (f"pendu-tui: the check failed: {expression}\n" if code else "")


def test_a_value_that_is_not_known_yet_fails_the_check():
    assert judge("t,E\n0,1\n1,1\n", "--fail-if", "trend_per_second > 1").code == 1
    assert judge("t,E\n0,1\n1,1\n", "--fail-if", "verdict != bounded").code == 1
    assert "too early" in judge("t,E\n0,1\n1,1\n").out


@pytest.mark.parametrize(("expression", "failures"), [("verdict != bounded", "0"), ("verdict == bounded", "1")])
def test_junit_has_the_check_as_a_test_and_replaces_an_older_report(expression, failures):
    Path("judge.xml").write_text("old")
    judge(table(), "--fail-if", expression, "--junit", "judge.xml")
    suite = ElementTree.parse("judge.xml").getroot()
    assert (suite.tag, suite.attrib["tests"], suite.attrib["failures"]) == ("testsuite", "1", failures)
    assert (suite.find("testcase/failure") is not None) == (failures == "1")
    assert "bounded" in suite.findtext("testcase/system-out")
    assert suite.find("testcase").attrib["name"].endswith(expression)


def test_errors_are_relative_to_the_scale_that_is_given():
    zero = "t,E\n" + "".join(f"{n},{n}\n" for n in range(100))
    assert judge(zero).refused(2, "the first energy is 0", "--scale")
    assert judge(zero, "--json", "--scale", "50").json["max_energy_error"] == 99 / 50


@pytest.mark.parametrize(
    ("text", "names", "code", "words"),
    [
        ("", ("t", "E"), 3, ["the input is empty"]),
        (table(), ("t", "Energy"), 2, ["there is no column 'Energy'", "choose from t, E"]),
        (table(header="time,energy"), ("time", "enrgy"), 2, ["there is no column 'enrgy': did you mean energy?"]),
        (XVG, ("1", "Total Enrgy"), 2, ["did you mean Total Energy?"]),
        (table(), ("1", "3"), 3, ["no line has numbers in the columns 1 and 3"]),
        (table(), ("0", "2"), 3, ["no line has numbers in the columns 0 and 2"]),
        ("1 2\n", ("t", "E"), 2, ["give columns by number"]),
        ("t,E\na,b\n", ("t", "E"), 3, ["no row has a usable time and energy; 1 row skipped (1 text or a gap)"]),
        ("t,E\n1,nan\n", ("t", "E"), 3, ["no row has a usable"]),
        ("\x1b[31m,\x07\n", ("t", "E"), 2, ["there is no column 't'"]),
    ],
)
def test_what_cannot_be_judged_is_one_sentence(text, names, code, words):
    assert judge(text, time=names[0], energy=names[1]).refused(code, *words)


@pytest.mark.parametrize(("end", "code", "word"), [("< energies.csv", 0, "bounded"), ("<&-", 3, "Bad file descr")])
def test_stdin_is_read_where_it_is_open(end, code, word):
    Path("energies.csv").write_text(table())
    program = Path(sys.executable).with_name("pendu-tui")
    line = f"{program} judge - --time t --energy E {end}"
    done = subprocess.run(["bash", "-c", line], capture_output=True, text=True, check=False)
    assert done.returncode == code
    assert word in done.stdout + done.stderr
    assert "Traceback" not in done.stderr


def test_a_file_that_cannot_be_read_is_one_sentence():
    assert pendu("judge", "absent.csv", "--time", "1", "--energy", "2").refused(3, "absent.csv", "No such file")
    assert pendu("judge", ".", "--time", "1", "--energy", "2").refused(3, "directory")
    assert judge(table(), "--fail-if", "rk4.verdict == grows").refused(2, "has none; write 'verdict == grows'.")
    both = "verdict == grows or rk4.max_energy_error > 1"
    assert judge(table(), "--fail-if", both).refused(2, "write 'verdict == grows or max_energy_error > 1'.")
    assert judge(table(), "--fail-if", "theta_error > 1").refused(2, "There is no field 'theta_error'")


def test_a_table_of_several_methods_is_refused():
    Path("all.csv").write_text("t,E\n" + "".join(f"{t},{energy}\n" for t in range(5) for energy in (1, 2, 3)))
    assert pendu("judge", "all.csv", "--time", "t", "--energy", "E").refused(3, "several runs or methods", "grep")


@given(st.binary(max_size=300) | st.text(st.sampled_from('0123456789.,;\t \n"#@tEnai-+'), max_size=300))
def test_any_input_is_columns_or_one_sentence(data):
    text = data if isinstance(data, str) else data.decode("utf-8", "replace")
    for names in (("1", "2"), ("t", "E")):
        found, sentence = Columns(), "none"
        try:
            found = read_columns(io.StringIO(text), *names)
        except UserError as error:
            sentence = str(error)
        assert sentence.isprintable()
        assert len(found.times) == len(found.energies)
        assert all(map(math.isfinite, found.energies))
        assert all(a < b for a, b in pairwise(found.times))


def test_a_hundred_thousand_lines_with_gaps_take_a_fraction_of_a_second():
    rows = (f"{n * 0.01:.2f},0.5,{'' if n % 10 == 0 else 1 + 1e-3 * math.sin(n)},1.0\n" for n in range(100_000))
    Path("energies.csv").write_text("t,kinetic,E,x\n" + "".join(rows))
    began = time.process_time()
    outcome = pendu("judge", "energies.csv", "--time", "t", "--energy", "E", "--json")
    assert time.process_time() - began < 1.0  # 0.15 s on an idle machine; 10⁶ lines may take 2 s
    assert (outcome.json["samples"], outcome.json["skipped"]["text_or_gap"]) == (90_000, 10_000)


def test_of_energies_that_grew_and_stopped_run_says_so_later_and_both_helps_tell():
    """In the scene crossover explicit Euler is over the top within seconds, and then its energy hardly grows."""
    euler = ("run", "--scene", "crossover", "--methods", "explicit_euler", "--record", "euler.mcap", "--time")
    (method,) = pendu(*euler, 60, "--json").json["methods"]
    energies = pendu("export", "euler.mcap", "--format", "csv").out
    told = judge(energies, "--json", time="t_s", energy="energy_per_s2").json
    assert (method["verdict"], told["verdict"]) == ("grows", "caught")
    for command in ("run", "judge"):
        assert "4096 steps" in pendu(command, "--help").out
