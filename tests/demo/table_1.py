"""Table 1 of the paper, against which the demo's overtakes are held."""

from __future__ import annotations

TABLE_1 = {
    "safe": {"relaxed": "fail", "nominal": "pass", "aggressive": "pass"},
    "near-miss": {"relaxed": "fail", "nominal": "fail", "aggressive": "pass"},
    "collision": {"relaxed": "fail", "nominal": "fail", "aggressive": "fail"},
}
