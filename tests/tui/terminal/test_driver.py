import io
import sys
from importlib.util import find_spec
from types import ModuleType, SimpleNamespace

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style
from textual.color import Color
from textual.drivers._writer_thread import WriterThread

from pendu_tui.tui.terminal import driver
from pendu_tui.tui.terminal.driver import (
    CharacterSetFilter,
    PatientParser,
    is_writing,
    limit_pastes,
)
from pendu_tui.tui.terminal.options import CHARACTER_SETS

BOLD = Style(bold=True)


def written(text, character_set):
    filtered = CharacterSetFilter(character_set)
    assert filtered.enabled == (character_set != "braille")
    (segment,) = filtered.apply([Segment(text, BOLD)], Color.parse("black"))
    assert segment.style == BOLD
    return segment.text


def test_half_blocks_change_only_braille_and_in_ascii_frames_and_words_are_read_as_before():
    assert written("╭─ 57.3° 2× ▀█", "half") == "╭─ 57.3° 2× ▀█"
    assert written("⠀⠁⠂⠈⠐⠄⠠⡀⢀⣿", "half") == " ▀▀▀▀▄▄▄▄█"
    lines = "─━╺╸–−▔│┃╹╻▏▎▌▐▊▕┊"
    assert written(lines, "ascii") == 7 * "-" + 10 * "|" + ":"
    corners = "┌┐└┘├┤┬┴┼┿╋┏┓┗┛┣┫┻╭╮╰╯╴▛▜▙▟"
    assert written(f"{corners}█▀▄▁·…╱•", "ascii") == 27 * "+" + "#'...>/o"
    frame = ["╭─ h² ─╮", "│ 2×  …│", "╰──────╯"]
    assert [written(line, "ascii") for line in frame] == ["+- h2 -+", "| 2x  >|", "+------+"]
    assert written("Störmer, 2√2, ±57°, ½ µs ⣀⡀⠁⢸", "ascii") == "Stormer, 2V2, ~57o, _ us ..':"


@example("Ａ", "ascii")  # which is wide
@given(st.text(st.characters(exclude_categories=("Cc", "Cs"))), st.sampled_from(CHARACTER_SETS))
def test_whatever_is_written_keeps_its_width_and_ascii_is_ascii(text, character_set):
    assert cell_len(written(text, character_set)) == sum(map(cell_len, text))
    assert character_set != "ascii" or written(text, character_set).isascii()


def test_the_terminal_is_behind_while_textuals_queue_holds_a_frame():
    writer = WriterThread(io.StringIO())  # it is not started, so nothing leaves the queue
    app = SimpleNamespace(_driver=SimpleNamespace(_writer_thread=writer))
    assert not is_writing(app)
    writer.write("a frame")
    assert is_writing(app)
    assert not is_writing(SimpleNamespace(_driver=None))  # which has no such queue


def test_a_paste_without_an_end_ends_after_2_s_of_silence(monkeypatch):
    now = 0.0
    monkeypatch.setattr(driver, "time", SimpleNamespace(monotonic=lambda: now))
    parser = PatientParser()
    assert not [*parser.tick(), *parser.feed("\x1b[200~text")]
    now = 1.9
    assert not [*parser.tick(), *parser.feed("more")]
    now = 3.8
    assert not [*parser.tick()]
    now = 4.0
    assert [each.text for each in parser.tick()] == ["textmore"]
    assert [each.key for each in parser.feed("q")] == ["q"]
    now = 7.0
    assert not [*parser.tick(), *parser.feed("\x1b")]
    monkeypatch.setattr("textual._parser.get_time", lambda: float("inf"))
    assert [each.key for each in parser.tick()] == ["escape"]


@pytest.mark.parametrize("name", ["linux_driver", "web_driver", "win32"])
def test_a_paste_ends_after_a_while_with_every_driver_of_textual(name, monkeypatch):
    module = f"textual.drivers.{name}"
    assert "XTermParser(" in find_spec(module).loader.get_source(module)
    monkeypatch.setitem(sys.modules, module, ModuleType(module))
    limit_pastes()
    assert sys.modules[module].XTermParser is PatientParser
