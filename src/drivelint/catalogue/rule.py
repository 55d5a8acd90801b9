"""The class `Rule`: one rule, read and checked."""

from __future__ import annotations

from pathlib import Path  # noqa: TC003 - msgspec looks the field types up when it needs them

from drivelint.catalogue.header import ROAD_USERS_SIGNAL, Header


class Rule(Header, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """One rule: its header, its SQL, and facts that were found by parsing its SQL."""

    id: str
    pack: str
    pack_title: str
    path: Path
    version: str
    sections: dict[str, str]
    columns: dict[str, tuple[str, ...]]
    """Section -> its columns; without @reference if that section selects `*` or is a UNION BY NAME."""
    reason_codes: frozenset[str]
    """The reason codes in its SQL."""
    quantities: frozenset[str]
    """The quantities of actors that it uses (position, size, ...), as declared by the columns that it reads."""
    is_named: bool = True
    """Whether the user selected the rule by its id. If the log lacks a needed signal, such a rule is unknown; else it does not apply."""
    occasion_needs: frozenset[str]
    """Tables that must have rows, else the rule has no reference point (or, for an invariant with @applies, no step to judge)."""

    @property
    def per_profile(self) -> bool:
        """Whether the rule is judged against each profile."""
        return "profile" in self.columns["condition"]

    @property
    def per_object(self) -> bool:
        """Whether the condition of the rule is about an object."""
        return "object_id" in self.columns["condition"]

    @property
    def looks_at_others(self) -> bool:
        """Whether the rule reads about other actors than the ego, or returns their ids; true if a section's columns are unknown (`*`)."""
        whole = self.columns.keys() >= self.sections.keys()
        return (
            ROAD_USERS_SIGNAL in self.needed_signals
            or not whole
            or any("object_id" in columns for columns in self.columns.values())
        )

    @property
    def needed_signals(self) -> tuple[str, ...]:
        """The signals that the rule needs: `requires`, and `road_users` if it is about other actors."""
        from drivelint.sql.derivations import tables_with_sources  # imported here, since it imports the database

        return (*self.requires, *((ROAD_USERS_SIGNAL,) if "pair" in tables_with_sources(self.reads) else ()))

    def has_column(self, column: str) -> bool:
        """Return whether the condition returns this column."""
        return column in self.columns["condition"]
