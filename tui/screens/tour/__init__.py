"""The tour in the lab: `touring` is what it adds to the lab's screen, `panel` the lines that say and ask."""
