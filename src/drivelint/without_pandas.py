"""Prevents the import of pandas in drivelint's own processes.

DuckDB and pyarrow import pandas, if it is installed, to check whether a value is a pandas object. That takes half a second, and no value
ever is one. If pandas is not installed, DuckDB searches for it again for each bound value.
"""

from __future__ import annotations

import sys
from importlib.abc import MetaPathFinder
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence
    from importlib.machinery import ModuleSpec
    from types import ModuleType


class _PandasBlocker(MetaPathFinder):
    def find_spec(
        self,
        fullname: str,
        path: Sequence[str] | None,  # noqa: ARG002 - the signature of the base class
        target: ModuleType | None = None,  # noqa: ARG002
    ) -> ModuleSpec | None:
        """Raise an error for pandas; return None for all other modules, which the next finders look for."""
        if fullname == "pandas":
            raise ModuleNotFoundError("no command of drivelint uses pandas", name=fullname)
        return None


def block_pandas_import() -> None:
    """Prevent every later import of pandas in this process; for commands and workers, not for `import drivelint`."""
    sys.meta_path.insert(0, _PandasBlocker())
