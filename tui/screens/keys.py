"""The keys of the lab and of the replay: a view's keys are with its pane.

Bindings, key line, help, command palette and `pendu-tui keys` come from these tables.
"""

from collections.abc import Iterable

from engine.scenes import MOST_METHODS
from tui.views.keys import Key

_TIME, _SHOW, _VIEWS, _PROGRAM, _RUN, _PLAY = "time", "display", "views", "program", "run", "playback"

_EXACT = MOST_METHODS + 1

COMMON = (
    Key("space", "space", "pause/resume", "pause", _TIME, "Pause"),
    Key("less_than_sign", "<", "half speed", "speed(-1)", _TIME),
    Key("greater_than_sign", ">", "double speed", "speed(1)", _TIME, "Faster"),
    Key("0", "0", "normal speed (1×)", "real_time", _TIME),
    *(
        Key(str(number), str(number), f"show or hide method {number}", f"show({number - 1})", _SHOW)
        for number in range(1, MOST_METHODS + 1)
    ),
    Key(str(_EXACT), str(_EXACT), "show or hide the exact motion", f"show({MOST_METHODS})", _SHOW),
    Key("t", "t", "toggle trails", "trails", _SHOW),
    Key("y", "y", "chart: log/linear", "log", _SHOW, "Log"),
    Key("e", "e", "chart: next quantity, such as the angle error", "quantity", _SHOW, "Quantity"),
    Key("w", "w", "chart: longer window", "window(1)", _SHOW, "Window"),
    Key("W,shift+w", "W", "chart: shorter window", "window(-1)", _SHOW),
    Key("v", "v", "next view", "view", _VIEWS, "View"),
    Key("f2", "F2", "lab view", "view('lab')", _VIEWS),
    Key("f3", "F3", "phase space view", "view('phase')", _VIEWS),
    Key("f4", "F4", "accuracy view", "view('accuracy')", _VIEWS),
    Key("f5", "F5", "stability view", "view('stability')", _VIEWS),
    Key("E,shift+e", "E", "list all events", "app.extra('events')", _SHOW, "Events"),
    Key("d", "d", "describe the screen in words", "app.extra('describe')", _SHOW, "Describe"),
    Key("s", "s", "save a screenshot (SVG and text)", "app.extra('screenshot')", _PROGRAM, "Screenshot"),
    Key("a", "a", "draw with braille, half blocks, or ASCII", "app.next_character_set", _PROGRAM),
    Key("u", "u", "undo the last change", "undo", _PROGRAM, "Undo"),
    Key("question_mark", "?", "help", "help", _PROGRAM, "Help"),
    Key("ctrl+p", "ctrl+p", "command palette", "command_palette", _PROGRAM),
    Key("ctrl+z", "ctrl+z", "suspend to the shell (fg returns)", "app.suspend_process", _PROGRAM),
    Key("q", "q", "quit", "quit", _PROGRAM, "Quit"),
    Key("", "ctrl+c", "finish the recording and quit", "", _PROGRAM),
    Key("", "click", "on a key hint: same as pressing it", "", _PROGRAM),
)

LIVE = (
    Key("plus,equals_sign", "+", "larger step (1-2-5)", "larger_h(1)", _RUN, "Larger h"),
    Key("minus", "-", "smaller step", "larger_h(-1)", _RUN),
    Key("i", "i", "edit start values", "start_values", _RUN, "Edit"),
    Key("p", "p", "next scene", "scene(1)", _RUN, "Scene"),
    Key("P,shift+p", "P", "previous scene", "scene(-1)", _RUN),
    Key("r", "r", "restart", "restart", _RUN, "Restart"),
    Key("b", "b", "reverse time", "reverse", _RUN, "Reverse"),
    Key("n", "n", "equal cost: RK4 takes one step while others take four", "equal_cost", _RUN, "Equal cost"),
    Key("m", "m", "mark this moment", "mark", _RUN, "Mark"),
    Key("full_stop", ".", "one step forward", "step(1)", _RUN),
    Key("comma", ",", "one step back", "step(-1)", _RUN),
    Key("T,shift+t", "T", "a tour in eight steps: begin, leave, go on", "tour", _RUN),
)

TOUR = (
    Key("enter", "enter, space", "go on: to the moment, the answer, the next step", "tour_forward", "tour"),
    Key("backspace", "backspace", "back to the question, or to the step before", "tour_back", "tour"),
    Key("escape", "esc", "leave the tour; T returns to it", "tour_leave", "tour"),
)
"""Of the lab while a tour is on its screen.  `space` is the lab's own: it goes on where the tour has paused it."""


REPLAY = (
    Key("left", "left", "back 1 s", "seek(-1)", _PLAY),
    Key("right", "right", "forward 1 s", "seek(1)", _PLAY, "+1 s"),
    Key("shift+left", "shift+left", "back 10 s", "seek(-10)", _PLAY),
    Key("shift+right", "shift+right", "forward 10 s", "seek(10)", _PLAY),
    Key("home", "home", "go to start", "part(-1)", _PLAY, "Start"),
    Key("end", "end", "go to end", "part(1)", _PLAY, "End"),
    Key("pageup", "pgup", "back 10 %", "part(-0.1)", _PLAY),
    Key("pagedown", "pgdn", "forward 10 %", "part(0.1)", _PLAY),
    Key("left_square_bracket", "[", "previous event or milestone", "event(-1)", _PLAY),
    Key("right_square_bracket", "]", "next event or milestone", "event(1)", _PLAY, "Event"),
    Key("full_stop", ".", "next recorded sample", "step(1)", _PLAY),
    Key("comma", ",", "previous recorded sample", "step(-1)", _PLAY),
    Key("b", "b", "reverse playback", "reverse", _PLAY, "Reverse"),
    Key("m", "m", "mark this moment (saved next to the recording)", "mark", _PLAY, "Mark"),
    Key("A,shift+a", "A", "set loop start", "loop_end(0)", _PLAY),
    Key("B,shift+b", "B", "set loop end", "loop_end(1)", _PLAY),
    Key("L,shift+l", "L", "toggle loop", "loop", _PLAY, "Loop"),
    Key("f", "f", "continue live from here", "live", _PLAY, "Live"),
    Key("", "click, drag", "on the bar: jump there", "", _PLAY),
)

OVERLAYS = (
    Key("", "esc", "close the text, the form or the palette", "", "texts and forms"),
    Key("", "enter", "in the form: start with these values", "", "texts and forms"),
    Key("", "up, down", "scroll the text, or go to another field", "", "texts and forms"),
)
"""Only listed: Textual binds them."""

HINTS = ("space", "+", "right", "i", "p", "]", "?", "q", "v", ">", "f", "home", "end", "L", "r", *"yewbnmudEs")
"""The keys on the key line, the most important first: those that do not fit are left out."""


def hinted(keys: Iterable[Key]) -> list[Key]:
    """The keys for the key line, the most important first."""
    return sorted((key for key in keys if key.hint), key=lambda key: HINTS.index(key.shown))


def key_list(keys: Iterable[Key], where: str = "") -> str:
    """The keys as a text, by group; the headings show where they work, unless that is the group's name."""
    listed = [key for key in keys if key.shown]
    parts = []
    for group in dict.fromkeys(key.group for key in listed):
        heading = group.capitalize() + (f" ({where})" if where not in ("", group) else "")
        parts.append([heading, *(f"  {key.shown:<14}{key.does}" for key in listed if key.group == group)])
    return "\n\n".join("\n".join(lines) for lines in parts)
