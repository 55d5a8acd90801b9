"""The results of a fleet: rates, coverage, missing signals, the difference of two audits, and other values of a parameter.

Each function takes a DuckDB connection with the views of an audit and runs SQL of `queries/fleet`; Python gets grouped rows only.

* `drives`: the columns of the table `drive`; `key`, which identifies log, map, rules and tool; `log`, its path or URL;
  `tags MAP(VARCHAR, VARCHAR)`, what the manifest says of it: release, site, vehicle, weather.
* `verdicts`, `findings`: the columns of the tables `verdict` and `finding`, and `key`.
* `rules`: the columns of the table `rule`.
"""

from __future__ import annotations

import importlib
import warnings
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from types import ModuleType

_EARLIER_NAMES: Final = {"counted": "distinct_logs", "missing": "missing_signals"}


def __getattr__(name: str) -> ModuleType:
    """Return a module under its earlier name, with a note that the name is deprecated."""
    if name not in _EARLIER_NAMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module = _EARLIER_NAMES[name]
    warnings.warn(f"{__name__}.{name} is deprecated: use {__name__}.{module}", DeprecationWarning, stacklevel=2)
    return importlib.import_module(f"{__name__}.{module}")
