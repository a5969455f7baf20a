"""What a screen shows, without a screen: a lab that runs, or a recording that is played.

`source` is what both offer.  `live` is a run that follows the clock and is recorded; `compiler`
compiles its loops without keeping it waiting.  `replay` is a recording that follows the clock;
`cursor` is where it stands in the file and reads what came before, `marks` are kept next to the
file.  `playhead` turns readings of the clock into how far to go.  `so_far` is the run up to the
sample with its `history`, whose `rows` are for chart and trails; `ghost` is a recording laid under
it.  `shown` holds which methods and quantities are on screen, and `state` is what an undo brings
back.
"""
