"""Verdicts on the logs of the reference data, and how they differ from those of another version."""
