"""Source: what a screen shows, a live run or a replay."""

from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.replay import Replay

Source = Live | Replay
