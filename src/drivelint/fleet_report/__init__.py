"""What a person reads of whole audits: the fleet page, pages of single drives, the difference of two audits, other values of a parameter.

Everything is grouped in SQL (`drivelint.fleet`, `queries/fleet_report`). Rows of drives and findings reach Python only as far as they are
shown: each table has at most some of them, and states how many it leaves out.
"""
