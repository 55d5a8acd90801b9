"""Describes for each reason code why a verdict is unknown, and what to record or to provide."""
