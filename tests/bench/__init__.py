"""Benchmarks: `python -m tests.bench` from the repository's root prints what the product takes, beside its bars."""
