"""Describes for each reason code what a verdict lacks, and what to record or to provide."""
