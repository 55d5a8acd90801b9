"""Estimates how certain findings are: copies windows of their drives with assumed recording errors, and judges the copies."""
