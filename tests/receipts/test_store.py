"""The receipts that are kept: whole or none, and no more than a few."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING

import pytest

from drivelint.receipts import store
from drivelint.receipts.inputs import RunInputs
from drivelint.receipts.store import Receipt

if TYPE_CHECKING:
    from pathlib import Path

KEY = "a" * 64


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(store, "cache_folder", lambda: tmp_path / "cache")
    return tmp_path / "cache" / "receipts"


def stored_receipt(out: Path, key: str = KEY, content: bytes = b"rows") -> Receipt:
    (out / "annotated").mkdir(parents=True, exist_ok=True)
    (out / "a.parquet").write_bytes(content)
    (out / "annotated" / "x.mcap").write_bytes(content[::-1])
    states = {"/log": "file 1", "/with \udcff": "absent"}
    sizes = {"a.parquet": len(content), "annotated/x.mcap": len(content)}
    receipt = Receipt(
        RunInputs(states, {"*": "2"}), "tëxt\n", ("a note",), 1, "2026-11-29", sizes, ("annotated/x.mcap",)
    )
    store.store_receipt(key, receipt, out)
    return receipt


def is_there(key: str = KEY) -> bool:
    with store.open_receipt(key) as found:
        return found is not None


def test_a_receipt_is_read_as_it_was_kept(home: Path, tmp_path: Path) -> None:
    receipt = stored_receipt(tmp_path / "out")
    (tmp_path / "out" / "a.parquet").write_bytes(b"another")
    with store.open_receipt(KEY) as found:
        assert found is not None
        assert found.receipt == receipt
        contents, moved = found.unpack(tmp_path / "work")
    assert contents == {"a.parquet": b"rows"}
    assert {name: path.read_bytes() for name, path in moved.items()} == {"annotated/x.mcap": b"swor"}
    assert moved["annotated/x.mcap"].is_relative_to(tmp_path / "work")
    assert not is_there("b" * 64)


def test_a_damaged_receipt_is_none(home: Path, tmp_path: Path) -> None:
    stored_receipt(tmp_path / "out")
    whole = (home / KEY).read_bytes()
    for at in (0, 20, len(whole) // 2, whole.index(b"\n") + 1, len(whole) - 33, len(whole) - 1):
        (home / KEY).write_bytes(whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1 :])
        assert not is_there(), at
    for size in (0, 1, 32, 33, len(whole) // 2, len(whole) - 1):
        (home / KEY).write_bytes(whole[:size])
        assert not is_there(), size
    (home / KEY).write_bytes(whole)
    assert is_there()
    (home / ("b" * 64)).write_bytes(whole)  # of another question
    assert not is_there("b" * 64)


def test_the_receipts_that_were_not_used_for_longest_go(
    home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(store, "MOST_KEPT_RECEIPTS", 3)
    for n, key in enumerate("abc"):
        stored_receipt(tmp_path / "out", key)
        os.utime(home / key, (n, n))
    assert is_there("a")  # is used
    stored_receipt(tmp_path / "out", "d")
    assert {path.name for path in home.iterdir()} == {"a", "c", "d"}


def test_receipts_take_no_more_bytes_than_they_may(home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "MOST_BYTES_OF_ALL_RECEIPTS", 5000)
    for n, key in enumerate("abc"):
        stored_receipt(tmp_path / "out", key, bytes(1000))
        os.utime(home / key, (n, n))
    assert {path.name for path in home.iterdir()} == {"b", "c"}
    monkeypatch.setattr(store, "MOST_BYTES_OF_ONE_RECEIPT", 1999)
    stored_receipt(tmp_path / "out", "e", bytes(1000))
    assert not is_there("e")


def test_a_file_that_changes_while_it_is_kept_leaves_nothing(home: Path, tmp_path: Path) -> None:
    (tmp_path / "x").write_bytes(b"longer")
    store.store_receipt(KEY, Receipt(RunInputs(), "", (), 0, files={"x": 3}), tmp_path)
    assert list(home.iterdir()) == []


def test_two_at_once_leave_a_whole_one(home: Path, tmp_path: Path) -> None:
    def keeps(n: int) -> None:
        for _ in range(20):
            stored_receipt(tmp_path / f"out{n}", content=b"%d" % n * 100_000)

    def reads(n: int) -> set[bytes]:
        found_ = set()
        for k in range(40):
            with store.open_receipt(KEY) as found:
                if found is not None:
                    contents, moved = found.unpack(tmp_path / f"work{n}-{k}")
                    found_ |= {contents["a.parquet"], moved["annotated/x.mcap"].read_bytes()}
        return found_

    with ThreadPoolExecutor(4) as pool:
        writers = [pool.submit(keeps, n) for n in (1, 2)]
        readers = [pool.submit(reads, n) for n in (3, 4)]
        for writer in writers:
            writer.result()
        seen = set.union(*(reader.result() for reader in readers))
    assert seen <= {b"1" * 100_000, b"2" * 100_000}
    assert [path.name for path in home.iterdir()] == [KEY]
    assert is_there()


def test_nothing_is_kept_without_a_cache_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "cache_folder", lambda: None)
    stored_receipt(tmp_path / "out")
    assert not is_there()
    (tmp_path / "file").write_text("")
    monkeypatch.setattr(store, "cache_folder", lambda: tmp_path / "file")  # cannot be written to
    stored_receipt(tmp_path / "out")
    assert not is_there()
