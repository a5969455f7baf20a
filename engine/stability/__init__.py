"""Where methods fail.

`linear` has the limits of small swings, `outcomes` follows whole swings to where they are lost, and `chaos` tells
why.  `grid` tries every step size and amplitude, in strips for any executor; `study` makes the table and the map.
"""
