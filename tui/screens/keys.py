"""The keys of the lab and of the replay: from here come bindings, key line, help, command palette and `pendu-tui keys`.

A view's keys are with its pane.
"""

from collections.abc import Iterable

from engine.methods import METHODS
from tui.views.keys import Key

_TIME, _SHOW, _VIEWS, _PROGRAM = "time", "what is shown", "the views", "the program"
_RUN, _PLAY = "the run", "the recording"
_EXACT = len(METHODS) + 1

COMMON = (
    Key("space", "space", "pause, go on", "pause", _TIME, "Pause"),
    Key("less_than_sign", "<", "half the speed", "speed(-1)", _TIME),
    Key("greater_than_sign", ">", "double speed", "speed(1)", _TIME, "Faster"),
    Key("0", "0", "real time", "real_time", _TIME),
    *(
        Key(str(number), str(number), f"show or hide {method.label}", f"show({number - 1})", _SHOW)
        for number, method in enumerate(METHODS, 1)
    ),
    Key(str(_EXACT), str(_EXACT), "show or hide the exact swing", f"show({_EXACT - 1})", _SHOW),
    Key("t", "t", "trails on, off", "trails", _SHOW),
    Key("y", "y", "chart logarithmic, linear", "log", _SHOW, "Log"),
    Key("e", "e", "chart energy error, theta error, shadow error, energy", "quantity", _SHOW, "Quantity"),
    Key("w", "w", "chart shows more of the past", "window(1)", _SHOW, "Window"),
    Key("W,shift+w", "W", "chart shows less of the past", "window(-1)", _SHOW),
    Key("v", "v", "next view", "view", _VIEWS, "View"),
    Key("f2", "F2", "view: lab", "view('lab')", _VIEWS),
    Key("f3", "F3", "view: phase space", "view('phase')", _VIEWS),
    Key("f4", "F4", "view: accuracy", "view('accuracy')", _VIEWS),
    Key("f5", "F5", "view: stability", "view('stability')", _VIEWS),
    Key("E,shift+e", "E", "all events", "app.extra('events')", _SHOW, "Events"),
    Key("d", "d", "describe the screen in words", "app.extra('describe')", _SHOW, "Describe"),
    Key(
        "s", "s", "screenshot beside the recordings, as SVG and text", "app.extra('screenshot')", _PROGRAM, "Screenshot"
    ),
    Key("a", "a", "draw with braille, half blocks, or ASCII", "app.next_character_set", _PROGRAM),
    Key("u", "u", "undo the last setting", "undo", _PROGRAM, "Undo"),
    Key("question_mark", "?", "help", "help", _PROGRAM, "Help"),
    Key("ctrl+p", "ctrl+p", "command palette", "command_palette", _PROGRAM),
    Key("ctrl+z", "ctrl+z", "to the shell, where fg comes back", "app.suspend_process", _PROGRAM),
    Key("q", "q", "quit", "quit", _PROGRAM, "Quit"),
    Key("", "click", "on a key of the last line: as if it were pressed", "", _PROGRAM),
)

LIVE = (
    Key("plus,equals_sign", "+", "larger h along 1, 2, 5", "larger_h(1)", _RUN, "Larger h"),
    Key("minus", "-", "smaller h", "larger_h(-1)", _RUN),
    Key("i", "i", "start values", "start_values", _RUN, "Start"),
    Key("p", "p", "next scene", "scene(1)", _RUN, "Scene"),
    Key("P,shift+p", "P", "previous scene", "scene(-1)", _RUN),
    Key("r", "r", "restart", "restart", _RUN, "Restart"),
    Key("b", "b", "reverse time", "reverse", _RUN, "Reverse"),
    Key("n", "n", "equal cost: a step of RK4 while the others do four", "equal_cost", _RUN, "Equal cost"),
    Key("m", "m", "mark this moment among the events", "mark", _RUN, "Mark"),
    Key("full_stop", ".", "one step on", "step(1)", _TIME),
    Key("comma", ",", "one step back", "step(-1)", _TIME),
)

REPLAY = (
    Key("left", "left", "1 s back", "seek(-1)", _PLAY),
    Key("right", "right", "1 s on", "seek(1)", _PLAY, "1 s on"),
    Key("shift+left", "shift+left", "10 s back", "seek(-10)", _PLAY),
    Key("shift+right", "shift+right", "10 s on", "seek(10)", _PLAY),
    Key("home", "home", "to the start", "part(-1)", _PLAY, "Start"),
    Key("end", "end", "to the end", "part(1)", _PLAY, "End"),
    Key("pageup", "pgup", "10 % back", "part(-0.1)", _PLAY),
    Key("pagedown", "pgdn", "10 % on", "part(0.1)", _PLAY),
    Key("left_square_bracket", "[", "to the event before, or what a method did", "event(-1)", _PLAY),
    Key("right_square_bracket", "]", "to the next event, or to what a method does next", "event(1)", _PLAY, "Event"),
    Key("full_stop", ".", "to the next recorded sample, some steps on", "step(1)", _PLAY),
    Key("comma", ",", "to the sample before", "step(-1)", _PLAY),
    Key("b", "b", "play the other way", "reverse", _PLAY, "Reverse"),
    Key("m", "m", "mark this moment, beside the recording", "mark", _PLAY, "Mark"),
    Key("A,shift+a", "A", "the loop begins here", "loop_end(0)", _PLAY),
    Key("B,shift+b", "B", "the loop ends here", "loop_end(1)", _PLAY),
    Key("L,shift+l", "L", "loop on, off", "loop", _PLAY, "Loop"),
    Key("f", "f", "go on live from here", "live", _PLAY, "Live"),
    Key("", "click, drag", "on the bar: to that moment", "", _PLAY),
)

HINTS = ("space", "+", "right", "i", "p", "]", "?", "q", "v", ">", "f", "home", "end", "L", "r", *"yewbnmudEs")
"""The keys on the key line, those that matter most first: at the end they are cut off."""


def hinted(keys: Iterable[Key]) -> list[Key]:
    """The keys for the key line, the most important first."""
    return sorted((key for key in keys if key.hint), key=lambda key: HINTS.index(key.shown))


def key_list(keys: Iterable[Key]) -> str:
    """The keys as a text, by group."""
    listed = [key for key in keys if key.shown]
    groups = dict.fromkeys(key.group for key in listed)
    return "\n\n".join(
        "\n".join([group.capitalize(), *(f"  {key.shown:<14}{key.does}" for key in listed if key.group == group)])
        for group in groups
    )
