"""Filmed drives: the detections in each frame."""
