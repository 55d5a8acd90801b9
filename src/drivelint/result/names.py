"""The names of the files that `check --out` writes. The module is quick to import."""

from __future__ import annotations

from typing import Final

from drivelint import drivelint_files

MANIFEST: Final = drivelint_files.MANIFEST
RUN_FILE: Final = "run.json"
GATE_FILE: Final = "gate.json"
MARK_FILE: Final = "summary.json"
"""The file without which a folder is no result: it is written last."""
TABLE_OF_FILE: Final = {
    "verdicts": "verdict",
    "findings": "finding",
    "drives": "drive",
    "rules": "rule",
    "scenes": "scene",
    "lanes": "lane_shape",
    "spaces": "danger_space",
    "courses": "course",
    "tracks": "track",
    "overtakes": "overtake_record",
    "opportunities": "opportunity_record",
}
"""Stem of the Parquet file -> table of the schema."""
TABLE_OF_PICTURE_FILE: Final = {"pictures": "picture"}
"""Stem of the Parquet file that only results with camera pictures have -> table of the schema."""
REPORT_FILES: Final = {
    "html": "report.html",
    "junit": "junit.xml",
    "sarif": "report.sarif",
    "xqar": "report.xqar",
    "markdown": "report.md",
}
"""Report format -> name of the report file."""
RESULT_FILE_GLOBS: Final = (
    *(f"{name}.parquet" for name in (*TABLE_OF_FILE, *TABLE_OF_PICTURE_FILE)),
    *REPORT_FILES.values(),
    *(GATE_FILE, RUN_FILE, "margins.parquet", "drivelint.duckdb", MARK_FILE, MANIFEST),
    *("annotated/*.mcap", "annotated/viewer-layout.json"),
)
"""Globs for the names of all files that a result may have."""
