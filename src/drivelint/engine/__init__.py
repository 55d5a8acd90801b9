"""Judges drives in batches: chooses the map, derives the library tables, and evaluates the rules."""
