"""Recordings: MCAP files of runs.

Written: samples and events --`format`--> messages --`recorder`--> file.
Read: file --`reader`--> chunks --`recording`--> samples and events of any moment.
"""
