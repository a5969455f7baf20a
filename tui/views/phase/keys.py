"""The keys of phase space."""

from tui.views.keys import Key, arrows

BIG_STEP, _GROUP = 8, "phase space"  # dots
KEYS = (
    Key("", "tab", "in the lab: to this pane, for its keys", "", _GROUP),
    *arrows(_GROUP, "crosshair", "choose a start", BIG_STEP),
    Key("enter", "enter", "start at the crosshair", "choose", _GROUP, "Start"),
    Key("escape", "esc", "leave the crosshair, cancel a drag", "cancel", _GROUP),
    Key("z", "z", "zoom in at the crosshair or the pointer", "zoom(0.5)", _GROUP, "Zoom"),
    Key("Z,shift+z", "Z", "zoom out", "zoom(2.0)", _GROUP),
    Key("o", "o", "overview: the whole portrait", "whole", _GROUP, "Overview"),
    Key("c", "c", "angles within a turn, or unwrapped", "wrap", _GROUP, "Wrap"),
    Key("g", "g", "a ring of neighbours, of another radius", "radius(1)", _GROUP, "Ring"),
    Key("G,shift+g", "G", "a smaller ring, or none", "radius(-1)", _GROUP),
    Key("", "click, drag", "start there; a drag shows the orbit first", "", _GROUP),
    Key("", "wheel", "zoom at the pointer", "", _GROUP),
    Key("", "shift+drag", "move the picture, as arrows do at its edge", "", _GROUP),
)
