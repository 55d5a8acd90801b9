"""What a fleet did: rates, coverage, missing signals, the difference of two audits, and other values of a parameter.

Each function takes a DuckDB connection with the views of an audit and runs SQL of `queries/fleet`; Python gets grouped rows only.

* `drives`: the columns of the table `drive`; `key`, which identifies log, map, rules and tool; `log`, its path or URL;
  `tags MAP(VARCHAR, VARCHAR)`, what the manifest says of it: release, site, vehicle, weather.
* `verdicts`, `findings`: the columns of the tables `verdict` and `finding`, and `key`.
* `rules`: the columns of the table `rule`.
"""
