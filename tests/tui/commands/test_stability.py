"""`pendu-tui stability`: tables and maps."""

import pytest

from tests.tui.command_line import pendu


def line_of(out, *words):
    (line,) = (line for line in out.splitlines() if all(word in line for word in words))
    return line.split()


def test_a_file_holds_what_its_form_prints(tmp_path):
    file = tmp_path / "map.json"
    small = ("stability", "--steps", 30, "--z-values", "0.5,2.5", "--theta-values", "0.5,2")
    assert pendu(*small, "-o", file).code == 0
    assert pendu(*small, "--json").out == file.read_text(encoding="utf-8")


def test_a_start_that_is_no_amplitude_is_given_one():
    def out(*start):
        return pendu("stability", *start, "--methods", "verlet", "--steps", 20).out

    row = line_of(out("--theta", "200deg"), " 160° ")
    assert float(row[-1]) == pytest.approx(float(row[3]) / 0.1566, rel=2e-3)  # the margin
    # omega²/2 = w0² (1 - cos amplitude)
    assert line_of(out("--theta", "0", "--omega", "2"), " 37.24° ")
    assert line_of(out("--theta", "5.73deg"), " 5.73° ")
    amplitudes = [out(*start).count("°") for start in (("--theta", "0"), ("--scene", "spin"))]
    assert amplitudes == [5, 5]
