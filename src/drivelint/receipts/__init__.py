"""Receipts of `check`: the output of a run, stored with the state of everything that the run read.

If a later run has the same request and finds all inputs unchanged, it writes and prints the same output without judging.
"""
