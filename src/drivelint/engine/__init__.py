"""Drives in batches: choose the map, derive the library tables, judge."""
