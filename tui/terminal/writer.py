"""How far the terminal is behind."""

from typing import Any


def is_writing(app: Any) -> bool:
    """Return whether frames still wait to be written: on a slow line, another adds only delay.

    Textual queues 30 of them, some seconds at 64 KiB/s.  Where it has no such queue the answer is no.
    """
    writer = getattr(app._driver, "_writer_thread", None)
    queue = getattr(writer, "_queue", None)
    return queue is not None and not queue.empty()
