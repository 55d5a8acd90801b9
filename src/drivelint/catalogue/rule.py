"""One rule, as the rest of the program uses it."""

from __future__ import annotations

from pathlib import Path  # noqa: TC003 - msgspec looks the field types up when it needs them

from drivelint.catalogue.header import ROAD_USERS, Header


class Rule(Header, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """One rule: its header, its SQL, and what is known about it without running it."""

    id: str
    pack: str
    pack_title: str
    path: Path
    version: str
    sections: dict[str, str]
    columns: dict[str, tuple[str, ...]]
    """Section -> its columns; @reference is missing here when it selects a star, or unites by name."""
    reason_codes: frozenset[str]
    """The codes that its SQL names as reasons."""
    quantities: frozenset[str]
    """What of the actors it uses (position, size, ...), as the columns that it reads declare."""
    is_named: bool = True
    """The user named this rule. If the log lacks a signal that it needs, it is unknown; without being named, it does not apply."""
    occasion_needs: frozenset[str]
    """Tables without whose rows it has no reference point or, if it is an invariant with @applies, no step to judge."""

    @property
    def per_profile(self) -> bool:
        """Whether it is judged against each profile."""
        return "profile" in self.columns["condition"]

    @property
    def per_object(self) -> bool:
        """Whether its condition is about an object."""
        return "object_id" in self.columns["condition"]

    @property
    def looks_at_others(self) -> bool:
        """Whether it reads of others than the ego, or names them; of a section with a star that is not known, and taken to be so."""
        whole = self.columns.keys() >= self.sections.keys()
        return (
            ROAD_USERS in self.needed_signals
            or not whole
            or any("object_id" in columns for columns in self.columns.values())
        )

    @property
    def needed_signals(self) -> tuple[str, ...]:
        """The signals that it needs: those that it requires, and `road_users` if it is about other actors."""
        from drivelint.sql.derivations import with_sources  # and with it the database

        return (*self.requires, *((ROAD_USERS,) if "pair" in with_sources(self.reads) else ()))

    def has_column(self, column: str) -> bool:
        """Whether the condition returns this column."""
        return column in self.columns["condition"]
