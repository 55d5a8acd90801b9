"""Reads `<rule>.parts.toml`, an optional file beside a rule: it splits the rule's required value into parts, to explain a verdict.

    sql = "SELECT drive_id, ego_id, t_ns, thinking_m, braking_m FROM ..."

    [parts]
    thinking_m = "thinking"
    braking_m = "braking"

The SELECT has a row for each step at which the rule may require something. Its columns are the keys (with `object_id` and `profile` if
the requirement depends on them) and the parts, whose sum is the required value; NULL counts as no part. It may read the rule's tables and
parameters.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import msgspec

from drivelint.catalogue.check import check_query
from drivelint.errors import RuleError

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.catalogue.rule import Rule

KEY_COLUMNS: Final = ("drive_id", "ego_id", "t_ns", "object_id", "profile")
_REQUIRED_COLUMNS: Final = frozenset({"drive_id", "ego_id", "t_ns"})


class RequiredValueParts(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The parts of a rule's required value. `parts`: column of `sql` -> name of the part in words."""

    sql: str
    parts: dict[str, str]

    @property
    def key_columns(self) -> tuple[str, ...]:
        """The key columns that the SELECT returns."""
        return tuple(key for key in KEY_COLUMNS if key in (check_query(self.sql, "parts").columns or ()))

    @property
    def parameters(self) -> frozenset[str]:
        """The rule's parameters that the SELECT uses."""
        return check_query(self.sql, "parts").parameters


def parts_path(rule: Rule) -> Path:
    """Return the path of a rule's parts file, which may not exist."""
    return rule.path.with_suffix(".parts.toml")


def read_parts(rule: Rule) -> RequiredValueParts | None:
    """Return the parts of a rule's required value; None without a parts file.

    Errors: `RuleError` for an invalid file, or a SELECT with a table, parameter or column that is not allowed.
    """
    file = parts_path(rule)
    if not file.is_file():
        return None
    try:
        parts = msgspec.toml.decode(file.read_bytes(), type=RequiredValueParts)
    except (msgspec.MsgspecError, UnicodeDecodeError) as error:
        raise RuleError(f"{file}: {error}: write sql and [parts], as beside ukhc.r162.safe-distance-ahead") from error
    query = check_query(parts.sql, str(file))
    if strange := sorted(query.tables - set(rule.reads)):
        raise RuleError(f"{file}: reads {strange[0]!r}, which the rule does not read")
    if strange := sorted(query.parameters - rule.params.keys()):
        raise RuleError(f"{file}: ${strange[0]} is no parameter of the rule")
    columns = set(query.columns or ())
    if not columns >= _REQUIRED_COLUMNS or columns - set(KEY_COLUMNS) != parts.parts.keys():
        raise RuleError(f"{file}: the SELECT must return drive_id, ego_id, t_ns and the columns that [parts] names")
    return parts
