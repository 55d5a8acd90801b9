"""Scenes drawn by seven outsiders, who knew the catalogue's page and the format of a log, and had not seen the code.

Each scene says what happens, and which verdicts a careful examiner gives. Drives and judgements are theirs. `python -m tests.outsiders`
prints where product and outsiders differ, and writes `fails.txt` anew. Those of thirteen others are data, in `tests/scenes`.
"""
