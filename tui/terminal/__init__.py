"""The terminal: its abilities and its loss; Textual's driver does the rest."""
