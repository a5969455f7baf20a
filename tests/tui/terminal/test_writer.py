"""Whether the terminal is behind, by the queue of Textual's writer."""

import io
from types import SimpleNamespace

from textual.drivers._writer_thread import WriterThread

from tui.terminal.check import is_writing


def test_the_terminal_is_behind_while_textuals_queue_holds_a_frame():
    writer = WriterThread(io.StringIO())  # it is not started, so nothing leaves the queue
    app = SimpleNamespace(_driver=SimpleNamespace(_writer_thread=writer))
    assert not is_writing(app)
    writer.write("a frame")
    assert is_writing(app)


def test_a_driver_without_such_a_queue_is_never_behind():
    assert not is_writing(SimpleNamespace(_driver=None))
