"""A PostGIS database for the length of a comparison: the one named by the user, or a server of our own."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
import uuid
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from tests.bench.table import Skipped

if TYPE_CHECKING:
    from collections.abc import Iterator

URL = "DRIVELINT_BENCH_POSTGIS"
# generous: nothing is made durable, memory for every sort, both cores, no compiling of short statements
SETTINGS = {
    "shared_buffers": "1GB",
    "work_mem": "256MB",
    "maintenance_work_mem": "256MB",
    "fsync": "off",
    "synchronous_commit": "off",
    "full_page_writes": "off",
    "max_wal_size": "4GB",
    "jit": "off",
    "listen_addresses": "",
}


class Database:
    """Runs scripts with `psql` in a schema of its own."""

    def __init__(self, psql: str, url: str) -> None:
        self._psql = psql
        self._url = url
        self._schema = f"drivelint_bench_{uuid.uuid4().hex[:8]}"

    def run(self, script: str) -> list[list[float]]:
        """Run a script and return the numbers that it prints, row by row. Errors: `RuntimeError` with what PostgreSQL says."""
        script = f"SET client_min_messages = warning; SET search_path = {self._schema}, public;\n{script}"
        command = [self._psql, "-X", "-q", "-A", "-t", "-v", "ON_ERROR_STOP=1", self._url]
        done = subprocess.run(command, input=script, capture_output=True, text=True, check=False)
        if done.returncode:
            raise RuntimeError(f"psql: {done.stderr.strip()}")
        return [[float(value) for value in line.split("|")] for line in done.stdout.splitlines() if line]

    def renew(self) -> None:
        """Drop what was made, and begin with an empty schema."""
        self.drop()
        self.run(f"CREATE SCHEMA {self._schema}")

    def drop(self) -> None:
        """Leave nothing behind."""
        self.run(f"DROP SCHEMA IF EXISTS {self._schema} CASCADE")


@contextmanager
def database() -> Iterator[Database]:
    """Yield a database with PostGIS. Errors: `Skipped` saying what is missing."""
    psql = shutil.which("psql")
    if psql is None:
        raise Skipped("no psql: install PostgreSQL's client")
    if url := os.environ.get(URL):
        yield from _with_postgis(Database(psql, url))
        return
    with _server() as url:
        yield from _with_postgis(Database(psql, url))


def _with_postgis(database: Database) -> Iterator[Database]:
    try:
        database.run("CREATE EXTENSION IF NOT EXISTS postgis")
    except RuntimeError as error:
        raise Skipped(f"no PostGIS: {error}") from error
    try:
        yield database
    finally:
        database.drop()


@contextmanager
def _server() -> Iterator[str]:
    """Start a server of our own on a socket in a temporary folder, and yield its URL."""
    programs = _programs()
    user = "postgres" if os.geteuid() == 0 else None  # a server refuses to be root
    home = Path(tempfile.mkdtemp(prefix="drivelint-pg-"))
    try:
        if user:
            shutil.chown(home, user)
        data, log = home / "data", home / "log"
        initdb = [str(programs / "initdb"), "-D", str(data), "-U", "bench", "-A", "trust", "--no-sync", "-E", "UTF8"]
        _do(initdb, user)
        settings = " ".join(f"-c {key}={value or repr('')}" for key, value in SETTINGS.items())
        control = [str(programs / "pg_ctl"), "-D", str(data), "-l", str(log), "-w"]
        _do([*control, "-o", f"-k {home} {settings}", "start"], user)
        try:
            yield f"postgresql://bench@/postgres?host={home}"
        finally:
            _do([*control, "-m", "immediate", "stop"], user)
    finally:
        shutil.rmtree(home, ignore_errors=True)


def _programs() -> Path:
    for folder in [Path(p) for p in os.environ.get("PATH", "").split(os.pathsep)] + sorted(
        Path("/usr/lib/postgresql").glob("*/bin"), reverse=True
    ):
        if (folder / "initdb").exists() and (folder / "pg_ctl").exists():
            return folder
    raise Skipped(f"no PostgreSQL server, and none named in {URL}")


def _do(command: list[str], user: str | None) -> None:
    done = subprocess.run(
        command,
        user=user,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,  # not a pipe: the server would keep it open
        stderr=subprocess.DEVNULL,
        cwd="/",
        check=False,
    )
    if done.returncode:
        raise Skipped(f"PostgreSQL does not start here: {Path(command[0]).name} ended with {done.returncode}")
