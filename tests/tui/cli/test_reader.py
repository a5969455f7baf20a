"""The reader of energy logs: what is a table, a run, a column, a unit, an energy that ended."""

import bz2
import gzip
import io
import json
import lzma
import math

import numpy as np
import pytest

from pendu_tui.tui.cli.errors import UserError
from pendu_tui.tui.cli.reader import read_sheets
from pendu_tui.tui.cli.tables import Series, Wanted
from pendu_tui.tui.cli.units import BOLTZMANN, NANOSECONDS

HEAD = "   Step  Temp  TotEng\n"
LOOP = "Loop time of 1 on 1 procs for 1500 steps with 2000 atoms\n"
SAMPLES = [(n, n / 2, -345 + math.sin(n) / 100, 20 + math.cos(n)) for n in range(90)]


def rows(form: str, samples=SAMPLES) -> str:
    """Return lines with step s = 50 n, time t, energy e, kinetic energy k, potential energy p."""
    return "".join(
        form.format(n=n, s=50 * n, t=t, e=e, k=k, p=e - k) + "\n" for n, t, e, k in samples
    )


def tables(data: str | bytes, **wanted) -> list[Series]:
    """Return the tables of a file, finished."""
    stream = io.BytesIO(data.encode() if isinstance(data, str) else data)
    sheets = read_sheets(io.BufferedReader(stream), Wanted(**wanted))
    found = [series for sheet in sheets for series in sheet.series()]
    for series in found:
        if series.choice.energy:
            series.finish()
    return found


def columns(series: Series) -> str:
    groups = (series.choice.time, series.choice.energy)
    units = zip(map(series.named, groups), series.units, strict=True)
    return ", ".join(f"{name} {unit}".strip() for name, unit in units)


@pytest.mark.parametrize(
    ("head", "found"),
    [
        ("t,E", "t, E"),
        ("time_ps,total_energy_eV", "time ps, total_energy eV"),
        ("Time ps,E [eV]", "Time ps, E eV"),
        ("time{picosecond},Etot/N[electronvolt]", "time ps, Etot/N eV"),
        ("Time [a.u.],Cons Qty [a.u.]", "Time a.u., Cons Qty hartree"),
        ("# TimeStep,v_etot", "TimeStep, v_etot"),
        ("Simulation.timestep,log.total_energy", "Simulation.timestep, log.total_energy"),
        ("t,|dE/E|", "t, |dE/E|"),
        ("t,(E-E0)/E0", "t, (E-E0)/E0"),
        ("T,energy", "T, energy"),  # it increases
    ],
)
def test_time_and_energy_are_known_by_name_and_their_units_with_them(head, found):
    assert [columns(each) for each in tables(f"{head}\n{rows('{t},{e}')}")] == [found]


@pytest.mark.parametrize(
    ("head", "form", "energy"),
    [
        ("t,E,total,conserved", "{t},{k},{k},{e}", "conserved"),
        ("t,energy,Total Energy", "{t},{k},{e}", "Total Energy"),
        ("t,KE,PE", "{t},{k},{p}", "KE+PE"),
        ("t,KE (eV),PE (eV)", "{t},{k},{p}", "KE+PE"),
        ("t,E,dE/E", "{t},{e},{k}", "E"),
        ("T,t,E", "300,{t},{e}", "E"),
        ("t,E,p", "{t},{e},word", "E"),
        ("t,total,Total Energy", "{t},{k},{e}", None),
        ("t,KE (eV),PE (J)", "{t},{k},{p}", None),
        ("t,E1,E2", "{t},{k},{e}", None),
        ("t,energy (ps)", "{t},{e}", None),
        ("x,E", "{k},{e}", "E"),  # no column increases: a row is a unit of time
        ("x,y,E", "{t},{s},{e}", None),
    ],
)
def test_the_conserved_energy_is_guessed_only_where_names_leave_no_doubt(head, form, energy):
    (series,) = tables(f"{head}\n{rows(form)}")
    if energy is None:
        assert series.choice.doubt
    else:
        assert (series.choice.doubt, series.named(series.choice.energy)) == ("", energy)


@pytest.mark.parametrize(
    ("form", "is_certain"),
    [("{e}", True), ("{t} {e}", True), ("{k} {p}", False), ("{t} {k} {e}", False)],
)
def test_columns_without_names_are_known_if_there_is_one_energy(form, is_certain):
    (series,) = tables(rows(form))
    assert bool(series.choice.doubt) != is_certain
    if is_certain:
        assert list(series.energies) == [e for _, _, e, _ in SAMPLES]


@pytest.mark.parametrize(
    ("form", "units"),
    [
        ("t = {t} E = {e}", ", "),
        ("Step {n}: time: {t} ps, energy: {e} eV", "ps, eV"),
        ("[{n}/90] step {s}, time {t}, energy {e}", ", "),
        ("Time (ps): {t} | Energy (eV): {e} | dE = 1e-3", "ps, eV"),
        ("INFO t={t}s E={e}J", "s, J"),
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
    assert list(series.times) == [t for _, t, _, _ in SAMPLES]
    assert list(series.energies) == [e for _, _, e, _ in SAMPLES]


TIMES = [t for _, t, _, _ in SAMPLES]
ENERGIES = [e for _, _, e, _ in SAMPLES]


def array(**named: object) -> bytes:
    file = io.BytesIO()
    if "" in named:
        np.save(file, named[""])
    else:
        np.savez(file, **named)
    return file.getvalue()


@pytest.mark.parametrize(
    "data",
    [
        json.dumps({"run": {"h": 0.5, "data": {"t": TIMES, "E": ENERGIES}}}, indent=1),
        json.dumps([{"t": t, "E": e} for _, t, e, _ in SAMPLES], indent=1),
        json.dumps({"t": dict(enumerate(TIMES)), "E": dict(enumerate(ENERGIES))}),
        array(t=TIMES, E=ENERGIES, h=0.5, x=np.zeros((90, 2, 3))),
        array(**{"": np.array([TIMES, ENERGIES]).T}),
        array(**{"": np.rec.fromarrays([TIMES, ENERGIES], names="t,E")}),
        gzip.compress(rows("{t} {e}").encode()),
        bz2.compress(rows("{t} {e}").encode()),
        lzma.compress(rows("{t} {e}").encode()),
        rows("{t}\t{e}").encode("utf-16"),
        "t;E\n" + rows("{t:};{e:}").replace(".", ","),
        "| t | E |\n|---|---|\n" + rows("| {t} | {e} |"),
        "t,E\n" + rows('"{t}","{e}",'),
    ],
)
def test_documents_arrays_and_compressed_files_are_tables(data):
    (series,) = tables(data)
    assert list(series.times) == TIMES
    assert list(series.energies) == ENERGIES


@pytest.mark.parametrize(
    "end",
    [*("nan", "-nan(ind)", "1.#QNAN", "-1.#IND", "+Infinity", "********", "#NUM!"), "overflow", ""],
)
@pytest.mark.parametrize("form", ["{t},{e}", "{t} {e}", "t = {t}, E = {e}"])
def test_an_energy_that_ended_has_failed_however_it_is_written(end, form):
    if end == "" and form != "{t},{e}":
        pytest.skip("blanks are no fields")
    head = "" if "=" in form else form.replace("{t}", "t").replace("{e}", "E") + "\n"
    last = "".join(form.format(t=45 + n / 2, e=end) + "\n" for n in range(5))
    (series,) = tables(head + rows(form) + last)
    assert (len(series.times), series.failed_at) == (90, 45.0)


def test_a_field_that_is_too_small_may_touch_the_one_before():
    (series,) = tables("t E\n" + rows("{t} {e}") + "45.0*********\n45.5*********\n")
    assert (len(series.times), series.failed_at) == (90, 45.0)


def test_energies_that_are_only_rarer_have_not_failed():
    (series,) = tables("t,E\n" + rows("{t},{e}\n{t}5,\n{t}6,"))
    assert (len(series.times), series.failed_at) == (90, None)
    assert series.skipped["without_numbers"] == 180


@pytest.mark.parametrize(("end", "failed_at"), [("45.0,\n", None), ("45.0,\n45.5,\n", 45.0)])
def test_one_row_may_be_cut_while_it_is_written(end, failed_at):
    (series,) = tables("t,E\n" + rows("{t},{e}") + end)
    assert (len(series.times), series.failed_at) == (90, failed_at)


def test_printed_values_after_the_first_nan_are_nan_too():
    stream = io.BytesIO((rows("t = {t}, E = nan") + rows("t = 1{n:02}, E = {e}")).encode())
    (sheet,) = read_sheets(io.BufferedReader(stream), Wanted())
    (series,) = sheet.series()
    series.finish(40.0)
    assert series.failed_at == 40.0


def test_names_that_differ_in_a_digit_are_columns_of_their_own():
    (series,) = tables(rows("t = {t}\nE1 = {k}\nE2 = {e}"), energy="E2")
    assert list(series.energies) == ENERGIES


def test_a_print_with_more_numbers_than_others_leaves_them_in_place():
    text = rows("t = {t}, E = {e}") + "t = 45-46, E = 1\n" + rows("t = 1{n:02}, E = {e}")
    (series,) = tables(text)
    assert list(series.energies) == [*ENERGIES, 1, *ENERGIES]


def test_words_that_were_no_head_may_be_one_later():
    early = "Step A B TotEng\n" + rows("{s} {k} {k} {e}", SAMPLES[:70]) + "Step TotEng\n1 2 3 4\n"
    found = tables(early + "Step TotEng\n" + rows("{s} {e}"))
    assert list(found[-1].energies) == ENERGIES


def test_lines_of_text_between_the_rows_are_passed_over():
    text = "t E\n" + rows("{t} {e}\nwriting restart\nwrote file {n} at step {s}")
    (series,) = tables(text)
    assert list(series.energies) == ENERGIES


def test_units_have_the_sizes_of_the_si():
    joule = {"j": 1, "erg": 1e-7, "ev": 1.602176634e-19, "mev": 1.602176634e-22}
    joule |= {"hartree": 4.3597447222060e-18, "ry": 2.1798723611030e-18}
    joule |= {"kj/mol": 1e3 / 6.02214076e23, "kcal/mol": 4184 / 6.02214076e23, "k": 1.380649e-23}
    assert {unit: 1.380649e-23 / size for unit, size in joule.items()} == pytest.approx(BOLTZMANN)
    seconds = {"fs": 1e-15, "ps": 1e-12, "ns": 1e-9, "us": 1e-6, "µs": 1e-6, "ms": 1e-3, "s": 1}
    seconds |= {"yr": 365.25 * 86400, "a.u.": 1.054571817e-34 / joule["hartree"]}
    assert {unit: size * 1e9 for unit, size in seconds.items()} == pytest.approx(NANOSECONDS)


@pytest.mark.parametrize(
    "remark",
    [
        "WARNING: Too many warnings: 106 vs 100. All further ones are hidden\n",
        "SHAKE stats (type/ave/delta/count) on step 0\n  Bond:   4   1.1     1.4e-05        9\n",
        "WARNING: bond missing\nWARNING 12 13\n",
    ],
)
@pytest.mark.parametrize("asked", [{}, {"time": "Step", "energy": "TotEng"}])
def test_a_remark_below_the_head_is_a_remark(remark, asked):
    (series,) = tables(HEAD + remark + rows("{s} {k} {e}"), **asked)
    assert list(series.energies) == ENERGIES


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ('"t" "E"\n' + rows('"{n}" {t} {e}'), "t, E"),  # R
        ("Time (ps) Etot\n" + rows("{s} {t} {e}"), "Time ps, Etot"),
        ("  t     E\n" + rows("{n:<4} {t} {e}"), "t, E"),  # pandas
        ("Time Etot\n" + rows("{t} {e} {k}"), None),
        ("Time Etot\n" + rows("{n} {s} {t} {e}"), None),
    ],
)
def test_a_head_of_another_width_is_matched_by_the_values_or_not_at_all(text, found):
    (series,) = tables(text)
    assert (columns(series) if not series.choice.doubt else None) == found


CP2K = "#   Step Nr.   Time[fs]   Cons Qty[a.u.]\n"
XVG = '@ xaxis label "Time (ps)"\n@ yaxis label "(kJ/mol)"\n'


@pytest.mark.parametrize(
    ("text", "lengths"),
    [
        (
            HEAD
            + rows("{s} {k} {e}", SAMPLES[:40])
            + LOOP
            + HEAD
            + rows("{s} {k} {e}", SAMPLES[39:])
            + LOOP,
            [40, 51],
        ),
        (
            HEAD
            + rows("{s} {k} {e}", SAMPLES[:40])
            + "# now NVE\n"
            + HEAD
            + rows("{s} {k} {e}", SAMPLES[39:]),
            [40, 51],
        ),
        (CP2K + rows("{n} {t} {e}", SAMPLES[:40]) + CP2K + rows("{n} {t} {e}", SAMPLES[30:]), [90]),
        (CP2K + rows("{n} {t} {e}", SAMPLES[:40]) + CP2K + rows("{n} {t} {e}", SAMPLES[39:]), [90]),
        (CP2K + rows("{n} {t} {e}", SAMPLES[:40]) + CP2K + rows("{n} {t} {e}", SAMPLES[40:]), [90]),
        (rows("{e}", SAMPLES[:70]) + "-1.0-1.0\n1\n1 2\n" + rows("{e}", SAMPLES[70:]), [71, 1, 20]),
        ("t,E\n" + rows("{t},{e}", SAMPLES[:40]) + rows("{t},{e}"), [40, 90]),
        (
            HEAD + rows("{s} {k} {e}", SAMPLES[:3]) + LOOP + rows("Step = {s}\nTotEng = {e}"),
            [3, 90],
        ),
    ],
)
def test_runs_are_parted_and_restarts_joined(text, lengths):
    assert [len(series.times) for series in tables(text)] == lengths


@pytest.mark.parametrize(
    ("head", "asked", "found"),
    [
        ("# t Kin Pot\n# [ps] (eV) (eV)\n", ("t", "kin+pot"), "t ps, Kin+Pot eV"),
        ("Time[fs]  Kin.[a.u.]  Pot.[a.u.]\n", ("time", "Kin.+Pot."), "Time fs, Kin.+Pot. hartree"),
        ("t,Kin,Pot\n", ("1", "2+3"), "t, Kin+Pot"),
        ("", ("1", "2+3"), "column 1, column 2+column 3"),
    ],
)
def test_columns_are_named_or_numbered_and_added(head, asked, found):
    time, energy = asked
    (series,) = tables(head + rows("{t:.6E} {k} {p}").replace("E+", "D+"), time=time, energy=energy)
    assert columns(series) == found
    assert series.energies == pytest.approx(ENERGIES)


def test_a_head_on_each_page_does_not_begin_a_table():
    pages = (rows("ENERGY: {s} 1.5 {e}", SAMPLES[at : at + 20]) for at in range(0, 90, 20))
    text = "".join(f"ETITLE: TS BOND TOTAL\n{page}\n" for page in pages)
    assert [len(series.times) for series in tables(text)] == [90]


@pytest.mark.parametrize("legends", [("Total Energy", "Potential"), ("Potential", "Total Energy")])
def test_each_set_of_xmgrace_has_its_own_legend(legends):
    names = "".join(f'@ s{place} legend "{name}"\n' for place, name in enumerate(legends))
    sets = {"Total Energy": rows("{t} {e}"), "Potential": rows("{t} {p}")}
    found = tables(XVG + names + "&\n".join(sets[name] for name in legends))
    (series,) = (each for each in found if not each.choice.doubt)
    assert columns(series) == "Time ps, Total Energy kJ/mol"
    assert list(series.energies) == ENERGIES


def test_a_unit_in_a_list_of_several_is_that_of_energies_alone():
    label = XVG.replace("(kJ/mol)", "(kJ/mol), (K), (bar)")
    legends = '@ s0 legend "Temperature"\n@ s1 legend "Total Energy"\n'
    text = label + legends + rows("{t} {k} {e}")
    assert [each.units for each in tables(text)] == [("ps", "kJ/mol")]
    assert [each.units for each in tables(text, energy="Temperature")] == [("ps", "")]


def test_steps_and_units_of_the_owner_are_applied():
    text = HEAD + rows("{s} {k} {e}")
    (series,) = tables(text, step=(0.5, "fs"), units={"energy": "eV"})
    assert (series.times[1], series.units) == (25.0, ("fs", "eV"))
    (series,) = tables(rows("{e}"), step=(2.0, "ps"))
    assert (series.times[1], series.units) == (2.0, ("ps", ""))
    with pytest.raises(UserError, match="is a time already"):
        tables("Time (ps),E\n" + rows("{t},{e}"), step=(0.5, "fs"))


@pytest.mark.timeout(30)
@pytest.mark.parametrize(
    "line",
    ["a " * 400_000, "a" * 900_000, "1 " * 400_000, "(a " * 300_000, "=" * 900_000, "1," * 400_000],
)
def test_long_lines_take_no_longer_than_short_ones(line):
    assert tables(f"{line}\n" * 3) == []


@pytest.mark.parametrize("text", ["{}", "[]", "[[]]", '{"a": ' * 5000, "[" * 5000, "null"])
def test_documents_without_a_table_hold_none(text):
    assert [len(series.times) for series in tables(text)] == []
