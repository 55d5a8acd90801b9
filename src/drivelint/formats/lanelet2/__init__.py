"""Lanelet2 maps."""
