"""Computations, reports and figures of the larger commands."""
