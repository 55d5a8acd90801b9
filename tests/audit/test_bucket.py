"""Audits whose logs, map, manifest and results lie in an object store, also in one that fails now and then."""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING

import obstore
import pytest
from deltalake import DeltaTable

from drivelint.audit import bucket, merge
from drivelint.audit.store import open_store
from drivelint.errors import TraceError
from drivelint.fleet_report import page
from drivelint.report.progress import Silent
from tests.audit import fleet
from tests.audit.faulty import faults, s3
from tests.audit.here import run_audit

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

pytestmark = pytest.mark.ci

N_DRIVES = 12


@pytest.fixture(scope="module")
def server(drives: fleet.Fleet) -> Iterator[str]:
    with s3() as url, pytest.MonkeyPatch.context() as patch:
        _use(patch, url)
        home = drives.manifest.parent
        for file in sorted(path for path in home.rglob("*") if path.is_file()):
            obstore.put(
                bucket._bucket_client("s3://fleet"), f"data/{file.relative_to(home).as_posix()}", file.read_bytes()
            )
        yield url


def _use(patch: pytest.MonkeyPatch, url: str) -> None:
    """Make an S3 server that of the environment, as a user would."""
    for name, value in (
        ("AWS_ENDPOINT_URL", url),
        ("AWS_ACCESS_KEY_ID", "test"),
        ("AWS_SECRET_ACCESS_KEY", "test"),
        ("AWS_DEFAULT_REGION", "us-east-1"),
    ):
        patch.setenv(name, value)
    bucket._bucket_client.cache_clear()


@pytest.fixture(scope="module")
def digest(drives: fleet.Fleet, tmp_path_factory: pytest.TempPathFactory) -> str | None:
    return run_audit(drives, tmp_path_factory.mktemp("local") / "out").digest


def test_logs_map_manifest_and_results_in_a_bucket_give_the_tables_of_a_folder(
    drives: fleet.Fleet, digest: str | None, server: str
) -> None:
    counted = run_audit(
        drives, "s3://fleet/whole", sources="s3://fleet/data/fleet.csv", road="s3://fleet/data/ring.xodr"
    )
    assert (counted.n_judged, counted.digest) == (N_DRIVES, digest)
    again = run_audit(drives, "s3://fleet/whole", sources="s3://fleet/data/fleet.csv", road="s3://fleet/data/ring.xodr")
    assert (again.reused, again.digest) == (N_DRIVES, digest)


@pytest.mark.slow
def test_a_bucket_has_delta_tables_that_another_reader_reads(drives: fleet.Fleet, server: str) -> None:
    options, lake = {"allow_http": "true"}, "s3://fleet/lake/"
    (logs, road) = ("s3://fleet/data/logs/", "s3://fleet/data/ring.xodr")
    for n in range(2):
        counted = run_audit(drives, "s3://fleet/packed", delta=lake, sources=logs, road=road)
        former = DeltaTable("s3://fleet/lake/drives", storage_options=options)
        assert (former.version(), former.count()) == (0, N_DRIVES), f"given {n + 1} times"
    commit = bucket.Bucket(lake).read(
        f"drives/_delta_log/{0:020}.json"
    )  # history() would wait for the server of this process
    assert commit is not None
    assert f'"drivelint.digest":"{counted.digest}"'.encode() in commit
    one = f"{logs}drive-00000.parquet"
    run_audit(drives, "s3://fleet/packed", delta=lake, sources=one, road=road, prune=True)
    assert DeltaTable("s3://fleet/lake/drives", storage_options=options).to_pyarrow_table()["log"].to_pylist() == [one]
    assert former.to_pyarrow_table().num_rows == N_DRIVES, "a reader of the former version keeps it"
    with faults(server, 0.1) as (url, failed), pytest.MonkeyPatch.context() as patch:
        _use(patch, url)
        merge("s3://fleet/packed", Silent(), "s3://fleet/faulty-lake")
    bucket._bucket_client.cache_clear()
    assert sum(failed.values()) > 0
    assert DeltaTable("s3://fleet/faulty-lake/receipts", storage_options=options).count() == 1


@pytest.mark.slow
def test_a_store_that_fails_now_and_then_gives_the_same_tables(
    drives: fleet.Fleet, digest: str | None, server: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    with faults(server, 0.2) as (url, counted):
        _use(monkeypatch, url)
        got = run_audit(
            drives, "s3://fleet/faulty", sources="s3://fleet/data/fleet.csv", road="s3://fleet/data/ring.xodr"
        )
    _use(monkeypatch, server)
    assert all(counted.values()), counted
    assert (got.n_judged, got.digest) == (N_DRIVES, digest)


@pytest.mark.slow
def test_the_pages_of_drives_lie_in_the_bucket_and_an_earlier_reports_are_removed(
    drives: fleet.Fleet, server: str
) -> None:
    run_audit(drives, "s3://fleet/paged", sources="s3://fleet/data/fleet.csv", road="s3://fleet/data/ring.xodr")
    results = open_store("s3://fleet/paged")
    for most, due in ((None, N_DRIVES), (1, 1), (0, 0)):
        page.write_fleet_page("s3://fleet/paged", "html", (), None, most_drives=most)
        told = json.loads(results.read("drives/pages.json") or b"{}").get("written_by_drivelint", [])
        there = set(results.names("drives"))
        assert len(told) == due
        assert there == ({*told, "drives/pages.json"} if due else set())
        linked = set(re.findall(r'href="(drives/[^"]+)"', (results.read("fleet.html") or b"").decode()))
        assert linked <= there
        assert bool(linked) == bool(due)


@pytest.mark.slow
def test_a_prefix_of_logs_is_a_source(drives: fleet.Fleet, server: str) -> None:
    counted = run_audit(drives, "s3://fleet/prefix", sources="s3://fleet/data/logs/", road="s3://fleet/data/ring.xodr")
    assert counted.n_judged == N_DRIVES


def test_a_log_that_changes_between_listing_and_reading_is_refused(server: str, tmp_path: Path) -> None:
    found = bucket.find_object("s3://fleet/data/logs/drive-00000.parquet")
    assert found is not None
    with pytest.raises(TraceError, match="changed since it was listed"):
        bucket.download(found._replace(e_tag='"other"'), tmp_path)


def test_two_writers_of_one_receipt_have_one_winner(server: str) -> None:
    results = bucket.Bucket("s3://fleet/race")
    assert results.create("receipts/a.json", b"1")
    assert not results.create("receipts/a.json", b"2")
    assert results.read("receipts/a.json") == b"1"
    assert list(results.names("receipts")) == ["receipts/a.json"]
    results.delete(["receipts/a.json"])
    assert results.read("receipts/a.json") is None
