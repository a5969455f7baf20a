"""Replay a recording in the lab: pause, step, seek, loop, play backwards, or continue live."""

import argparse

from pendu_tui.engine.methods import METHODS
from pendu_tui.tui.cli.cast import cast_of, own_methods
from pendu_tui.tui.cli.errors import UserError
from pendu_tui.tui.cli.options import resolve


def run(options: argparse.Namespace) -> int:
    from pendu_tui.recordings.events import remember
    from pendu_tui.tui.playback.replay import Replay
    from pendu_tui.tui.screens import launch

    path = resolve(options.file)
    remember(own_methods(options))
    only = None
    if options.methods is not None:
        only = cast_of(options, ())
    launch.check(options)
    replay = Replay(launch.open_recording(path))
    if not 0 <= options.start_at <= replay.length:
        raise UserError(
            f"--start-at {options.start_at:g} is outside the recording; use 0 to "
            f"{replay.length:.2f} s."
        )
    if only is not None and not set(only) & set(replay.scene.cast):
        names = ", ".join(method.key for method in only)
        raise UserError(f"--methods: the recording's first run has none of {names}.")
    replay.set_speed(options.speed)
    replay.looping = options.loop
    replay.seek(options.start_at)
    replay.pause(options.paused)
    if options.plain:
        return launch.print_sentences(replay, only=only)
    screen = launch.replay_screen(replay, options.no_record)
    if only is not None:
        hidden = {method.key for method in (*METHODS, *replay.scene.cast) if method not in only}
        screen.shown = screen.shown._replace(hidden=frozenset(hidden))
    return launch.show(screen, options)
