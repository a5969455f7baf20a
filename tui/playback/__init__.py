"""What a screen shows: a live run or a replay, without Textual."""
