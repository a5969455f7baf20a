"""Phase space (F3, and a pane of the lab): theta across, omega up."""
