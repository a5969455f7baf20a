"""What lies over the lab until it is closed: `modal` has what all share, and the command palette; `text` shows the help
and other texts, `forms` take a scene, the methods, or the start values.
"""
