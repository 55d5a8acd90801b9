"""Receipts of `check`: what a run wrote and said, kept with the state of everything that it read.

A later run that is asked the same, and finds all of that unchanged, writes and says the same without judging.
"""
