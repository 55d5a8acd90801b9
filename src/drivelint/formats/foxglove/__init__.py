"""Reads Foxglove scenes in MCAP files, and declares Foxglove's messages."""
