"""What a step does to neighbouring starts.

`tangent` differentiates a step; `area` carries a ring of neighbours along a run and measures the area it keeps.
"""
