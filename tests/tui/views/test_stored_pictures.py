"""Panes as they look: dots, letters and inks, the table at several widths, and titles."""

import math
import re
from itertools import product

import numpy as np
import pytest

from pendu_tui.engine.methods import RK4, VELOCITY_VERLET
from pendu_tui.engine.models.model import State
from pendu_tui.engine.scenes import SCENES, Line
from pendu_tui.engine.studies.ring import Neighbourhood
from pendu_tui.engine.studies.section import iterate
from pendu_tui.tui.drawing.picture import Picture
from pendu_tui.tui.playback.shown import Shown, Stretch, quantities
from pendu_tui.tui.views.error_table import table
from pendu_tui.tui.views.lab import places, title
from pendu_tui.tui.views.portrait import (
    PhasePoint,
    Portrait,
    Section,
    caption,
    framed,
    method_points,
    orbit_of,
    phase_picture,
    place_text,
)
from pendu_tui.tui.views.stage import Bob, Look, stage_picture
from pendu_tui.tui.views.viewport import Viewport
from tests.tui.drawn import look
from tests.tui.harness import after

DRIFT = SCENES["drift"]
SIZES = (60, 8), (60, 19), (60, 20), (81, 41), (99, 44), (140, 31), (200, 45)


def test_stages(snapshot):
    trail = [0.11 * nth - 1.2 for nth in range(16)]
    bobs = [
        Bob(0.45, 0, "e", trail=trail, ghost=-0.8),
        Bob(-0.4, 1, "s", ahead=-1.0, trail=trail[::-1]),
        Bob(1.3, 2, "v", diverged=True),
        Bob(2.9, 3, "r", trail=[2.0, 2.4, 2.5, 2.9]),
    ]
    springs = [Bob(0.5 * nth, nth, "esvr"[nth], length=0.4 + nth) for nth in range(4)]
    looks = Look(exact=0.2, amplitude=1.0), Look(1.35, exact=-1.0), Look(exact=0.2, rigid=False)
    sizes = (20, 6), (43, 22), (60, 30)
    pictures = [stage_picture(*size, bobs, each) for size, each in product(sizes, looks[:2])]
    pictures += [stage_picture(*size, springs, looks[2]) for size in sizes[:2]]
    pictures.append(stage_picture(30, 13, bobs[:1], Look(exact=0.5, exact_length=0.5)))
    several = [Bob(0.3 * nth - 0.8, nth, "esvrmp"[nth]) for nth in range(6)]
    for count, size in product((2, 6), sizes[:2]):
        pictures.append(stage_picture(*size, several[:count], looks[1]))
    # nothing between samples a radian apart, or when steps are long
    for trail, joins in (([-1.5, -0.6, 0.5, 1.5], True), ([-0.4, -0.2, 0.0], False)):
        pictures.append(stage_picture(30, 15, [Bob(3.0, 0, "e", trail=trail)], Look(joins=joins)))
    snapshot("stages.txt", "\n".join(map(look, pictures)))


def test_tables_and_titles(snapshot):
    texts = []
    for name in ("drift", "stiff-slow", "damped"):
        live = after(SCENES[name], 6)
        live.change(live.stepping.next(up=True))
        live.step(100)
        live.change(live.stepping.toggled())
        live.step(1)
        for width in (60, 77, 85, 92, 119, 120, 150):
            shown = Shown(held={120: 1.0}.get(width), hidden=frozenset({"rk4"}))
            rows = table(live, live.sample, shown, width)
            texts.append(look(Picture(rows)))
        for quantity, log, room in product(quantities(live.scene), (True, False), (25, 40, 60)):
            shown = Shown(quantity=quantity, log=log, seconds=20.0)
            texts.append(title(shown, live.exact, live.scene.equations, room))
        shown = Shown(stretch=Stretch(1, 2.5, 7.25, True), log_time=True)
        texts.append(title(shown, live.exact, live.scene.equations, 60))
    live = after(DRIFT, 20)
    *others, last = live.sample.readings
    sample = live.sample._replace(readings=(*others, last._replace(diverged_at=0.8)))
    for shown in (Shown(), Shown(held=1.0)):  # red is for failures alone
        texts.append(look(Picture(table(live, sample, shown, 80))))
    short = after(DRIFT.with_cast(DRIFT.cast[3:]), 1)
    texts.append(look(Picture(table(short, short.sample, Shown(), 220))))
    spin = SCENES["spin"]
    for room in (24, 100):
        texts.append(title(Shown(), spin.exact(), spin.equations, room))
    texts += [f"{size} {places(*size)}" for size in SIZES]
    text = "\n".join(texts) + "\n"
    snapshot("tables.txt", re.sub(r"[-+](?=0\.0+\b)", " ", text))  # such a sign is one of rounding


def test_phase_space(snapshot):
    live = after(DRIFT, 12)
    ring = Neighbourhood(DRIFT, 0.1).following(live.sample.step, live.changes, 1000)
    views = (
        (Viewport.portrait(46, 15, DRIFT), Shown(exact=True), None),
        (Viewport.portrait(78, 17, DRIFT, 1.1, 2.0), Shown(hidden=frozenset({"rk4"})), ring),
        (Viewport.portrait(46, 15, DRIFT, math.pi, 12.0), Shown(), None),
    )
    model = DRIFT.equations
    texts = []
    states = State(0.5, -2.0), State(3.1, -0.5), State(0.0, -12.0)
    for (viewport, shown, around), state in zip(views, states, strict=True):
        portrait = Portrait(viewport, model)
        points = method_points(live, live.sample, shown, around)
        line = Line("omega", 9.0, "pi/h")
        picture = phase_picture(portrait, points, states[0], state, line)
        texts.append(look(Picture(framed(viewport, picture))))
    angle = np.linspace(0, math.tau, 64, endpoint=False)
    ring = math.pi + 0.5 * np.cos(angle), 1.5 * np.sin(angle)
    nowhere = PhasePoint(math.nan, math.nan, 3, "r", ring=ring)
    texts.append(look(phase_picture(Portrait(views[0][0], model), [nowhere])))
    ends = zip((-9.0, 9.0, 0.1, 0.2), (1.0, -1.0, 30.0, -30.0), strict=True)
    outside = [PhasePoint(*each, ink, "esvr"[ink]) for ink, each in enumerate(ends)]
    part = Portrait(views[0][0]._replace(wrap=False), model)
    texts.append(look(phase_picture(part, outside, line=Line("theta", 9.0, "no omega"))))
    small = Viewport.portrait(35, 9, DRIFT)
    deep = small._replace(omega=-120.0).zoomed(1e-5, *small.middle)
    for part in (*(small.zoomed(0.6, x, 12) for x in (0, 40, 70)), deep):
        texts.append(look(Picture(framed(part, phase_picture(Portrait(part, model), [])))))
    for name in ("damped", "linear"):  # orbits that are no curves of energy, and closed ones
        portrait = Portrait(small, SCENES[name].equations)
        texts.append(look(phase_picture(portrait, [], orbit=State(2.5, -4.0))))
    short = after(DRIFT, 1)
    points = method_points(short, short.sample, Shown(), None)
    texts.append(look(phase_picture(Portrait(views[0][0], model), points)))
    coarse = after(DRIFT.altered(h=0.2), 9)
    points = method_points(coarse, coarse.sample, Shown(), None)
    texts.append(look(phase_picture(Portrait(views[0][0], model), points)))
    for method in (VELOCITY_VERLET, RK4):
        section = Section(views[0][0], model, method, method.hue)
        for theta in (0.7, 1.4, 1.6, 1.7, 1.8, 2.1, 2.11, 2.2):
            section.add(iterate(method, model, 0.2, (np.array([theta]), np.zeros(1)), 300))
        orbit, _ = orbit_of(method, model, 0.2, State(1.8, 0.0))
        texts.append(look(section.picture(orbit, State(1.8, 0.0), state)))
    for aim, width in product((None, state, State(math.pi, 1 / 3)), (80, 110, 140)):
        texts.append("".join(text for text, _ in caption(live, aim, width)))
    texts.append(place_text(SCENES["damped"].equations, State(-1 / 3000, 2.0), 80))
    alone = Shown(exact=True, hidden=frozenset(method.key for method in DRIFT.cast))
    points = method_points(live, live.sample, alone, None)
    texts.append(look(phase_picture(Portrait(views[0][0], model), points)))
    for columns in (35, 36, 200):  # as many angles as there is room for, in pi
        texts.append(look(Picture(framed(Viewport.portrait(columns, 1, DRIFT), Picture()))))
    snapshot("phase.txt", "\n".join(texts) + "\n")


@pytest.mark.parametrize(
    ("z", "speed", "joined"),
    [
        (0.25, 1.0, False),
        (0.35, 1.0, True),
        (0.95, 1.0, True),
        (1.1, 1.0, False),
        (0.35, 4.0, False),  # frames leave steps out
        (0.35, -4.0, False),  # also those of a replay played backwards
    ],
)
def test_steps_are_joined_that_are_neither_close_nor_far_apart(z, speed, joined):
    live = after(DRIFT.altered(h=z / DRIFT.w0), 0)
    live.playhead.speed = speed
    points = method_points(live, live.sample, Shown(), None)
    assert {point.joined for point in points} == {joined}
