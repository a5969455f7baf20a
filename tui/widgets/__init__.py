"""Widgets.  Data comes down to them by reactives, what the user wants goes up as messages."""
