"""Completion of the word that is being typed in a shell."""

from __future__ import annotations

from drivelint.resources import folder


def rule_ids(incomplete: str) -> list[str]:
    """Return the ids of the shipped rules that begin with the word, from the names of their files; no file is read."""
    files = (folder("queries") / "assertions").glob("*/*.sql")
    return sorted(name for file in files if (name := f"{file.parent.name}.{file.stem}").startswith(incomplete))
