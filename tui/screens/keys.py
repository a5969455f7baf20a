"""The keys of the lab; the key line, the help and the palette are made from them."""

from textual.binding import Binding, BindingType

from pendu_tui.engine.scenes import MAX_METHODS
from pendu_tui.recordings.system import CAN_STOP
from pendu_tui.tui.views import VIEWS

_H = Binding.Group("larger, smaller step h")
_SECONDS = Binding.Group("back, forward 1 s")
_TENTHS = Binding.Group("back, forward 10 %")
_ENDS = Binding.Group("to the start, to the end")
_SPEED = Binding.Group("half, double speed")
_STEPS = Binding.Group("one step back, forward")
_EVENTS = Binding.Group("previous, next event")
_METHODS = Binding.Group("show or hide a method")
_VIEWS = Binding.Group("view: lab, phase, …")

ALWAYS = 7
"""So many first keys stand on the last line in every view; then come those of the pane."""

KEYS: list[BindingType] = [
    Binding("plus,equals_sign", "next_h(1)", "Step", True, "+", False, "larger step h", group=_H),
    Binding("minus", "next_h(-1)", "Step", True, "-", False, "smaller step h", group=_H),
    Binding("p", "next_scene", "Scene", tooltip="next scene"),
    Binding("space", "pause", "Pause", tooltip="pause, go on"),
    Binding("v", "view", "View", tooltip="next view"),
    Binding("question_mark", "help", "Help", True, "?", tooltip="this help"),
    Binding("q", "app.quit", "Quit", tooltip="finish the recording, quit"),
    Binding("ctrl+p", "find", "Find", True, "ctrl+p", True, "find scenes, themes, …"),
    Binding("f", "live", "Live", tooltip="continue a replay live"),
    Binding("T,shift+t", "lesson", "Tour", True, "T", tooltip="tour: begin, leave, resume"),
    Binding("b", "reverse", "Back", tooltip="run back in time"),
    Binding("u", "undo", "Undo", tooltip="undo the last change"),
    Binding("i", "start_values", "Edit", tooltip="edit start values"),
    Binding("M,shift+m", "methods", "Methods", True, "M", tooltip="choose methods"),
    Binding("r", "restart", "Restart", tooltip="restart; dims the old run"),
    Binding("n", "equal_cost", "Equal cost", tooltip="equal cost for all"),
    Binding("left", "seek(-1)", "Seek", True, "left", tooltip="back 1 s", group=_SECONDS),
    Binding("right", "seek(1)", "Seek", True, "right", tooltip="forward 1 s", group=_SECONDS),
    Binding("home", "part(-1)", "go to the start", False, group=_ENDS),
    Binding("end", "part(1)", "go to the end", False, group=_ENDS),
    Binding("pageup", "part(-0.1)", "back 10 %", False, "pgup", group=_TENTHS),
    Binding("pagedown", "part(0.1)", "forward 10 %", False, "pgdn", group=_TENTHS),
    Binding("comma", "step(-1)", "one step back", False, ",", group=_STEPS),
    Binding("full_stop", "step(1)", "one step forward", False, ".", group=_STEPS),
    Binding("left_square_bracket", "event(-1)", "previous event", False, "[", group=_EVENTS),
    Binding("right_square_bracket", "event(1)", "next event", False, "]", group=_EVENTS),
    Binding("less_than_sign", "speed(-1)", "half speed", False, "<", group=_SPEED),
    Binding("greater_than_sign", "speed(1)", "double speed", False, ">", group=_SPEED),
    *(
        Binding(f"{n}", f"show({n - 1})", f"show or hide method {n}", False, group=_METHODS)
        for n in range(1, MAX_METHODS + 1)
    ),
    Binding(f"{MAX_METHODS + 1}", f"show({MAX_METHODS})", "the exact motion", show=False),
    *(
        Binding(f"f{n}", f"view({name!r})", f"view: {view.title}", False, f"F{n}", group=_VIEWS)
        for n, (name, view) in enumerate(VIEWS.items(), 2)
    ),
    Binding("e", "quantity", "chart: next quantity", show=False),
    Binding("y", "axes", "chart: log, log time, …", show=False),
    Binding("w", "window", "chart: last 20 s, 60 s, …", show=False),
    Binding("z", "zoom(0.5)", "chart: zoom in", show=False),
    Binding("escape", "back", "back from a view or a zoom", False, "esc"),
    Binding("o", "switch('overview')", "overview: all angles", show=False),
    Binding("P,shift+p", "find('scene ')", "choose a scene", show=False),
    Binding("E,shift+e", "events", "list all events", show=False),
    Binding("m", "mark", "mark this moment", show=False),
    Binding("d", "describe", "describe it in words", show=False),
    Binding("s", "screenshot", "save a screenshot", show=False),
    Binding("S,shift+s", "save_scene", "save it as a scene file", show=False),
    Binding("enter", "turn('forward')"),  # the lesson's panel shows these two
    Binding("backspace", "turn('back')"),
]
"""In the order of the help, and of the last line, which shows what fits of the first ones."""
if CAN_STOP:
    KEYS.append(Binding("ctrl+z", "app.suspend_process", "suspend to the shell", show=False))
