"""From numbers to characters in colours."""
