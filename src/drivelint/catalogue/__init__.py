"""The rule catalogue: finds, reads, checks and selects rule files. It treats a rule as data, and runs none."""

from __future__ import annotations

from drivelint.catalogue.header import Conditions, Header, Param, json_schema
from drivelint.catalogue.load import load_rule, load_rules, read_rule
from drivelint.catalogue.rule import Rule
from drivelint.catalogue.select import default_packs, parse_params, required_rules, select_rules

__all__ = [
    "Conditions",
    "Header",
    "Param",
    "Rule",
    "default_packs",
    "json_schema",
    "load_rule",
    "load_rules",
    "parse_params",
    "read_rule",
    "required_rules",
    "select_rules",
]
