"""What the studies among the commands compute, report and draw."""
