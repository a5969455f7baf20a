import pytest

from engine.methods import METHODS
from engine.run.compiled import available
from engine.scenes import GROUPS, LEFT_OUT, SCENES
from tests.tui.command_line import pendu
from tui.cli.report import print_table
from tui.commands.about.methods import MEASURED


def test_scenes_lists_every_scene_with_what_to_watch():
    out = pendu("scenes").out
    for scene in SCENES.values():
        assert scene.name in out
        assert scene.watch in out


def test_scenes_as_json_hold_everything_that_determines_a_run():
    answer = pendu("scenes", "--json").json
    assert answer["schema"] == "pendu.scenes/1"
    assert answer["scenes"] == [scene.fields() | {"speed": scene.speed} for scene in SCENES.values()]


def test_methods_lists_every_method_its_claims_and_what_is_measured():
    lines = pendu("methods").out.splitlines()
    for method in METHODS:
        (words,) = (line.split() for line in lines if line.startswith(f"{method.key} "))
        assert str(method.order) in words
        limit = method.linear_limit
        assert ("-" if limit is None else f"{limit:.3f}" if limit else "none") in words


def test_methods_as_json_repeat_the_engine_and_what_is_measured_agrees():
    answer = pendu("methods", "--json").json
    assert answer["schema"] == "pendu.methods/1"
    assert answer["compiled"] == available()
    for told, method in zip(answer["methods"], METHODS, strict=True):
        for claim in ("key", "label", "order", "force_evaluations", "symplectic", "reversible", "linear_limit"):
            assert told[claim] == getattr(method, claim)
        if not method.general:
            assert {told[name] for name in MEASURED} == {None}
            continue
        assert told["measured_order"] == pytest.approx(method.order, abs=0.1)  # as the engine's own tests
        assert told["measured_symplectic"] == method.symplectic
        assert told["measured_reversible"] == method.reversible
        assert told["measured_force_evaluations"] == method.force_evaluations
        assert told["measured_linear_limit"] == pytest.approx(method.linear_limit, abs=1e-9)  # it is bisected so far


def test_text_from_a_file_does_not_steer_the_terminal(capsys):
    print_table("l", ("name",), [("\x1b[31mred\n[bold]big[/bold] \u202e",)])
    out = capsys.readouterr().out
    assert "\x1b" not in out
    assert "\u202e" not in out
    assert "[bold]big[/bold]" in out
    assert out.count("\n") == 2


def test_scenes_are_listed_in_groups_and_the_last_line_says_what_is_left_out():
    lines = pendu("scenes").out.splitlines()
    names = [line.split("  ")[0].strip().casefold() for line in lines]
    for group, scenes in GROUPS.items():
        at = names.index(group)
        assert names[at + 1 : at + 1 + len(scenes)] == [scene.name for scene in scenes]
    assert lines[-1] == LEFT_OUT
