import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.scenes import DEFAULT_SCENE, SCENES, Scene, SceneError
from tui.cli.errors import UserError
from tui.cli.options import Parser, angle
from tui.cli.scene import add_scene_options, scene_of


def scene_from(*arguments: str) -> Scene:
    parser = Parser(prog="pendu-tui test")
    add_scene_options(parser)
    return scene_of(parser.parse_args(list(arguments)))


def test_without_options_the_scene_is_the_default_one():
    assert scene_from() == DEFAULT_SCENE


def test_options_override_the_scene_and_its_name_becomes_custom():
    scene = scene_from("--scene", "spin", "--omega", "7", "--h", "0.01")
    assert (scene.name, scene.theta, scene.omega, scene.h) == ("custom", 0.0, 7.0, 0.01)


def test_an_option_equal_to_the_scenes_value_keeps_the_scenes_name():
    assert scene_from("--scene", "crossover", "--h", "0.2") == SCENES["crossover"]


def test_degrees_become_radians():
    assert angle("115deg") == angle("115°") == math.radians(115)
    assert angle("-90deg") == -math.pi / 2
    assert angle("2") == angle("2rad") == 2.0


@pytest.mark.parametrize("theta", ["170", "-170"])
def test_a_large_angle_without_unit_gets_a_hint_about_degrees(theta, capsys):
    assert scene_from("--theta", theta).theta == float(theta)
    assert f"for degrees write {theta}deg." in capsys.readouterr().err


@pytest.mark.parametrize("theta", ["170deg", "1000deg", "170rad", "6.28", "-6.28"])
def test_an_angle_with_a_unit_or_below_one_turn_gets_no_hint(theta, capsys):
    scene_from("--theta", theta)
    assert capsys.readouterr().err == ""


@given(st.floats(-1e9, 1e9))
def test_every_finite_theta_and_omega_can_be_given(value):
    scene = scene_from("--theta", repr(value), "--omega", repr(value))
    assert (scene.theta, scene.omega) == (value, value)


@pytest.mark.parametrize("text", ["-1", "-1e-3", "-.5", "-0"])
def test_a_negative_number_after_an_option_is_its_value(text):
    assert scene_from("--omega", text) == scene_from(f"--omega={text}")


@pytest.mark.parametrize(
    "arguments",
    [
        ("--h", "0"),
        ("--h", "-0.05"),
        ("--length", "0"),
        ("--gravity", "0"),
        ("--theta", "inf"),
        ("--omega", "nan"),
    ],
)
def test_a_number_out_of_range_is_refused_with_its_name_and_range(arguments):
    with pytest.raises(SceneError, match=arguments[0].removeprefix("--")):
        scene_from(*arguments)


@pytest.mark.parametrize(
    "arguments", [("--theta", "abc"), ("--theta", "5grad"), ("--h", "small"), ("--omega", "")]
)
def test_text_that_is_not_a_number_is_refused_with_an_example(arguments):
    with pytest.raises(UserError, match=r"is not an? (angle|number); use for example"):
        scene_from(*arguments)


def test_an_unknown_scene_is_answered_with_the_nearest_one():
    with pytest.raises(UserError, match="did you mean near-separatrix"):
        scene_from("--scene", "near-seperatrix")


def test_a_scene_name_with_an_escape_sequence_is_not_printed_raw():
    with pytest.raises(UserError) as refusal:
        scene_from("--scene", "\x1b[31mred")
    assert "\x1b" not in str(refusal.value)
