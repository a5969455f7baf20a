"""What a screen shows, without a screen: a lab that runs, or a recording that is played.

`source` is either: `live` is a run that follows the clock and is recorded, `replay` plays a
recording and keeps `marks` beside it.  `common` is what they share: each has a `history`, the run up to the sample, whose
`rows` are for chart and trails; `ghost` is an earlier run laid under it.  `shown` is what is on
screen.
"""
