"""What a shell offers for a word that is being typed."""

from __future__ import annotations

from drivelint.resources import folder


def rule_ids(incomplete: str) -> list[str]:
    """Return the ids of the shipped rules that begin so, by the names of their files: none is read."""
    files = (folder("queries") / "assertions").glob("*/*.sql")
    return sorted(name for file in files if (name := f"{file.parent.name}.{file.stem}").startswith(incomplete))
