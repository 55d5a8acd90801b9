"""What a verdict lacks, by code, and what to record or to provide."""
