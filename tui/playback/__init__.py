"""What a screen shows, without a screen: a lab that runs, or a recording that is played.

`source` is what both offer.  `live` is a run that follows the clock and is recorded; `compiler`
compiles its loops in the background.  `replay` plays a recording; `cursor` is a place in its file,
`marks` are kept beside the file.  `playhead` turns the clock into a position.  `so_far` is the run
up to the sample with its `history`, whose `rows` are for chart and trails; `ghost` is an earlier
run laid under it.  `shown` is what is on screen, and `state` is what an undo restores.
"""
