"""Reports about whole audits: the fleet page, pages of single drives, the difference of two audits, and other values of a parameter.

SQL does all grouping (`drivelint.fleet`, `queries/fleet_report`). Only rows of drives and findings that are shown reach Python. Each table
has a limited number of rows, and states how many it leaves out.
"""
