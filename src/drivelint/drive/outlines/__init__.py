"""What a log states of things that do not move and are no actors."""
