"""List all keys and mouse actions of the lab, of a replay and of their views."""

import argparse
from typing import TYPE_CHECKING

from tui.cli.errors import Exit
from tui.cli.output import write_json

if TYPE_CHECKING:
    from tui.views.keys import Key

EXAMPLES = """\
examples:
  pendu-tui keys
  pendu-tui keys --json | jq '.keys[] | select(.where == "replay")'
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help="one JSON object")


def run(options: argparse.Namespace) -> int:
    from tui.screens.keys import key_list

    places = keys_by_place()
    if options.json:
        rows = [{"key": key.shown, "does": key.does, "where": where} for where in places for key in places[where]]
        write_json("keys", {"keys": rows})
    else:
        print("\n\n".join(key_list(keys, where) for where, keys in places.items()))
    return Exit.FINE


def keys_by_place() -> dict[str, list["Key"]]:
    """Where keys work, and which do there."""
    from tui.screens.keys import COMMON, LIVE, OVERLAYS, REPLAY, TOUR
    from tui.views import VIEWS, create

    panes = dict.fromkeys(key for name in VIEWS for key in create(name).KEYS)  # two views have the phase pane
    places: dict[str, list[Key]] = {"lab and replay": [*COMMON], "lab": [*LIVE], "replay": [*REPLAY]}
    for key in (*panes, *TOUR, *OVERLAYS):
        places.setdefault(key.group, []).append(key)
    return {where: [key for key in keys if key.shown] for where, keys in places.items()}
