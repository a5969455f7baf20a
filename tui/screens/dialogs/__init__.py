"""Screens over the lab until they are closed.

`modal` has what all share, and the command palette; `text` shows the help and other texts, `forms`
take a scene, the methods, or the start values.
"""
