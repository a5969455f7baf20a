"""The lab (F2): everything at a glance.

`view` arranges the panes: `pendulums` every frame; `time_chart`, errors over time, 5 times a second; `error_table` or,
for a projector, `large_table`, and `event_list` 10 times a second.  Phase space comes from its own folder.
"""
