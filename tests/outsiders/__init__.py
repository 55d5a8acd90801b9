"""Scenes drawn by four outsiders, who knew the catalogue's page and the format of a log, and had not seen the code.

`first` has 128 of them, `second` 102, `third` and `fourth` 100 each: each with what happens and with the verdicts
that a careful examiner gives. Drives and judgements are theirs. `python -m tests.outsiders` prints where product and outsider differ, and
writes `fails.txt` anew.
"""
