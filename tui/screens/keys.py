"""The keys of the lab and of the replay: a view's keys are with its pane.

Bindings, key line, help, command palette and `pendu-tui keys` come from these tables.
"""

from collections.abc import Iterable, Sequence

from engine.scenes import MOST_METHODS
from tui.views.keys import Key

_TIME, _SHOW, _VIEWS, _PROGRAM, _RUN, _PLAY = "time", "display", "views", "program", "run", "playback"

_EXACT = MOST_METHODS + 1

COMMON = (
    Key("space", "space", "pause/resume", "pause", _TIME, "Pause"),
    Key("less_than_sign", "<", "half speed", "speed(-1)", _TIME),
    Key("greater_than_sign", ">", "double speed", "speed(1)", _TIME, "Faster"),
    Key("0", "0", "normal speed (1×)", "set_speed(1.0)", _TIME),
    *(
        Key(str(number), str(number), f"show or hide method {number}", f"show({number - 1})", _SHOW)
        for number in range(1, MOST_METHODS + 1)
    ),
    Key(str(_EXACT), str(_EXACT), "show or hide the exact motion", f"show({MOST_METHODS})", _SHOW),
    Key("O,shift+o", "O", "all pendulums on one pivot, or one pane each", "switch('overlay')", _SHOW, "One pivot"),
    Key("X,shift+x", "X", "one method alone, or all again", "alone", _SHOW, "Alone"),
    Key("t", "t", "toggle trails", "switch('trails')", _SHOW),
    Key("y", "y", "chart: log/linear", "switch('log')", _SHOW, "Log"),
    Key("e", "e", "chart: next quantity, such as the angle error", "quantity", _SHOW, "Quantity"),
    Key("w", "w", "chart: whole run, last 20 s, 60 s, ...", "window(1)", _SHOW, "Window"),
    Key("W,shift+w", "W", "chart: the window before", "window(-1)", _SHOW),
    Key("z", "z", "chart: zoom in at the pointer, or in the middle", "app.extra('zoom', 0.5)", _SHOW, "Zoom"),
    Key("Z,shift+z", "Z", "chart: zoom out, up to the whole run", "app.extra('zoom', 2.0)", _SHOW),
    Key("left_parenthesis", "(", "chart: earlier, once it is zoomed", "app.extra('shift', -0.25)", _SHOW),
    Key("right_parenthesis", ")", "chart: later", "app.extra('shift', 0.25)", _SHOW),
    Key("escape", "esc", "chart: back from the zoom, as w", "window(0)", _SHOW),
    Key("v", "v", "next view", "view", _VIEWS, "View"),
    Key("f2", "F2", "lab view", "view('lab')", _VIEWS, "Lab"),
    Key("f3", "F3", "phase space view", "view('phase')", _VIEWS, "Phase"),
    Key("f4", "F4", "accuracy view", "view('accuracy')", _VIEWS, "Accuracy"),
    Key("f5", "F5", "stability view", "view('stability')", _VIEWS, "Stability"),
    Key("E,shift+e", "E", "list all events", "app.extra('events')", _SHOW, "Events"),
    Key("d", "d", "describe the screen in words", "app.extra('describe')", _SHOW, "Describe"),
    Key("s", "s", "save a screenshot (SVG and text)", "app.extra('screenshot')", _PROGRAM, "Screenshot"),
    Key("u", "u", "undo the last change", "undo", _PROGRAM, "Undo"),
    Key("question_mark", "?", "help", "help", _PROGRAM, "Help"),
    Key("ctrl+p", "ctrl+p", "command palette", "command_palette", _PROGRAM),
    Key("ctrl+z", "ctrl+z", "suspend to the shell (fg returns)", "app.suspend_process", _PROGRAM),
    Key("q", "q", "quit", "quit", _PROGRAM, "Quit"),
    Key("", "ctrl+c", "finish the recording and quit", "", _PROGRAM),
    Key("", "click", "on a key hint: same as pressing it; an event: go there", "", _PROGRAM),
    Key("", "wheel", "on the chart: zoom at the pointer, which reads it out", "", _SHOW),
)

LIVE = (
    Key("plus,equals_sign", "+", "larger step (1-2-5)", "larger_h(1)", _RUN, "Larger h"),
    Key("minus", "-", "smaller step", "larger_h(-1)", _RUN),
    Key("i", "i", "edit start values", "start_values", _RUN, "Edit"),
    Key("M,shift+m", "M", "choose the methods on stage", "methods", _RUN, "Methods"),
    Key("p", "p", "next scene", "next_scene", _RUN, "Scene"),
    Key("P,shift+p", "P", "choose a scene from the list", "scenes", _RUN, "Scenes"),
    Key("r", "r", "restart", "restart", _RUN, "Restart"),
    Key("b", "b", "reverse time", "reverse", _RUN, "Reverse"),
    Key("n", "n", "equal cost: RK4 takes one step while others take four", "equal_cost", _RUN, "Equal cost"),
    Key("m", "m", "mark this moment", "mark", _RUN, "Mark"),
    Key("full_stop", ".", "one step forward", "step(1)", _RUN),
    Key("comma", ",", "one step back", "step(-1)", _RUN),
    Key("left_square_bracket", "[", "back to the previous event of this run", "event(-1)", _RUN),
    Key("right_square_bracket", "]", "to the next event, or the newest step", "event(1)", _RUN),
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
    Key("", "enter", "in the form: start with these values or methods", "", "texts and forms"),
    Key("", "space", "in the list of methods: take one, or leave it", "", "texts and forms"),
    Key("", "up, down", "scroll the text, or go to another field", "", "texts and forms"),
)
"""Only listed: Textual binds them."""

ALWAYS = ("F2", "F3", "F4", "F5", "space", "?", "q")
HINTS = ("+", "]", "f", "M", "i", "p", "u", ">", *"ewzyXO", "right", "home", "end", "L", *"rbnmdEsv")
"""The keys on the key line, the most important first: those that do not fit are left out."""
CHARTS = frozenset("ewzyO")
"""Keys of what only the lab's view shows."""


def hinted(keys: Iterable[Key], view: str = "lab", panes: Sequence[Key] = ()) -> list[Key]:
    """The keys for the key line, the most important first: those that always work, the panes' own, and the others."""
    hints = [key for key in keys if key.hint and (view == "lab" or key.shown not in CHARTS)]
    always = [key for name in ALWAYS for key in hints if key.shown == name]
    others = [key for name in HINTS for key in hints if key.shown == name]
    return [*always, *(key for key in panes if key.hint and view != "lab"), *others]


def key_list(keys: Iterable[Key], where: str = "") -> str:
    """The keys as a text, by group; the headings show where they work, unless that is the group's name."""
    listed = [key for key in keys if key.shown]
    parts = []
    for group in dict.fromkeys(key.group for key in listed):
        heading = group.capitalize() + (f" ({where})" if where not in ("", group) else "")
        parts.append([heading, *(f"  {key.shown:<14}{key.does}" for key in listed if key.group == group)])
    return "\n\n".join("\n".join(lines) for lines in parts)
