"""The settings of the screen: what a key makes of them."""

from dataclasses import replace

import pytest

from pendu_tui.engine.scenes import DEFAULT_SCENE, SCENES, Line, Shot
from pendu_tui.tui.playback.shown import Shown, Stretch, quantities

CAST = DEFAULT_SCENE.cast


@pytest.mark.parametrize(("speed", "is_log"), [(3.9, False), (4.0, True)])
def test_fast_scenes_are_charted_over_logarithmic_time(speed, is_log):
    scene = replace(DEFAULT_SCENE, speed=speed)
    assert Shown().through(scene).has_log_time == is_log
    for shot in (Shot(log=False), Shot(seconds=7.0)):
        assert not Shown().through(scene, shot).has_log_time


def test_a_shot_sets_what_is_seen_and_is_found_in_it_again():
    seen = {"theta": 0.1, "quantity": "theta_error", "log": False, "seconds": 7.0, "ring": True}
    shot = Shot(front=(CAST[1].key, CAST[3].key), line=Line("omega", 1.0, "omega"), **seen)
    shown = Shown(overview=True, stretch=Stretch(1, 0.0, 1.0, False)).through(DEFAULT_SCENE, shot)
    assert (shown.places(CAST), shown.overview, shown.stretch) == ([1, 3], False, None)
    assert shown._asdict().items() >= seen.items()
    altered = replace(DEFAULT_SCENE, theta=0.5, shot=shot)
    assert Shown().through(altered) == Shown().through(altered, shot)
    recorded = replace(SCENES["spin"], shot=Shot())  # a recording has no shot
    assert Shown().through(recorded) == Shown().through(SCENES["spin"])
    own = replace(recorded, shot=Shot(log=False))  # of a file
    assert not Shown().through(own).log
    again = shown.shot(replace(DEFAULT_SCENE, shot=Shot(moment=1.0)), "phase", equal_cost=True)
    assert again == replace(shot, moment=1.0, view="phase", equal_cost=True)
    assert Shown().shot(DEFAULT_SCENE, "lab", equal_cost=False).front == ()


def test_windows_axes_and_quantities_come_in_turn():
    shown = Shown(seconds=7.0)  # of a shot
    windows = [(shown := shown.next_window()).seconds for _ in range(7)]
    assert windows == [None, 20.0, 60.0, 300.0, 1800.0, 5.0, None]
    axes = [(shown := shown.next_axes()) for _ in range(3)]
    assert [(each.log, each.has_log_time) for each in axes] == [
        (True, True),
        (False, False),
        (True, False),
    ]
    assert quantities(DEFAULT_SCENE) == ("energy_error", "theta_error", "shadow_error", "energy")
    assert shown.quantity_ahead(1, DEFAULT_SCENE) == "theta_error"
    assert shown.quantity_ahead(-1, DEFAULT_SCENE) == "energy"
    for quantity, following in (("theta_error", "shadow_error"), ("of others", "theta_error")):
        assert Shown(quantity=quantity).quantity_ahead(1, DEFAULT_SCENE) == following
    without_shadow = ("energy_error", "theta_error", "energy")
    assert quantities(SCENES["spin"].with_cast(CAST[3:])) == without_shadow
    assert "shadow_error" not in quantities(SCENES["stiff-slow"])


def test_methods_are_hidden_shown_and_left_alone():
    shown = Shown().toggled(1, CAST)
    assert shown.places(CAST) == [0, 2, 3]
    assert shown.toggled(1, CAST) == Shown()
    assert shown.toggled(len(CAST), CAST).exact
    alone = shown.alone(2, CAST)
    assert alone.places(CAST) == [2]
    assert alone.alone(2, CAST).places(CAST) == [0, 1, 2, 3]


def test_a_zoom_belongs_to_its_run_and_the_window_key_ends_it():
    stretch = Stretch(run=2, begin=1.0, end=2.0, log_time=True)
    zoomed = Shown(seconds=20.0).zoomed(stretch)
    assert zoomed.of(2) == zoomed
    assert zoomed.of(1) == zoomed.of(3) == Shown(seconds=20.0).of(2) == Shown(seconds=20.0)
    assert zoomed.has_log_time
    assert not zoomed._replace(log=False).has_log_time
    assert not zoomed.zoomed(stretch._replace(log_time=False)).has_log_time
    assert zoomed.next_window() == Shown(seconds=20.0)
    assert zoomed.zoomed(None).seconds is None
