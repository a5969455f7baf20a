"""Where methods fail.

`linear` has the limits of small swings; `outcomes` follows whole swings until they are lost, and
asks `chaos` whether they are chaotic.  `grid` tries every step size and amplitude, in strips for
any executor; `study` makes the table and the map.
"""
