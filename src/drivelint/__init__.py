"""drivelint checks recorded drives against the rules of the road.

From Python: `drivelint.check`, `drivelint.open` and `drivelint.read_trace`; see `drivelint docs python`.
"""

from typing import TYPE_CHECKING

from drivelint.errors import DriveLintError as DriveLintError

__version__ = "0.1.0"
_LAZY = ("CheckResult", "Table", "TraceTables", "check", "open", "read_trace")
"""Names that are imported when they are asked for: `import drivelint` itself loads nothing heavy."""

if TYPE_CHECKING:
    from drivelint.api import CheckResult as CheckResult
    from drivelint.api import Table as Table
    from drivelint.api import TraceTables as TraceTables
    from drivelint.api import check as check
    from drivelint.api import open as open  # noqa: A004 - read as drivelint.open
    from drivelint.api import read_trace as read_trace
else:

    def __getattr__(name: str) -> object:
        if name not in _LAZY:
            raise AttributeError(f"module 'drivelint' has no attribute {name!r}")
        from drivelint import api

        return getattr(api, name)


def __dir__() -> list[str]:
    return sorted([*globals(), *_LAZY])
