"""Source: what a screen shows."""

from tui.playback.live import Live
from tui.playback.replay import Replay

Source = Live | Replay
