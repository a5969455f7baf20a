"""The reader of energy logs: what is a table, a run, a column, a unit, an energy that ended."""

import gzip
import io
import json
import lzma
import math

import numpy as np
import pytest

from pendu_tui.tui.cli.errors import UserError
from pendu_tui.tui.cli.reader import read_sheets
from pendu_tui.tui.cli.tables import Series, Wanted, choose, find
from pendu_tui.tui.cli.units import BOLTZMANN, NANOSECONDS, shown

SAMPLES = [(n, n / 2, -345 + math.sin(n) / 100, 20 + math.cos(n)) for n in range(90)]
TIMES = [t for _, t, _, _ in SAMPLES]
ENERGIES = [e for _, _, e, _ in SAMPLES]


def rows(form: str, first: int = 0, last: int = 90) -> str:
    """Return lines with step s, time t, energy e = k + p, one of 20 bodies b, flag f, wave w."""
    return "".join(
        form.format(n=n, s=50 * n, t=t, e=e, k=k, p=e - k, b=n % 20, f=n % 9 // 8, w=k - 20) + "\n"
        for n, t, e, k in SAMPLES[first:last]
    )


TABLE = "t,E\n" + rows("{t},{e}")


def tables(data: str | bytes, file="", span=(), **wanted) -> list[Series]:
    """Return the tables of a file, finished in this span of time."""
    stream = io.BytesIO(data.encode() if isinstance(data, str) else data)
    sheets = read_sheets(io.BufferedReader(stream), Wanted(**wanted), file)
    found = [series for sheet in sheets for series in sheet.series()]
    for series in found:
        if series.choice.energy:
            series.finish(*span)
    return found


def columns(series: Series) -> str | None:
    """Return the names and units of time and energy, None where they are in doubt."""
    groups = (series.choice.time, series.choice.energy)
    units = zip(map(series.named, groups), series.units, strict=True)
    found = ", ".join(f"{name} {unit}".strip() for name, unit in units)
    return None if series.choice.doubt else found


@pytest.mark.parametrize(
    ("head", "form", "found"),
    [
        ("time_ps,total_energy_eV", "{t},{e}", "time ps, total_energy eV"),
        ("Time ps,E [eV]", "{t},{e}", "Time ps, E eV"),
        ("t/ps,E/(kJ/mol)", "{t},{e}", "t ps, E kJ/mol"),
        ("time{picosecond},Etot/N[electronvolt]", "{t},{e}", "time ps, Etot/N eV"),
        ("time [μs],E/(kJ·mol⁻¹)", "{t},{e}", "time us, E kJ/mol"),
        ("t,|dE/E|", "{t},{e}", "t, |dE/E|"),
        ("t,dE/E [-]", "{t},{e}", "t, dE/E -"),
        ("T,energy", "{t},{e}", "T, energy"),  # it increases
        ("T,t,E", "300,{t},{e}", "t, E"),
        ("t,E,total,conserved", "{t},{k},{k},{e}", "t, conserved"),
        ("t,sim time,ECons,econt", "{k},{t},{k},{e}", "sim time, econt"),
        ("t,E,dE/E", "{t},{e},{k}", "t, E"),
        ("t,E,p", "{t},{e},word", "t, E"),
        ("t, E, h", "{t}, {e}, {k}", "t, E"),  # h is no hour
        ("t x E\nt E x", "{t} {e} {k}", "t, E"),  # the nearest
        ("Step Time (ps) E (eV)", "{s} {t} {e}", "Time ps, E eV"),
        ("Time (ps) Total E (eV)", "{t} {e}", "Time ps, Total E eV"),
        ("# [1] = time [2]=dt [10]=tot-E", "{t} 1 {e}", "time, tot-E"),
        (
            "# Col. 1: time\n# cols 2-9: x\n# 10 = energy",
            *("{t} 1 2 3 4 5 6 7 8 {e}", "time, energy"),
        ),
        ("keywords: ['Time', 'TotEng', ]\ndata:", "  - [{t}, {e}, ]", "Time, TotEng"),
        ("x,E", "{t},{e}", "x, E"),  # evenly
        ("x E\n--- ---", "{t} {e}", "x, E"),
        ("x E\n(ps) (eV)", "{t} {e}", "x ps, E eV"),
        ("t E\n(ps) (eV) (K)", "{t} {e}", "t, E"),
        ("x,E", "{n}e{n},{e}", None),
        ("", "{n}e{n} {e}", "column 1, column 2"),
        ("x,E", "{k},{e}", "row, E"),  # no column increases
        ("x,E", "{b},{e}", None),  # bodies
        ("x,E", "{f},{e}", "row, E"),
        ("x,E", "{b}.5,{e}", "row, E"),
        ("n E error", "({n}) [{e}] (3)", "n, E"),
        ("KE,E", "{b},{e}", "row, E"),
        ("t,KE,Ekin", "{t},{k},{p}", None),
        ("t,KE (eV),PE (J)", "{t},{k},{p}", None),
        ("t,KE (kJ/mol),PE (kJ/mole)", "{t},{k},{p}", "t, KE+PE kJ/mol"),
        ("t,x,KE,PE", "{t},{k},{k},{p}", "t, KE+PE"),
        ("t,KE,PE,internal energy", "{t},{k},{p},9", None),
        ("Zeit [s],Ekin [J],Epot [J],Gesamtenergie [J]", "{t},{k},{p},{e}", None),
        ("t,KE,PE,spring", "{t},{k},-9,{p}", None),
        ("t,KE,PE,spring,total", "{t},{k},-9,{p},{e}", "t, total"),
        ("t,KE,PE,total", "{t},{k},{p},1000.00{n:02}", None),  # of particles
        ("t,KE,PE,E", "{t},{k},{p},1000", None),
        ("t,KE,PE,total", "{t},20,-366.8,{e}", "t, total"),  # 0.5 % from their sum
        ("t,KE,PE,total", "{t},20,-383,{e}", None),  # 5 %
        ("t,KE,energy", "{t},{k},{p}", None),
        ("t,KE,PE,E,bond energy", "{t},{k},{p},{e},9", "t, E"),
        ("t,strain energy,E", "{t},{k},{e}", None),  # a modulus
        ("t,alive,total", "{t},{k},{e}", None),
        ("t,Hartree [H],Total [H]", "{t},{k},{e}", "t, Total hartree"),
        ("t,e,dE/E", "{t},{k},{e}", None),
        ("t,e", "{t},{e}", "t, e"),
        *((f"t,{other},e", "{t},1.5,{e}", None) for other in ("a", "i", "inc", "n")),
        *((f"t,E,{other}", "{t},{e},1.5", None) for other in ("N", "B", "I", "nu", "loss")),
        *((f"t,{count},e", "{t},2,{e}", "t, e") for count in "in"),
        ("t,x,E", "{t},{k},{w}", None),  # a field
        ("t,x,E", "{t},{k},{b}", None),  # a count
        ("time,t,E", "17327000{n:02},{t},{e}", "t, E"),  # on the wall
        ("step,t,E", "{s},31536000{n:02},{e}", "t, E"),  # 100 years
        ("step,t [fs],E", "{s},17327000{n:02},{e}", "t fs, E"),
        ("", "t = {t} E = {e}×10^{f}", None),
        ("", "t = {t} E = -42 {k:07.3f}", None),
        ("", "t = {t} E = {e} 300 K", "t, E"),
        ("t,N,E", "{t},100,{e}", "t, E"),  # particles
        ("t (fs),E", "{t} ps , {e} eV", "t ps, E eV"),
        ("t,energy error (%)", "{t},{e}", None),
        ("t,E (V/m)", "{t},{e}", None),
        ('"t" "E"', '"{n}" {t} {e}', "t, E"),  # R
        ("  t     E", "{n:<4} {t} {e}", "t, E"),  # pandas
        ("Time Etot", "{t} {e} {k}", None),
        ("Time Etot", "{n} -{t} {e}", None),
        (",x,t,E", "{n},-{t},{t},{e}", "t, E"),  # pandas
        ("", "{e}", "row, column 1"),
        ("", "{t} {e}", "column 1, column 2"),
        ("seed 7;", "{t} {e}", "column 1, column 2"),
        ("", "{k} {p}", None),
        ("", "{t} {k} {e}", None),
        ("", '{{"t": {t}, "a": {{"E": {k}}}, "b": {{"E": {e}}}}}', None),
        ("", "INFO step {s}, time {t}, energy {e}, kinetic energy {k}", "time, energy"),
        ("", "time {t} kinetic energy {k} PE {p}", "time, kinetic energy+PE"),
        ("", "step {s} wall time {n} with energy {e}", "step, energy"),
        ("", "step {s}: energy = {e}", "step, energy"),
        ("", "time {t}: total energy {e}", "time, total energy"),
        ("", "time {t} s: total energy = {e}", "time s, total energy"),
        ("", "time {t}\ntotal  energy {e} kinetic  energy {k}", None),
        ("", "time {t}\nE = {k} (E = {e})", None),
        (
            "",
            "energy(sigma->0) = {k}\ntotal energy  ETOTAL = {e} eV",
            "row, total energy  ETOTAL eV",
        ),
        ("", "[info] t={t} n={n} E={e}", "t, E"),
        ("Time, ps;Total energy, eV", "{t};{e}", "Time ps, Total energy eV"),
        ("Unnamed: 0,t,E", "{n},{t},{e}", "t, E"),  # pandas
        *((f"t,{name}", "{t},{e}", None) for name in ("dE/E (ppm)", "e err %", "e drift (eV)")),
        ("", "t={t} energy drift: {e} %", None),
    ],
)
def test_columns_are_guessed_only_where_names_leave_no_doubt(head, form, found):
    (series,) = tables(f"{head}\n{rows(form)}")
    assert (columns(series), len(series.times)) == (found, 90)
    assert found is None or list(series.energies) == pytest.approx(ENERGIES)


@pytest.mark.parametrize(
    ("form", "units"),
    [
        ("t = {t}: E(t) = {e}", ", "),
        ("  | Simulation time     : {t} ps\n  | Total energy (el.+nuc.)   : {e} eV", "ps, eV"),
        ("t = {t} E = {e} J\nw = {n} fs\nw = {n} ps", ", J"),
        ("Step {n}: time: {t} ps, energy: {e} eV", "ps, eV"),
        ("Time (ps): {t} | Energy (eV): {e} | dE = 1e-3", "ps, eV"),
        ("INFO t={t}s E={e}J", "s, J"),
        ("t={t}: KE={k} E={e}", ", "),
        ("t={t} ps E={e}\nw={n} ms\nw={n} S", "ps, "),
        ("Step {s}/4500 (t={t}): energy = {e}", ", "),
        ("Time:  {t}\n  Total     energy: {e}\n  Kinetic   energy: {k}", ", "),
        ("t={t} ms K=3.5 E={e} mJ t={s}", "ms, mJ"),  # K is no kelvin
        ("Step {s}\n  time = {t}\n  kinetic = {k}\n  total energy = {e} Ry", ", Ry"),
        ("E = {e}\nt = {t}", ", "),
        ("({t}, {e})", ", "),
        ("{t}ps {e}eV", "ps, eV"),
        ('{{"t": {t}, "energy": {{"total": {e}, "kinetic": {k}}}}}', ", "),
        ("[{t}, {e}]", ", "),
    ],
)
def test_printed_values_are_rows(form, units):
    (series,) = tables(rows(form))
    assert ", ".join(series.units) == units
    assert list(series.times) == TIMES
    assert list(series.energies) == ENERGIES


def test_a_printed_unit_may_begin_late_and_be_spelled_in_two_ways():
    (series,) = tables("t = -2 PS E = 9\n" + rows("t = {t} ps E = {e} J"))
    assert series.units == ("ps", "J")


@pytest.mark.parametrize(
    "form",
    [
        "t = {s:,} E={e}",
        "t={s:,}.00, E={e}",
        "t;E\n{s:,};{e}",
        "t|E\n{s:,}|{e}",
        "t\tE\n{s:,}\t{e}",
        't,E\n"{s:,}",{e}',
        "{s:,} {e}",
    ],
)
def test_thousands_may_have_commas_beside_decimal_points(form):
    *head, row = form.split("\n")
    (series,) = tables("".join(f"{name}\n" for name in head) + rows(row))
    assert list(series.times) == [*range(0, 4500, 50)]


@pytest.mark.parametrize(
    ("text", "second"),
    [
        ("t;E\n" + rows("{n};4.450,{n:02}"), (1, 4450.01)),
        (rows("t={n},125 E=-41,9{n:02} J"), (1.125, -41.901)),
        (rows("12.05.2024 v1.2 t={n},125 E=-41,9{n:02} J"), (1.125, -41.901)),
    ],
)
def test_a_comma_without_a_point_behind_it_is_decimal(text, second):
    (series,) = tables(text)
    assert (series.times[1], series.energies[1]) == second


@pytest.mark.parametrize("form", ["2024-05-01T12:00:{n:02}", '"2024-05-01 14:00:{n:02}+02:00"'])
def test_dates_are_times_in_seconds(form):
    (series,) = tables("time,energy\n" + rows(form + ",{e}", last=60))
    assert columns(series) == "time s, energy"
    assert list(series.times) == [1_714_564_800 + second for second in range(60)]


def array(*unnamed: object, **named: object) -> bytes:
    file = io.BytesIO()
    if unnamed:
        np.save(file, unnamed[0])
    else:
        np.savez(file, **named)
    return file.getvalue()


@pytest.mark.parametrize(
    "data",
    [
        "\ufeff" + json.dumps({"run": {"h": [0.5], "data": {"t": TIMES, "E": ENERGIES}}}, indent=1),
        json.dumps({"t": dict(enumerate(TIMES)), "E": dict(enumerate(ENERGIES))}),
        json.dumps({"t": TIMES, "E": ENERGIES} | dict.fromkeys("xva", 3 * [[1]])),
        array(t=TIMES, E=ENERGIES, h=0.5, x=np.zeros((90, 2, 3)), y=np.zeros(270), z=[1j] * 90),
        array(np.array([TIMES, ENERGIES]).T),
        array(np.rec.fromarrays([TIMES, ENERGIES, TIMES], names="t,E,x")),
        gzip.compress(rows("{t} {e}").encode()),
        lzma.compress(rows("{t} {e}").encode()),
        rows("{t}\t{e}").encode("utf-16"),
        TABLE.replace("-", "−"),
        json.dumps([{"t": t, "E": f"{e}"} for _, t, e, _ in SAMPLES]).replace("-", "−"),
        *(rows(form).replace(".", ",") for form in ("t={t} E={e} J", "t={t}, KE={k}, E={e}")),
        "t;E\n" + rows("{t};{e}").replace(".", ","),
        "| t | E |\n|---|---|\n" + rows("| {t} | {e} |"),
        "t,E\n" + rows('"{t}","{e}",'),
        "t;E;;\n" + rows("{t};{e};;") + ";;;\n",
        "".join(rows("t = {t}" + n % 3 * "\nE = 1" + "\nE = {e}", n, n + 1) for n in range(90)),
        "t E\n" + rows("{t} {e}\nwriting restart\nwrote file {n} at step {s}"),
        TABLE + "a note\n45,2 3\n",
        "id t E\n" + rows("{n} {t} {e}\n# {n} 5"),
        "t,E\n" + rows("{t},{e}\n,7"),
        "t E K\n"
        + rows("{t} {e} {k}").replace("\n9.0 ", "\nthe time passed\ntotal energy drift\n9.0 "),
        "".join(rows("t = {t}, E = {e}" + ", x = 1" * (n % 2), n, n + 1) for n in range(90)),
    ],
)
def test_text_documents_arrays_and_compressed_files_are_tables(data):
    (series,) = tables(data)
    assert list(series.times) == TIMES
    assert list(series.energies) == ENERGIES


def test_columns_of_inner_arrays_have_numbers():
    nines = [[*range(8), energy] for energy in ENERGIES]
    for data in (array(t=TIMES, e=nines), rows('{{"t": {t}, "e": [0,1,2,3,4,5,6,7,{e}]}}')):
        (series,) = tables(data, energy="10")
        assert columns(series) == "t, e_9"
        assert list(series.energies) == ENERGIES
    (series,) = tables(json.dumps({"e": nines}), energy="9")
    assert list(series.energies) == ENERGIES


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    ("head", "form", "ends"),
    [
        ("t,E\n", "{t},{e}", ("nan", "-nan(ind)", "1.#QNAN", "#NUM!", "overflow", "")),
        ("t E\n", "{t} {e}", ("-1.#IND", "+Infinity", "********", "overflow")),
        ("t E T\n", "{t} {e} 3", ("nan", "inf")),
        ("t\tE\n", "{t}\t{e}", ("nan", "")),
        ("t E\n", "{t}{e}", ("********",)),
        ("t E\n", "{t} {e}", ("(nan,nan)",)),
        ("", "t = {t}, E = {e}", ("nan", "-nan(ind)", "1.#QNAN", "********", "inf")),
    ],
)
def test_an_energy_that_ended_has_failed_however_it_is_written(head, form, ends):
    for end in ends:
        last = "".join(form.format(t=45 + n / 2, e=end) + "\n" for n in range(5))
        (series,) = tables(f"{head}{rows(form.replace('}{', '} {'))}a note\n{last}")
        assert (len(series.times), series.diverged_at) == (90, 45.0)


@pytest.mark.parametrize(
    ("text", "diverged_at", "skipped"),
    [
        (TABLE + "nan,nan\n", 44.5, 1),
        (TABLE + 200 * "nan,nan\n", 44.5, 200),
        *(
            (TABLE + 2 * f"{end},{end}\n", 44.5, 2)
            for end in ("#NUM!", "#N/A", "#NV", "#¡NUM!", "Err:502")
        ),
        (TABLE + "inf,-345\n", None, 1),
        ("t,E\n" + rows("{t},{e}\nnan,nan"), None, 90),  # one row divides others
        ("t,E\n" + rows("{t},{e}").replace("\n", "\nnan,nan\n", 1) + 2 * "nan,nan\n", 44.5, 3),
        ("t,E\n" + 2 * (rows("{t},{e}") + "nan,nan\n"), None, 1),
        (rows("t = {t}, E = {e}") + 2 * "t = nan, E = nan\n", 44.5, 2),
        (rows('{{"t": {t}, "a": {{"total": {e}}}}}') + '{"t": 45.0, "a": {"total": NaN}}', 45.0, 0),
        ("t K E\n" + rows("{t} 3 {e}") + "45.0 nan\n45.5 nan\n", 44.5, 2),
        ("t K E\n" + rows("{t} 3 {e}") + "45.0***********\n", 44.5, 1),
        ("t K E\n" + rows("{t} 3 {e}") + "45.0 3\n**********\n", 45.0, 1),
        ("K E t\n" + rows("{k} {e} {t}") + "3 4\n", None, 1),
        ("t K E\n" + rows("{t} 3 {e}") + "**********\ndone\n**********\n", None, 2),
        ("n t E\n" + rows("{n} {t} {e}") + 2 * "**********\n", 44.5, 2),
        ("ETITLE: t C E\n" + rows("ENERGY: {t} 1 {e}") + 2 * "ENERGY: 45.0 nan\n", 44.5, 2),
        ("t,E\n" + rows("{t},{e}\n{t}5,\n{t}6,"), None, 180),  # rarer
        (TABLE + "45.0,\n", None, 1),  # cut while it is written
        (TABLE + '45.0,"-345.12,5"\n', None, 1),  # no numbers
        (TABLE + "45.0,10.000-344\n", None, 1),
        (TABLE + "a note\n45.0\n45.5\n", None, 2),
        *((TABLE + f"{remark}\n51\n", None, 2) for remark in (3, 50)),
        (TABLE.replace("\n9.0", "".join(f"\n8.5,{n}" for n in range(20)) + "\n9.0"), None, 20),
        (TABLE + rows("3.0,{e}", 0, 8), None, 8),
        ("t E\n" + rows("{t} {e}") + "energy nan detected\n", None, 0),
        ("t = -1\n" + rows("E = {e}\nt = {t}\nt = {t}5"), None, 91),
        (TABLE + "45.0,\n45.5\n", 45.0, 0),
        ("n t E\n" + rows("{n} {t} {e}") + "90 45.0\n91 45.5\n", 45.0, 0),
    ],
)
def test_rows_at_the_end_without_time_or_energy_have_failed_unless_they_are_rarer(
    text, diverged_at, skipped
):
    series = tables(text)[-1]
    assert (len(series.times), series.diverged_at) == (90, pytest.approx(diverged_at))
    assert series.skipped == skipped


def test_a_number_alone_below_a_row_is_no_time_unless_it_is_later():
    (series,) = tables("x,E\n" + rows("{t},{e}", 0, 20) + "3\n" + rows("{t},{e}", 20))
    assert (columns(series), series.skipped) == ("x, E", 1)


@pytest.mark.parametrize("form", ["{t},{e}", "{t} {e}", "{t};{e:}", "t = {t}, E = {e}"])
def test_a_number_that_is_shorter_than_all_above_where_the_file_ends_is_cut(form):
    for end, samples, diverged_at in (
        ("-344.9", 90, None),
        ("-344.9\n", 91, None),
        ("-344.99999999999999", 91, None),
        (min(map(str, ENERGIES[-64:]), key=len), 91, None),
        ("nan", 90, 45.0),
        ("1E300", 90, 45.0),
    ):
        (series,) = tables(rows(form) + form.format(t=45.0, e=end))
        assert (len(series.times), series.diverged_at) == (samples, diverged_at)
        assert series.skipped == (end == "-344.9")
    few = rows(form, 1, 8) + form.format(t=45.0, e="-344.9")
    assert [len(series.times) for series in tables(few)] == [8]


OBJECTS = rows('{{"t": {t}, "E": {e}}}')


@pytest.mark.parametrize(
    ("text", "odd", "skipped"),
    [
        (OBJECTS, '{"t": 3', 2),
        (OBJECTS, '{"t": , "E": 5}', 2),
        (OBJECTS, "{broken", 2),
        ('{"t": 3\n{"t": ,}\n' + OBJECTS, '{"t": 3', 4),
        (OBJECTS, '{"event": "checkpoint", "at": [1, 2]}', 0),
        (OBJECTS, "a note", 0),
        (OBJECTS.replace(", ", ",\n"), "a note", 0),
        (OBJECTS, '{"k": -nan(ind), "p": +1.D+02}', 0),
        ("t,E,K,P\n" + rows("{t},{e},{k},{p}"), "a gap,,,", 2),
        (TABLE, "# a note, 5", 0),
        (TABLE, "# a note, b", 0),
        (TABLE, ",7", 2),
        (TABLE, "t,E", 0),
        ("t,E\n" + rows("{t},{e}", 0, 9) + "t,E\n" + rows("{t},{e}", 9), "a,b", 2),
        ("t E\n" + rows("{t} {e}"), "a note", 0),
        ("t E\n" + rows("{t} {e}"), "#NUM! #NUM!", 2),
    ],
)
def test_lines_that_look_like_rows_are_counted(text, odd, skipped):
    *lines, last, _ = text.split("\n")
    (series,) = tables("\n".join([*lines, odd, last, odd]))
    assert (list(series.energies), series.skipped) == (ENERGIES, skipped)


@pytest.mark.parametrize("nan", ["nan", "1.#QNAN"])
def test_printed_values_after_the_first_nan_are_nan_too(nan):
    text = rows(f"t = {{t}}, E = {nan}") + rows("t = 1{n:02}, E = {e}")
    with pytest.raises(UserError, match="at 40 "):
        tables(text, span=((40.0, ""),))


@pytest.mark.parametrize("odd", ["t = 1.2.3, E = 1", "t = -1-2, E = "])
def test_a_print_that_is_not_quite_like_the_others_leaves_them_in_place(odd):
    (series,) = tables(f"{odd}\n{rows('t = {t}, E = {e}')}{odd}\n{rows('t = 1{n:02}, E = {e}')}")
    assert list(series.energies[-90:]) == ENERGIES
    assert list(series.energies[-179:-91]) == ENERGIES[1:-1]


@pytest.mark.parametrize(
    ("kind", "unit", "others"),
    [
        ("time", "fs", "FS, femtosecond, Femto-seconds"),
        ("time", "ps", "picosecond, pico-seconds"),
        ("time", "ns", "nanosecond, nano-seconds"),
        ("time", "us", "microsecond, micro-seconds, µs, μs"),  # micro sign, and mu
        ("time", "s", "S, sec, second, seconds"),
        ("time", "yr", "year, years"),
        ("time", "a.u.", "au, atomic_unit"),
        ("energy", "hartree", "a.u., au, H, Ha, Eh, hartrees, atomic_unit"),
        ("energy", "eV", "electronvolt"),
        ("energy", "Ry", "rydberg, rydbergs"),
        ("energy", "kJ/mol", "kJ/mole, kJmol, kJ mol^-1, kJ.mol-1, kJ·mol⁻¹"),
        ("energy", "kcal/mol", "kcal/mole, kcal mol-1"),
    ],
)
def test_a_unit_has_one_name_however_it_is_written(kind, unit, others):
    assert {shown(kind, name) for name in others.split(", ")} == {unit}


def test_units_have_the_sizes_of_the_si():
    joule = {"j": 1, "erg": 1e-7, "ev": 1.602176634e-19, "mev": 1.602176634e-22}
    joule |= {"hartree": 4.3597447222060e-18, "ry": 2.1798723611030e-18}
    joule |= {"kj/mol": 1e3 / 6.02214076e23, "kcal/mol": 4184 / 6.02214076e23, "k": 1.380649e-23}
    assert {unit: 1.380649e-23 / size for unit, size in joule.items()} == pytest.approx(
        BOLTZMANN, rel=1e-9, abs=0
    )
    seconds = {"fs": 1e-15, "ps": 1e-12, "ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1}
    seconds |= {"yr": 365.25 * 86400, "a.u.": 1.054571817e-34 / joule["hartree"]}
    assert {unit: size * 1e9 for unit, size in seconds.items()} == pytest.approx(
        NANOSECONDS, rel=1e-9, abs=0
    )


HEAD = "   Step  Temp  TotEng\n"
LOOP = "Loop time of 1 on 1 procs for 1500 steps with 2000 atoms\n"


@pytest.mark.parametrize(
    "remark",
    [
        "WARNING: Too many warnings: 106 vs 100. All further ones are hidden\n",
        "SHAKE stats (type/ave/delta/count) on step 0\n  Bond:   4   1.1     1.4e-05        9\n",
        "WARNING: bond missing\nWARNING 12 13\n",
    ],
)
@pytest.mark.parametrize("asked", [(None, None), ("Step", "TotEng"), ("1", "3")])
def test_a_remark_below_the_head_is_a_remark(remark, asked):
    time, energy = asked
    (series,) = tables(HEAD + remark + rows("{s} {k} {e}"), time=time, energy=energy)
    assert columns(series) == "Step, TotEng"
    assert list(series.energies) == ENERGIES


def runs(head: str, form: str, between: str, again: int) -> str:
    """Return 40 rows, and the others from row `again` on below another head."""
    return head + rows(form, 0, 40) + between + head + rows(form, again)


def pages(head: str, form: str, again: int) -> str:
    """Return five pages of 18 rows and some of the page before."""
    return "".join(head + rows(form, max(at - again, 0), at + 18) for at in range(0, 90, 18))


NAMD = ("ETITLE: TS C E\n", "ENERGY: {s} 1 {e}")
CP2K = ("#   Step Nr.   Time[fs]   Cons Qty[a.u.]\n", "{n} {t} {e}", "")


@pytest.mark.parametrize(
    ("text", "lengths"),
    [
        (runs(HEAD, "{s} {k} {e}", LOOP, 39), [40, 51]),
        (runs(HEAD, "{s} {k} {e}", "# now NVE\n", 39), [40, 51]),
        (runs(*NAMD, "TCL: Running for 9\n", 40), [40, 50]),
        (runs(*NAMD, "TCL: Minimizing for 9\n", 40), [40, 50]),
        (runs(*CP2K, 30), [90]),
        (runs(*CP2K, 39), [90]),
        (rows("{e}", 0, 70) + "-1.0-1.0\n1\n1 2\n" + rows("{e}", 70), [71, 1, 20]),
        ("t,E\n" + rows("{t},{e}", 0, 40) + rows("{t},{e}"), [40, 90]),
        ("t,E\n" + rows("{t},{e}\n{t},{e}"), [1, 90]),
        (f"Step A C E\n{rows('{s} 1 2 {e}')}Step E\n1 2 3 4\nStep E\n{rows('{s} {e}')}", [90, 90]),
        ("a n t E\na 5 0.1-1.0\n" + rows("a 5 {t} -{k}").replace("7.0 ", "7.0"), [90]),
        ("DYNA DYN: Step  Time  E\n" + rows("DYNA> {n} {t} {e}\nAVER DYN: Step  Time  E"), [90]),
        (HEAD + rows("{s} {k} {e}", 0, 3) + LOOP + rows("Step = {s}\nTotEng = {e}"), [3, 90]),
        (rows("Step = {s}\nTotEng = {e}") + LOOP + HEAD + rows("{s} {k} {e}", 0, 3), [90, 3]),
        ("method,t,E\n" + rows("euler,{t},{e}", 0, 30) + rows("rk4,{t},{e}", 30), [30, 60]),
        ("t,E,solver\n" + rows("{t},{e},1\n{t}5,{e},1\n{t}6,{e},2\n{t}7,{e},2"), [360]),
        ("t,E,seed\n" + rows("{t},{e},{t}"), [90]),
        ("t,E,method\n0,-345,euler\n" + rows("{t},{e},leapfrog", 1), [90]),
        ("t,E,run\n" + rows("{t},{e},1", 0, 40) + rows("{t},{e},2", 40), [90]),
        ("t,E\nnan,-345\n" + rows("{t},{e}"), [90]),
        ("t,E,seed\n" + rows("{s},{e},1\n{s}.5,{e},1", 0, 80) + rows("{s},{e},2", 80), [160, 10]),
        (rows("seed={f} t={t} E={e}", 0, 8) + rows("seed=3 t={t} E={e}", 9), [8, 81]),
        (json.dumps({"a": {"t": TIMES, "E": ENERGIES}, "b": {"t": TIMES, "x": TIMES}}), [90]),
        (json.dumps({name: {"t": TIMES, "E": ENERGIES} for name in "ab"}), [90, 90]),
        (json.dumps({"a": {"t": TIMES, "E": ENERGIES}, "b": {"t": [8, 9], "E": [1, 2]}}), [2, 90]),
        (pages("\nETITLE: TS BOND TOTAL\n", "ENERGY: {s} 1.5 {e}", 0), [90]),
        (
            f"ETITLE: t C E\n{rows('A: {t} 1 {e}', 0, 40)}ETITLE: t C E\n"
            + rows("B: {t} 1 {e}", 40),
            [90],
        ),
        (pages("# new\nt,E\n", "{t},{e}", 1), [18, 19, 19, 19, 19]),
        (pages(rows("t E\n{s} {e}\nt K", 0, 1), "{t} {k}", 0), [1, 18] * 5),
        (pages("t E\n", "{t} {e}", 0) + "t E\n" + rows("{n} {t} {e}"), [90, 90]),
        ("| atom | mass |\n| 1 | 2.5 |\n| t | E |\n" + rows("| {t} | {e} |"), [90]),
    ],
)
def test_runs_are_parted_and_restarts_joined(text, lengths):
    assert [len(series.times) for series in tables(text)] == lengths


def test_what_follows_a_run_is_counted_and_told_with_it_and_a_new_head_is_read_anew():
    text = "t E\n" + rows("{t} {e}\nx y") + LOOP + "3 - 7\nERROR: lost\n"
    first, second = tables(f"{text}x y\n{rows('{t} {e}')}")
    assert (first.skipped, first.sheet.error) == (1, "ERROR: lost")
    assert (second.skipped, second.sheet.names) == (0, ["x", "y"])
    again = tables(TABLE + ",7\n,7\n" + rows("{t},{e}"))  # one table
    assert [(len(series.times), series.skipped) for series in again] == [(90, 2), (90, 0)]


@pytest.mark.parametrize(
    ("head", "asked", "found"),
    [
        ("# t Kin Pot\n# [ps] (eV) (eV)\n", ("t", "kin+pot"), "t ps, Kin+Pot eV"),
        ("# t Kin Pot\n# [] (eV) (eV)\n", ("t", "kin+pot"), "t, Kin+Pot eV"),
        ("Time[fs]  Kin.[a.u.]  Pot.[a.u.]\n", ("time", "Kin.+Pot."), "Time fs, Kin.+Pot. hartree"),
        ("t Kin[eV] Pot\n", ("t", "kin+pot"), "t, Kin+Pot"),
        ("", ("1", "2 + 3"), "column 1, column 2+column 3"),
        ("t E K\n1 2 3\nx y z\n", ("x", "y+z"), "x, y+z"),
    ],
)
def test_columns_are_named_or_numbered_and_added(head, asked, found):
    time, energy = asked
    form = "{t:.6E} {k} {p}" + " word" * (not head)
    *_, series = tables(head + rows(form).replace("E+", "D+"), time=time, energy=energy)
    assert columns(series) == found
    assert series.energies == pytest.approx(ENERGIES)


@pytest.mark.parametrize(
    ("form", "time", "energy", "doubts"),
    [
        ("{t},rk4,{e},NaN", "1", "3", []),
        ("t = {t}\nE1 = {k}\nE2 = {e}", "t", "E2", ["the total energy"]),
        ("t = {t}\nE.1 = {k}\nE.2 = {e}", "t", "E.2", ["the total energy"]),
    ],
)
def test_what_is_not_certain_is_read_by_number_or_name(form, time, energy, doubts):
    (series,) = tables(rows(form), time=time, energy=energy)
    assert list(series.energies) == ENERGIES
    assert [each.choice.doubt for each in tables(rows(form))] == doubts


@pytest.mark.parametrize(("head", "row"), [("t E\n", "{t} {E}"), ("", "t = {t} E = {E} J")])
def test_fortran_leaves_out_the_e_of_three_digits(head, row):
    (series,) = tables(head + rows(row.replace("{E}", "-4.52-107")))
    assert set(series.energies) == {-4.52e-107}


PICKLES = array(t=TIMES, E=np.array([{}, {}, {}], dtype=object))
PACKED = (
    b"\x1f\x8b\x08\0rest",
    b"BZhx",
    b"\x1f\x8b\x08" + bytes(7) + b"\xff",
    b"\xfd7zXZ" + bytes(9),
)
BROKEN = (
    *((each, "cannot be unpacked") for each in PACKED),
    (b"\x89MCAP0\r\n\0", "not text"),
    (b"x" * (1 << 21), "longer than 1 MB"),
    (PICKLES, "arrays cannot be read"),
    ("t,E\n" + "y\n" * 1002, "1,000 lines without a row"),
    ("1,1\n" * 20_001, "more than 20,000 lines"),
    ("1 2\n1\n" * 5, "more than 9 tables"),
    ('{"t": 1}\n' * 9000, "more than 80,000 characters"),
    ("t,E\n" + rows("{t},1", 0, 30) + rows("{t},1,1", 30), "the number of columns"),
    ("t,E\n" + rows("-{t},1"), "name the column of times"),
    ("t,E\n0,1\n9e9,1\n" + rows("{t},1", 1), "name the column of times"),
    ("t,E\n" + rows("{t},{e}\n{t},{k}"), "grep"),
    (rows("t = {t}\nEarth:\nE = {e}\nMoon:\nE = {k}") + "t = 45\n", "E has .* keep one of"),
    ("t E\n\n   1.0e+03 *\n\n" + rows("{t} {e}"), r"factor, 1.0e\+03"),  # MATLAB
    ("t,E\n" + rows("{t},{e}", 0, 70) + rows("3.0,{e}", 0, 8), "its last 8 rows .* thousands"),
    ("t,E\n" + rows("-0.1,inf\n{t},{e}"), "at -0.1 .* --from"),
    ("t E\n-0.5 (345)\n" + rows("{t} {e}"), r"^\(345\) may be negative"),
    ("t E\n" + rows("{t} {e}") + "45.0 (345)\n", r"\(345\) may be .* uncertainty"),
    (rows("t = {t}, E = {e} J\nE = {e} eV"), "E is in J, but in eV in line 2;"),
    ("t,E\n" + rows("{t},{e} mJ", 0, 70) + rows("{t},{e} J"), "E is in mJ, but in J in line 72"),
)
MISUSED = (
    (TABLE, {"energy": "E+t"}, "t is both the time and an energy"),
    ("t,K [J],P [eV]\n" + rows("{t},{k},{p}"), {"energy": "K+P"}, r"K\+P differ \(J, eV\)"),
    ("t,E [J]\n" + rows("{t},{e}"), {"units": {"energy": "eV"}}, "in J, not in eV; leave energy"),
    ("t,E [J],K [eV]\n" + rows("{t},{e},{k}"), {"kinetic": "K"}, r"K and the energy .* \(J, eV\)"),
    (TABLE, {"step": (0.5, "fs"), "time": "t"}, "t is a time already"),
    (TABLE, {"span": ((5.0, "fs"),)}, "the unit of time is not known"),
    (TABLE, {"span": ((5.0, ""), (4.0, ""))}, "no times from 5 to 4"),
    ("T (ps),E\n" + rows("{t},{e}"), {"step": (0.5, "fs")}, "T is a time already"),
)


@pytest.mark.parametrize(
    ("text", "wanted", "words"),
    [
        *MISUSED,
        *((text, {}, words) for text, words in BROKEN),
        (TABLE + 2 * "nan,nan\n", {"span": ((50.0, ""),)}, "0 to 44.5, none from 50 to inf"),
    ],
)
def test_what_cannot_be_read_or_judged_is_one_sentence(text, wanted, words, monkeypatch):
    limits = {"LINES_BEFORE": 1000, "LINES": 20_000, "DOCUMENT": 80_000, "TABLES": 9}
    for name, value in limits.items():
        monkeypatch.setattr(f"pendu_tui.tui.cli.reader.MAX_{name}", value)
    with pytest.raises(UserError, match=words) as error:
        tables(text, **wanted)
    assert error.value.code == (2 if (text, wanted, words) in MISUSED else 3)


@pytest.mark.parametrize("legends", [("Total Energy", "Potential"), ("Potential", "Total Energy")])
def test_each_set_of_xmgrace_has_its_own_legend(legends):
    names = "".join(f'@ s{place} legend "{name}"\n' for place, name in enumerate(legends))
    sets = {"Total Energy": rows("{t} {e}"), "Potential": rows("{t} {p}")}
    axes = '@ xaxis label "Time (ps)"\n@ yaxis label "(kJ/mol)"\n'
    found = tables(axes + names + "&\n".join(sets[name] for name in legends))
    (series,) = (each for each in found if not each.choice.doubt)
    assert columns(series) == "Time ps, Total Energy kJ/mol"
    assert list(series.energies) == ENERGIES
    (series,) = tables(axes + sets["Potential"])
    assert series.units == ("ps", "kJ/mol")


def test_a_unit_in_a_list_of_several_is_that_of_energies_alone():
    text = '@ xaxis label "Time (ps)"\n@ yaxis label "(kJ/mol), (K), (bar)"\n'
    text += '@ s0 legend "Temperature"\n@ s1 legend "Total Energy"\n' + rows("{t} {k} {e}")
    (series,) = tables(f"{text}45.0 -34")  # it was cut
    assert (series.units, series.skipped) == (("ps", "kJ/mol"), 1)
    assert [each.units for each in tables(text, energy="Temperature")] == [("ps", "")]
    assert [each.units for each in tables(text.replace("K", "eV"))] == [("ps", "")]


def test_what_the_owner_says_is_applied():
    (series,) = tables("t,E,K\n" + rows("{t},{e},{k}") + "45.0,-345,nan\n", kinetic="k")
    assert (list(series.kinetic), series.diverged_at) == ([k for *_, k in SAMPLES], 45.0)
    (series,) = tables(rows("{e}"), step=(2.0, "ps"), units={"energy": "eV"})
    assert (series.times[1], series.units) == (2.0, ("ps", "eV"))
    (series,) = tables("t,dE/E [%]\n" + rows("{t},{e}"), energy="dE/E")
    assert not series.holds_errors
    *_, series = tables(TABLE + "time,energy\n[ps],[eV]\n" + rows("{t},{e}"))
    assert (series.units, series.skipped) == (("ps", "eV"), 0)


def test_a_span_has_units_and_keeps_the_rows_at_its_ends():
    text = "t [ps],E\n" + rows("{t},{e}") + 2 * "nan,nan\n"
    (series,) = tables(text, span=((1.55e-11, "s"), (3.05e-11, "s")))
    assert (list(series.times), series.diverged_at) == (TIMES[31:62], None)


@pytest.mark.timeout(30)
@pytest.mark.parametrize("part", ["a ", "a", "1 ", "(a ", "=", "1,", '"a": ', '{"a":'])
def test_long_lines_take_no_longer_than_short_ones(part):
    assert tables(part * 50_000 + "\n") == []
    assert len(tables(f"a{20_000 * ' '}b\n1\n2\n")) == 1


@pytest.mark.parametrize(
    "text",
    [
        *("{}", "[]", "[[]]", '{"a": ' * 5000, "[" * 5000, "null", "- [ ]\n"),
        *("t,E\n1,\n2,\n", "E = 1\nE = 2\nt = 1\nt = 2\nt = 3\n"),
    ],
)
def test_documents_without_a_table_hold_none(text):
    assert [len(series.times) for series in tables(text)] == []


def test_a_name_may_have_a_plus_and_its_unit_counts_before_its_case_does_not():
    assert find(("t", "KE+PE"), "KE+PE") == (1,)
    assert find(("E (eV)", "E (J)", "e"), "e (j)") == (1,)
    assert find(("E (eV)", "E (J)", "e"), "E") == (2,)
    assert find(("", "E"), "2+") is None
    assert find(("t", "E - E0"), "E − E0") == (1,)


def test_a_column_that_is_named_as_the_energy_is_not_guessed_as_the_time():
    table = (("a", "b"), ("", ""), [(0, 1, 2), (3, 4, 5.0009)])
    assert choose(*table, Wanted(energy="1"))[:2] == ((1,), (0,))
    assert choose(*table[:2], [(0, 1, 2), (3, 4, 5.0011)], Wanted(energy="1")).time == ()
    assert choose(*table, Wanted(step=(1.0, ""))).doubt == "the total energy"
    assert choose(*table, Wanted()).doubt == "the time and the total energy"
    assert [len(series.times) for series in tables(TABLE, energy="x")] == [90]


def test_few_rows_do_not_tell_what_belongs_to_an_energy_but_where_it_ended():
    for names, energy, *samples in (
        (("KE", "PE", "x"), (1, 2), (1, 2), (-1, -3), (5, 6)),
        (("KE", "PE", "x"), (1, 2), (0, 3, 0), (9, 9, 9), (0, -1.4, 0)),
        (("KE", "PE", "x"), (), (0, 3, 0), (9, 9, 9), (0, -1.6, 0)),  # less than half is left
        (("x", "E"), (2,), (5, 6, 1), (345, 346, 344)),  # whole, but no count
        (("x", "E"), (), (5, 6, 1), (0, 2, 3)),
        (("x", "E"), (2,), (5, 6, 1), 2 * (1, 1, -1)),
        (("x", "E"), (), (5, 6, 1), 3 * (1, 1, -1)),  # a field
    ):
        columns = [range(len(samples[-1])), *samples]
        assert choose(("t", *names), ["" for _ in columns], columns, Wanted()).energy == energy
    (series,) = tables("t,E\n" + rows("{t},{e}", 0, 9) + "4.5,\n5.0\n")
    assert (series.diverged_at, series.skipped) == (4.5, 0)
