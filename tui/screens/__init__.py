"""The screens: the lines around the views, and the actions of the keys.

Each key is a line of BINDINGS; styles are in app.tcss.
"""
