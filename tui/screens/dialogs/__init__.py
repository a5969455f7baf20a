"""What lies over the lab until it is closed.

`modal` has what all share, and the command palette; `text` shows the help and other texts, `start_form` takes the start
values, `cast_form` the methods, and `scene_list` one of the scenes.
"""
