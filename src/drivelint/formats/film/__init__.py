"""Filmed drives: what was detected in each frame."""
