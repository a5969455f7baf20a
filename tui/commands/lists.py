"""Lists of the methods, with their claimed and measured properties, and of the scenes."""

import argparse
from collections.abc import Iterator
from functools import partial
from itertools import groupby
from typing import Any

from pendu_tui.engine.methods import METHODS, Method, family_of
from pendu_tui.engine.methods.method import no_order, yes
from pendu_tui.engine.scenes import GROUPS, MAX_METHODS, SCENES
from pendu_tui.tui.cli.cast import cast_of
from pendu_tui.tui.cli.checks import MEASURED_NUMBERS, MEASURED_WORDS, Check, conclude, parse
from pendu_tui.tui.cli.errors import Exit
from pendu_tui.tui.cli.scene import scene_named
from pendu_tui.tui.commands.report import Column, Report, fields_of, finite, limit_text, publish
from pendu_tui.tui.words.cards import method_card, scene_card

CLAIMS = (
    *("key", "label", "letter", "formula", "order", "force_evaluations", "symplectic"),
    *("reversible", "linear_limit", "other_names", "reference", "used"),
)
MEASURED = ("order", "linear_limit", "symplectic", "reversible", "force_evaluations")
NOTE = """
claimed: what the author states; the rest is measured, unless no order is (-).
order: from the theta error over half a period.
evals: force evaluations per step, on average if they vary.
z limit: for the linear oscillator, z = h·w0 (0: never stable); pendu-tui stability finds those of
the pendulum."""

Row = dict[str, Any]


def methods(options: argparse.Namespace) -> int:
    from pendu_tui.engine.run.loops import available

    if options.names:
        options.methods = ",".join(options.names)
    cast = cast_of(options, () if options.method else METHODS)
    gate = parse(options.fail_if, MEASURED_NUMBERS, words=MEASURED_WORDS)
    rows = [_row(method) for method in cast]
    wrong = {
        method.key: no_order(row["measured_order"])
        for method, row in zip(cast, rows, strict=True)
        if method.general
    }
    notes = [NOTE, *(f"{key}: {why}" for key, why in wrong.items() if why)]
    if options.names:
        notes += [f"\n{method_card(method)}" for method in cast]
    report = Report(
        name="methods",
        columns=METHOD_COLUMNS,
        rows=list(_by_family(rows)),
        notes=notes,
        fields={"methods": [finite(row) for row in rows], "compiled": available()},
    )
    publish(report, options)
    checks = []
    for row in rows:
        failure = gate({"": _gated(row)})
        why = failure and wrong.get(row["key"])
        checks.append(Check(row["key"], "; ".join(filter(None, (failure, why)))))
    return conclude(options.fail_if, checks, "methods")


def _gated(row: Row) -> Row:
    """Return the measured properties as --fail-if compares them: yes and no are words."""
    measured = {name: row[f"measured_{name}"] for name in MEASURED}
    return {
        name: yes(value) if isinstance(value, bool) else value for name, value in measured.items()
    }


def _row(method: Method) -> Row:
    """Return the claims, which a user's own method does not make, and the measured properties."""
    from pendu_tui.engine.methods.measure import measured
    from pendu_tui.engine.methods.own import OwnMethod

    claims = fields_of(method, *CLAIMS)
    if isinstance(method, OwnMethod):
        claims |= dict.fromkeys(set(CLAIMS) - {"key", "label", "letter", "other_names"})
    # tests measure the others, each in its own scene
    found = measured(method.phases) if method.general else None
    return claims | {f"measured_{name}": getattr(found, name, None) for name in MEASURED}


def _by_family(rows: list[Row]) -> Iterator[Any]:
    if len(rows) <= MAX_METHODS:
        yield from rows
        return
    for family, members in groupby(rows, lambda row: family_of(row["key"])):
        yield family
        yield from members


def _known(row: Row, name: str) -> Any:
    measured = row[f"measured_{name}"]
    return row[name] if measured is None else measured


METHOD_COLUMNS = (
    Column("method", "key"),
    Column("claimed", "order", "d"),
    Column("order", "measured_order", ".3f"),
    Column("evals", lambda row: _known(row, "force_evaluations"), ".3g"),
    Column("symplectic", lambda row: yes(_known(row, "symplectic"))),
    Column("reversible", lambda row: yes(_known(row, "reversible"))),
    Column("z limit", lambda row: _known(row, "linear_limit"), partial(limit_text, decimals=3)),
)
SCENE_COLUMNS: tuple[Column, ...] = (
    Column("scene", lambda scene: scene.name),
    Column("z", lambda scene: scene.z, ".3g"),
    Column("what to watch", lambda scene: scene.watch),
)


def scenes(options: argparse.Namespace) -> int:
    shown = list(SCENES.values())
    columns = SCENE_COLUMNS
    notes = []
    if options.name:
        shown = [scene_named(options.name)]
        columns = ()
        labels = ", ".join(method.label for method in shown[0].cast)
        notes = [f"{scene_card(shown[0])}\n  methods       {labels}"]
    rows = [row for group, members in GROUPS.items() for row in ("", group.upper(), *members)]
    fields = {"scenes": [scene.fields() | {"speed": scene.speed} for scene in shown]}
    report = Report(name="scenes", columns=columns, rows=rows, notes=notes, fields=fields)
    publish(report, options)
    return Exit.FINE
