"""The Python environment of a peer, which drivelint's own must not share: its versions contradict ours."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

STL_MONITOR = (
    ("setuptools<80",),
    (
        "commonroad-io==2024.3",
        "commonroad-clcs==2025.2.0",
        "commonroad-drivability-checker==2025.4.0",
        "commonroad-route-planner==2025.1.0",
        "pandas==2.3.3",
        "ruamel.yaml",
        "typing-extensions",
    ),
    # Together with what they ask for they cannot be installed: the parsers of two of them want different runtimes of ANTLR.
    ("--no-deps", "commonroad-stl-monitor==2025.1.1", "rtamt==0.4.10", "antlr4-python3-runtime==4.9.3"),
)
"""What pip installs, call by call. torch, gpytorch and shap are not needed: see `stvo_peer.py`."""


def peer_python(folder: Path) -> Path:
    """Return the Python of the environment in a folder, which is made first if it is not there (needs the network; some minutes)."""
    python = folder / "bin" / "python"
    finished = folder / "finished"
    if not finished.exists():
        subprocess.run([sys.executable, "-m", "venv", "--clear", str(folder)], check=True)
        for arguments in STL_MONITOR:
            subprocess.run([str(python), "-m", "pip", "install", "--quiet", *arguments], check=True)
        finished.touch()
    return python
