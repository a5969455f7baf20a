"""Sittings in and out of MCAP files.  The only package that imports `mcap`; never Textual."""
