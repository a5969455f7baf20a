"""The lab (F2): everything at a glance.

`view` has the panes, and `layout` says where they go by the free cells: `pendulums` every frame;
`time_chart`, errors over time, whenever that makes a column more; `error_table` and `event_list` 5
times a second. `reach` says how large pendulums can be drawn.  Phase space comes from its own
folder.
"""
