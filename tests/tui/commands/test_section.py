"""`stability --section`: the phase portrait of a method's own map, and the orbits of the scene's start."""

import math

import pytest

from tests.tui.command_line import own_method, pendu


def section(*arguments):
    return pendu("stability", "--section", *arguments)


ISLANDS = ("--theta", "1.25", "--h", "0.348011")  # at the 1:6 resonance of velocity Verlet
FEW = ("--starts", 40, "--steps", 1000)


def test_the_picture_is_as_wide_as_the_terminal_and_the_table_has_the_orbits(monkeypatch):
    monkeypatch.setenv("COLUMNS", "90")
    lines = section(*ISLANDS, "--starts", 40).out.splitlines()
    end = next(number for number, line in enumerate(lines) if line.startswith("-pi"))
    assert max(map(len, lines[1 : end + 1])) == 90
    rows = {line[:17].strip(): line[17:].split() for line in lines[end + 3 : -2]}
    assert rows["Velocity Verlet"][:5] == ["islands", "1:6", "0.1666667", "6", "1:6"]
    assert rows["RK4"][:2] == ["spirals", "inwards"]
    assert rows["Explicit Euler"][:5] == ["spirals", "outwards", "-", "-", "-"]


def test_json_has_the_rotation_numbers_and_lyapunov_numbers_of_the_start():
    answer = section(*ISLANDS, "--json").json
    verlet = next(row for row in answer["orbits"] if row["method"] == "velocity_verlet")
    assert verlet["rotation"] == pytest.approx(1 / 6, abs=1e-9)
    assert (verlet["fraction"], verlet["island"], verlet["chaotic"]) == ("1:6", True, False)
    assert 0 < verlet["lyapunov"] < 0.01
    small = section("--theta", "1e-4", "--h", "0.2", "--methods", "verlet", "--json").json
    assert small["orbits"][0]["rotation"] == pytest.approx(
        2 * math.asin(small["z"] / 2) / math.tau, abs=1e-6
    )
    (chaotic,) = pendu(
        "stability",
        "--section",
        "--theta",
        "2.3",
        "--h",
        "0.351203",
        "--methods",
        "verlet",
        "--json",
    ).json["orbits"]
    assert (chaotic["rotation"], chaotic["fraction"], chaotic["chaotic"]) == (None, None, True)


@pytest.mark.parametrize("theme", ["dark", "light", "ansi"])
def test_the_file_is_the_same_every_time_and_has_the_size_asked_for(theme, tmp_path):
    command = (*ISLANDS, *FEW, "--size", "70x20", "--theme", theme, "-o")
    one, two = tmp_path / "one.txt", tmp_path / "two.txt"
    for file in (one, two):
        assert section(*command, file).out.startswith(f"{file}: Velocity Verlet")
    assert one.read_bytes() == two.read_bytes()
    assert len(one.read_text(encoding="utf-8").splitlines()) == 21


def test_pixels_and_methods_can_be_chosen(tmp_path):
    file = tmp_path / "map.txt"
    assert (
        section(*ISLANDS, *FEW, "--pixels", "ascii", "--methods", "rk4,verlet", "-o", file).code
        == 0
    )
    assert file.read_text(encoding="utf-8").isascii()
    assert file.read_text(encoding="utf-8").startswith("RK4, h")


def test_one_may_draw_a_method_of_ones_own(tmp_path):
    own = ("--method", own_method(tmp_path), "--methods", "symplectic_euler")
    answer = section(*ISLANDS, *own, "--json").json
    theirs, mine = answer["orbits"]
    assert (theirs["method"], mine["method"]) == ("symplectic_euler", "mine")
    assert {**mine, "method": ""} == {**theirs, "method": ""}  # the same formulas
    assert section(*FEW, *own[:2], "--methods", "mine").out.startswith("Mine, h")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--starts", "0"), ("--starts", "1 or more")),
        (("--starts", "20000"), ("--starts 20000", "at most 10000")),
        (("--steps", "200000"), ("--steps 200000", "at most 100000")),
        (("-o", "map.jpg"), ("map.jpg", "map.svg")),
        (("--size", "3x3"), ("'3x3' is not a size", "120x40")),
        (("--h", "0"), ("h",)),
    ],
)
def test_what_cannot_be_is_one_sentence(words, said):
    assert section(*words).refused(2, *said)
