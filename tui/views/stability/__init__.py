"""Where each method becomes unstable (F5)."""
