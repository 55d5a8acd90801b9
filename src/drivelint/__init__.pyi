from drivelint.api import AuditResult as AuditResult
from drivelint.api import CheckResult as CheckResult
from drivelint.api import Comparison as Comparison
from drivelint.api import Explained as Explained
from drivelint.api import Table as Table
from drivelint.api import TraceTables as TraceTables
from drivelint.api import check as check
from drivelint.api import diff as diff
from drivelint.api import open as open  # noqa: A004 - read as drivelint.open
from drivelint.api import read_trace as read_trace
from drivelint.api import write_demo as write_demo
from drivelint.errors import DriveLintError as DriveLintError

__version__: str
