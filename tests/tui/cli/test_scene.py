"""--scene FILE.toml: the fields of scenes --json, and errors that name line and field."""

import math
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest

from pendu_tui.engine.scenes import SCENES, Line, Shot
from pendu_tui.tui.cli.scene import _SCENE, _SHOT, _example, read_scenes, scene_text
from tests.tui.command_line import EULER, own_method, pendu


@pytest.fixture
def mine(tmp_path):
    return tmp_path / "mine.toml"


def toml(fields):
    return "\n".join(f"{name} = {value!r}" for name, value in fields.items())


def read_scene(path, text):
    path.write_text(text, encoding="utf-8")
    read_scenes.cache_clear()
    (scene,) = read_scenes(path).values()
    return scene


def test_a_listed_scene_as_json_or_toml_is_read_to_the_last_bit(mine):
    for listed, scene in zip(
        pendu("scenes", "--json").json["scenes"], SCENES.values(), strict=True
    ):
        again = read_scene(mine, toml(listed))
        assert (again, again.speed) == (replace(scene, often_said=""), scene.speed)
        again = read_scene(mine, scene_text(scene))
        assert again == replace(scene, often_said="")
        assert scene_text(scene).isascii() == scene.watch.isascii()
        assert ("\n\n[shot]\n" in scene_text(scene)) == (scene.shot != Shot())
        assert f"theta = {scene.theta!r}\n" in scene_text(scene)
        assert (again.speed, again.shot) == (scene.speed, scene.shot)
    for theta in (7.0, -7.0):  # more than a turn, which needs a unit
        assert read_scene(mine, scene_text(SCENES["drift"].altered(theta=theta))).theta == theta


def test_without_methods_it_has_those_that_are_for_its_model(mine):
    for name in ("drift", "stiff-slow", "damped", "linear"):
        fields = {key: value for key, value in SCENES[name].fields().items() if key != "methods"}
        assert read_scene(mine, toml(fields)).cast == SCENES[name].cast


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("h = 0.1\nthetta = 1", "line 2: there is no field 'thetta': did you mean theta?"),
        ("h = 0.1\n\nspeed = '2s'", "line 3: speed: '2s' is not a number"),
        ("h = -1", "line 1: h = -1 s is not a usable step"),
        ("theta = 170", "line 1: theta: 170 is 27.1 turns; write 170deg or 170rad"),
        ("model = 'cubic'", "line 1: there is no model 'cubic'; choose from pendulum"),
        ("theta = 1\nmethods = ['rk5']", "line 2: "),
        ("h = 0.1\nmethods = []", "line 2: no method is given"),
        ("[shot]\nlog = true\nfront = ['rk5']", "line 3: there is no method 'rk5'"),
        (f"theta = {5000 * '['}", "is not TOML"),
        ("model = 'spring'", "mine.toml: stiffness = 0"),  # no line has the field
        ("", "no scene"),
        *((f"scene = {each}", "no scene") for each in ("[]", "1", "[{h = 1}, 1]", "[{}, {h = 1}]")),
        ("scene = [{h = 1}, {h = 2}, {h = 'x'}]", "line 1: h: 'x' is not a time"),
        ("[shot]\n\nlog = 1", "line 3: log: Expected `bool`, got `int`; use, for example, log = "),
        ("shot = 1", "line 1: shot: Expected `object`, got `int`; use, for example, [shot]"),
        ("[shot]\nquantity = 'eror'", "line 2: there is no quantity 'eror'"),
        ("[shot]\nview = 'phse'", "line 2: there is no view 'phse': did you mean phase?"),
        (
            "[[scene]]\nh = 0.1\n[scene.shot]\ntheta = 1\n [[scene]]\ntheta = 'x'",
            "line 6: theta: 'x' is not an angle",
        ),
        ("[[scene]]\ntheta = 1\n[scene.shot]\ntheta = 'x'", "line 4: theta: 'x' is not an angle"),
        ("[[scene]]\nname = 'a'\n[[scene]]\nname = 'a'", "line 4: there are two scenes named a"),
        ("from = 'drfit'", "line 1: there is no scene 'drfit': did you mean drift?"),
        ("[shot]\nmoment = -1", "line 2: moment: '-1' is out of range; use 0 to 3600 s"),
        ("[shot]\nreturns = true", "line 2: returns needs a moment; use, for example,"),
        ("[shot]\nquestion = 'Why?'", "line 2: question needs a moment; use, for example,"),
        *(
            (
                f"[shot]\nmoment = 1\nquestion = 'Why?'\nanswers = {answers}\nright = {right}",
                "line 3: a question has 2 to 4 answers, and the number of the right one",
            )
            for answers, right in ((["a", "b"], 3), (["a", "b"], 0), (["a"], 1), ([*"abcde"], 1))
        ),
        ("theta = 1\nfriction = 0.1", "line 2: the model pendulum has no friction"),
        ("theta = = 1", "is not TOML: Invalid value (at line 1"),
    ],
)
def test_an_error_names_the_line_and_the_field(mine, text, said):
    mine.write_text(text, encoding="utf-8")
    assert pendu("run", "--scene", mine, "--time", "1").refused(3, said)


def test_the_example_of_each_field_is_a_whole_line():
    for name in (*_SCENE, *_SHOT):
        assert tomllib.loads(_example(name))


def test_it_may_begin_with_a_byte_order_mark_and_give_angles_in_degrees(mine):
    assert read_scene(mine, "\ufefftheta = '180deg'").theta == math.pi
    assert read_scene(mine, f"watch = '{401 * 'x'}'").watch == f"{399 * 'x'}…"


def test_methods_of_ones_own_lie_beside_the_file(here):
    own_method(here)
    scene = read_scene(Path("mine.toml"), 'methods = ["rk4", "my methods.py:mine"]')
    assert [method.key for method in scene.cast] == ["rk4", "mine"]
    Path("own.py").write_text(EULER.format(name="RK4"))
    assert read_scene(Path("own.toml"), 'methods = ["own.py:RK4"]').cast[0].key == "RK4"
    saved = scene_text(scene)
    (here / "a").mkdir()
    assert read_scene(here / "a" / "elsewhere.toml", saved).cast[1].key == "mine"


LECTURE = """
h = 0.2
[[scene]]
name = "kept"
watch = "\\u001b"
theta = "120deg"
methods = ["rk4", "velocity_verlet"]

[[scene]]
h = 0.1
[scene.shot]
view = "phase"
theta = "40deg"
seconds = "30s"
line = {quantity = "energy_error", value = 0.01, name = "\\u001b"}
front = ["rk4"]
moment = 1
question = "Why?"
answers = ["a", "\\u001b"]
right = 2
"""


def test_a_listed_scene_gives_what_a_page_does_not_name(mine):
    scene = read_scene(mine, "from = 'crossover'\n[shot]\nlog = false")
    assert scene == SCENES["crossover"]
    assert (scene.speed, scene.shot) == (SCENES["crossover"].speed, Shot(log=False))
    asked = "question = 'Why?'\nmoment = 1\nanswers = ['a', 'b', 'c', 'd']"
    assert read_scene(mine, f"[shot]\nview = 'stability'\n{asked}").shot.right == 1
    other = read_scene(mine.with_name("b.toml"), "from = 'crossover'\ntheta = 2")
    assert (other.name, other.h, other.watch) == ("b", SCENES["crossover"].h, "")


def test_a_shot_names_what_differs_and_several_scenes_are_a_lesson(mine):
    mine.write_text(LECTURE, encoding="utf-8")
    first, second = read_scenes(mine).values()
    assert (first.name, first.h) == ("kept", 0.2)
    assert (second.name, second.h) == ("mine-2", 0.1)
    assert first.shot == Shot()
    steers = "\N{REPLACEMENT CHARACTER}"  # a terminal
    assert first.watch == second.shot.answers[1] == steers
    assert second.shot.line == Line("energy_error", 0.01, steers)
    assert (second.shot.view, second.shot.front) == ("phase", ("rk4",))
    assert (second.shot.theta, second.shot.seconds) == (math.radians(40), 30.0)
    assert pendu("run", "--scene", mine, "--time", "1", "--json").json["scene"]["name"] == "kept"
    mine.write_text("h = 0.02\n[[scene]]\n[[scene]]\nh = 0.01")
    read_scenes.cache_clear()
    assert [each.h for each in read_scenes(mine).values()] == [0.02, 0.01]
