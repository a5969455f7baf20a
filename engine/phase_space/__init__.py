"""What a step does to neighbouring starts, and what many steps do to all of them.

`area` carries a ring of neighbours along a run and measures the area it keeps; `section` iterates the method's own
map from many starts and tells what kind of orbit one of them lies on.
"""
