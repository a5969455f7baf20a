"""The keys of the lab; the key line, the help and the palette are made from them."""

from textual.binding import Binding, BindingType

from pendu_tui.engine.scenes import MAX_METHODS
from pendu_tui.recordings.system import CAN_STOP
from pendu_tui.tui.views import VIEWS


def _key(
    keys: str,
    action: str,
    purpose: str,
    hint: str = "",
    shown: str = "",
    group: Binding.Group | None = None,
) -> Binding:
    """Return the binding of a key, which may stand on the last line if it has a hint.

    `shown`: how the key is written, if not by the first of its names.
    """
    return Binding(
        keys,
        action,
        hint or purpose,
        show=bool(hint),
        key_display=shown or keys.partition(",")[0],
        tooltip=purpose,
        group=group,
    )


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
    _key("+,=", "next_h(1)", "larger step h", "Step", group=_H),
    _key("-", "next_h(-1)", "smaller step h", "Step", group=_H),
    _key("space", "pause", "pause, resume", "Pause"),
    _key("v", "view", "next view", "View"),
    _key("?", "help", "this help", "Help"),
    _key("q", "app.quit", "finish the recording, quit", "Quit"),
    _key("f", "live", "continue a replay live", "Live"),
    _key("p", "next_scene", "next scene", "Scene"),
    Binding("ctrl+p", "find", "Find", True, "ctrl+p", True, "find scenes, themes, …"),
    _key("T,shift+t", "lesson", "tour: begin, leave, resume", "Tour"),
    _key("b", "reverse", "reverse time", "Back"),
    _key("u", "undo", "undo the last change", "Undo"),
    _key("i", "start_values", "edit initial values", "Edit"),
    _key("M,shift+m", "methods", "choose methods", "Methods"),
    _key("r", "restart", "restart; dims the old run", "Restart"),
    _key("n", "equal_cost", "equal cost for all", "Equal cost"),
    _key("left", "seek(-1)", "back 1 s", "Seek", group=_SECONDS),
    _key("right", "seek(1)", "forward 1 s", "Seek", group=_SECONDS),
    _key("home", "part(-1)", "go to the start", group=_ENDS),
    _key("end", "part(1)", "go to the end", group=_ENDS),
    _key("pageup", "part(-0.1)", "back 10 %", shown="pgup", group=_TENTHS),
    _key("pagedown", "part(0.1)", "forward 10 %", shown="pgdn", group=_TENTHS),
    _key("comma", "step(-1)", "one step back", shown=",", group=_STEPS),
    _key(".", "step(1)", "one step forward", group=_STEPS),
    _key("[", "event(-1)", "previous event", group=_EVENTS),
    _key("]", "event(1)", "next event", group=_EVENTS),
    _key("<", "speed(-1)", "half speed", group=_SPEED),
    _key(">", "speed(1)", "double speed", group=_SPEED),
    *(
        _key(f"{n}", f"show({n - 1})", f"show or hide method {n}", group=_METHODS)
        for n in range(1, MAX_METHODS + 1)
    ),
    _key(f"{MAX_METHODS + 1}", f"show({MAX_METHODS})", "show the exact motion"),
    *(
        _key(f"f{n}", f"view({name!r})", f"view: {title}", shown=f"F{n}", group=_VIEWS)
        for n, (name, title) in enumerate(VIEWS.items(), 2)
    ),
    _key("e", "quantity", "chart: next quantity"),
    _key("y", "axes", "chart: log, log time, …"),
    _key("w", "window", "chart: last 20 s, 60 s, …"),
    _key("z", "zoom(0.5)", "chart: zoom in"),
    _key("escape", "back", "back from a view or a zoom", shown="esc"),
    _key("o", "switch('overview')", "overview: all angles"),
    _key("P,shift+p", "find('scene ')", "choose a scene"),
    _key("E,shift+e", "events", "list all events"),
    _key("m", "mark", "mark this moment"),
    _key("d", "describe", "describe in words"),
    _key("s", "screenshot", "save a screenshot"),
    _key("S,shift+s", "save_scene", "save as a scene file"),
    Binding("enter", "turn('forward')"),  # the lesson's panel shows these two
    Binding("backspace", "turn('back')"),
]
"""In the order of the help, and of the last line, which shows what fits of the first ones."""
if CAN_STOP:
    KEYS.append(_key("ctrl+z", "app.suspend_process", "suspend to the shell"))
