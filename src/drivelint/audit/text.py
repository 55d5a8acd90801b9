"""What `drivelint audit` prints at its end."""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.phrases import plural
from drivelint.result.counts import SEVERITIES

if TYPE_CHECKING:
    from drivelint.audit.summary import AuditSummary


def summary_text(counted: AuditSummary, out: str) -> str:
    """Return the lines: drives, failures by severity, what was not judged, and what to do next."""
    told = [f"{plural(counted.n_drives, 'drive')}, {counted.km:,.2f} km, {counted.hours:,.2f} h"]
    states = (
        f"{counted.judged} judged",
        f"{counted.reused} of all reused" if counted.reused else "",
        f"{counted.lossy} lossy" if counted.lossy else "",
        f"{counted.refused} refused" if counted.refused else "",
        f"{counted.quarantined} quarantined" if counted.quarantined else "",
    )
    told.append(", ".join(state for state in states if state))
    failed = [f"{counted.failed.get(severity, 0)} {severity}" for severity in SEVERITIES]
    told.append(f"failed verdicts: {', '.join(failed)}; unknown: {counted.unknown}")
    if counted.digest is None:
        told.append(f"when all shards have ended: drivelint merge {out}")
    else:
        told.append(f"look: drivelint report {out}")
        told.append(f'ask: drivelint sql {out} "SELECT rule_id, count(*) FROM findings GROUP BY ALL ORDER BY 2 DESC"')
    return "\n".join(told)
