"""Source: what a screen shows, a live run or a replay."""

from tui.playback.live import Live
from tui.playback.replay import Replay

Source = Live | Replay
