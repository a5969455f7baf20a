"""What the numbers mean, in English: Source -> text, without colours or a screen."""
