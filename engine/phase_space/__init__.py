"""What a step does to neighbouring starts, and what many steps do to all of them.

`area` carries a ring of neighbours along a run and measures its area; `section` iterates the
method's own map from many starts, and classifies the orbit from one of them.
"""
