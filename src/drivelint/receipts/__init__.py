"""Receipts of `check`: the output of a run, kept with the state of everything that it read.

If a later run has the same request and finds all of this unchanged, it writes and prints the same without judging.
"""
