"""The screens: the frame around the views, and the actions of the keys.

Each key is a line of BINDINGS beside its action; styles are in app.tcss.
"""
