"""A recording -> a layout for Foxglove and Lichtblick: its errors over time, each method's own plane, the events."""

from collections.abc import Iterable, Sequence
from typing import Any

from engine.methods import METHODS
from engine.models import MODELS
from recordings.fields import extra_names
from recordings.format import EVENTS, topic
from tui.drawing.palette import palette

_COLOURS = palette("dark")
_LABELS = {method.key: method.label for method in METHODS}
_SERIES = {method.key: number for number, method in enumerate(METHODS)}

Layout = dict[str, Any]


def layout(keys: Iterable[tuple[str, str]]) -> Layout:
    """The layout for the readings of these models and methods: their keys, as `topic` takes them."""
    keys = list(keys)
    conserved = all(MODELS[model].energy_error.conserved for model, _ in keys if model in MODELS)
    error = "Energy error (E - E0) / E0" if conserved else "Energy error (E - E0) / E0, with friction ln(E/E_true)"
    upper = {"Plot!energyerror": _plot(error, [_path(*each, "energy_error") for each in keys])}
    if springs := [each for each in keys if "spring_energy" in extra_names(each[0])]:
        upper["Plot!springenergy"] = _plot(
            "Energy in the spring, 1 at the start", [_path(*each, "spring_energy") for each in springs]
        )
    upper["RawMessages!events"] = {**_titled("Events"), "topicPath": EVENTS, "diffEnabled": False, "expansion": "all"}
    lower = {f"Plot!{model}{method}": _plane(model, method) for model, method in keys}
    return {
        "configById": upper | lower,
        "globalVariables": {},
        "userNodes": {},
        "playbackConfig": {"speed": 1},
        "layout": {
            "direction": "column",
            "first": _tiled(list(upper)),
            "second": _tiled(list(lower)),
            "splitPercentage": 50,
        },
    }


def _titled(title: str) -> Layout:
    return {"foxglovePanelTitle": title, "lichtblickPanelTitle": title}


def _path(model: str, method: str, field: str) -> Layout:
    return {
        "value": f"{topic(method, model)}.{field}",
        "label": _LABELS.get(method, method),
        "color": _COLOURS.colour(_SERIES.get(method, len(_SERIES))).lower(),
        "enabled": True,
        "timestampMethod": "receiveTime",
    }


def _plot(title: str, paths: Sequence[Layout], **other: Any) -> Layout:
    return {
        "title": title,
        **_titled(title),
        "paths": paths,
        "showLegend": len(paths) > 1,
        "legendDisplay": "floating",
        "showXAxisLabels": True,
        "showYAxisLabels": True,
        "isSynced": True,
        "xAxisVal": "timestamp",
        **other,
    }


def _plane(model: str, method: str) -> Layout:
    """Where the bob goes in the plane, or else in phase space."""
    across, up, units = ("x", "y", "") if "x" in extra_names(model) else ("theta", "omega", " [rad/s] over theta [rad]")
    title = f"{_LABELS.get(method, method)}: {up}{units or ' over x'}"
    path = {"value": f"{topic(method, model)}.{across}", "enabled": True}
    return _plot(title, [_path(model, method, up)], isSynced=False, xAxisVal="custom", xAxisPath=path)


def _tiled(names: Sequence[str]) -> Any:
    """Panels side by side, alike wide."""
    if len(names) == 1:
        return names[0]
    middle = len(names) // 2
    return {
        "direction": "row",
        "first": _tiled(names[:middle]),
        "second": _tiled(names[middle:]),
        "splitPercentage": 100 * middle / len(names),
    }
