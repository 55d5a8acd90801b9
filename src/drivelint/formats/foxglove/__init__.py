"""Reads Foxglove scenes in MCAP files, and declares Foxglove's message types for writing."""
