"""drivelint checks recorded drives against the rules of the road.

From Python: `drivelint.check`, `drivelint.open`, `drivelint.diff` and `drivelint.read_trace`; see `drivelint docs python`. `__init__.pyi`
has the types of this module for type checkers.
"""

from importlib import import_module

from drivelint.errors import DriveLintError as DriveLintError

__version__ = "0.1.0"
__all__ = [
    "AuditResult",
    "CheckResult",
    "Comparison",
    "DriveLintError",
    "Explained",
    "Table",
    "TraceTables",
    "check",
    "diff",
    "open",
    "read_trace",
    "write_demo",
]
_API_NAMES = frozenset(__all__) - {"DriveLintError"}


def __getattr__(name: str) -> object:
    """Import the Python interface on first use: `import drivelint` itself loads nothing heavy."""
    if name not in _API_NAMES:
        raise AttributeError(f"module 'drivelint' has no attribute {name!r}")
    return getattr(import_module("drivelint.api"), name)


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])
