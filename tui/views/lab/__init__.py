"""The lab (F2): everything at a glance."""
