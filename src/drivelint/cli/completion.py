"""Shell completion of rule ids."""

from __future__ import annotations

from drivelint.resources import folder


def rule_ids(incomplete: str) -> list[str]:
    """Return the ids of shipped rules that begin with `incomplete`, from file names, without reading files."""
    files = (folder("queries") / "assertions").glob("*/*.sql")
    return sorted(name for file in files if (name := f"{file.parent.name}.{file.stem}").startswith(incomplete))
