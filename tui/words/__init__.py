"""What the numbers mean, in English, without colours or a screen."""
