"""What a step does to neighbouring starts.

`area` carries a ring of neighbours along a run and measures the area it keeps.
"""
