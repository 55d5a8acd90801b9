"""`python -m tests.audit kills DRIVES KILLS`: a large fleet, audited with kills and without; both must give the same tables."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.audit import fleet
from tests.audit.kills import audit_with_kills


def main() -> None:
    """Print what was seen; exit 1 where the tables differ."""
    _, _, n_drives, n_kills = sys.argv
    with TemporaryDirectory(prefix="drivelint-audit-") as home:
        drives = fleet.write(Path(home) / "fleet", int(n_drives))
        begin = time.monotonic()
        code, killed = audit_with_kills(drives.command(Path(home) / "killed"), int(n_kills), 20.0)
        print(f"with {killed} kills: exit {code}, {time.monotonic() - begin:.0f} s")
        begin = time.monotonic()
        done = subprocess.run(
            [sys.executable, "-m", "drivelint", *drives.command(Path(home) / "whole")], check=False, capture_output=True
        )
        print(f"undisturbed: exit {done.returncode}, {time.monotonic() - begin:.0f} s")
        told = [json.loads((Path(home) / name / "summary.json").read_text("utf-8")) for name in ("killed", "whole")]
        for each in told:
            print(json.dumps(each, sort_keys=True))
        print(f"planted contacts: {len(drives.planted)}")
        sys.exit(int(told[0]["digest"] != told[1]["digest"]))


if __name__ == "__main__":
    main()
