"""Foxglove scenes in MCAP."""
