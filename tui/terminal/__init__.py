"""The terminal: what it can do, and when it is gone; Textual's own driver does all else."""
