"""Keeps pandas out of processes that are drivelint's own.

DuckDB and pyarrow import it wherever it is installed, to look whether a value is one of its own: half a second, and no value ever is. If
it is not installed, DuckDB searches for it again for each bound value.
"""

from __future__ import annotations

import sys
from importlib.abc import MetaPathFinder
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence
    from importlib.machinery import ModuleSpec
    from types import ModuleType


class _NoPandas(MetaPathFinder):
    def find_spec(
        self,
        fullname: str,
        path: Sequence[str] | None,  # noqa: ARG002 - the shape of what it overrides
        target: ModuleType | None = None,  # noqa: ARG002
    ) -> ModuleSpec | None:
        """Refuse pandas, and leave all else to the finders behind."""
        if fullname == "pandas":
            raise ModuleNotFoundError("no command of drivelint uses pandas", name=fullname)
        return None


def leave_out_pandas() -> None:
    """Let no library import pandas in this process from now on; for programs and workers, never for the library."""
    sys.meta_path.insert(0, _NoPandas())
