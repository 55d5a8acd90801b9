"""Fuzzing: valid files are damaged by chance, and the real readers and rules must refuse them, flag them or read them as before.

`python -m tests.fuzz N` runs N cases. A case is a pure function of the seed, the kind and its number, so each one can be repeated.
"""
