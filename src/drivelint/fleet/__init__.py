"""Statistics of a fleet: rates, coverage, missing signals, the difference of two audits, and results for other parameter values.

Each function takes a DuckDB connection with the following views of an audit, and runs SQL of `queries/fleet`. Python only receives grouped
rows.

* `drives`: the columns of the table `drive`; `key`, which identifies log, map, rules and tool; `log`, its path or URL; `tags MAP(VARCHAR,
  VARCHAR)`, the tags in the manifest: release, site, vehicle, weather.
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
    """Return a module by its earlier name, and warn that the name is deprecated."""
    if name not in _EARLIER_NAMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module = _EARLIER_NAMES[name]
    warnings.warn(f"{__name__}.{name} is deprecated: use {__name__}.{module}", DeprecationWarning, stacklevel=2)
    return importlib.import_module(f"{__name__}.{module}")
