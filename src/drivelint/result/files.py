"""Result files appear whole or not at all: temporary file in the same folder, fsync, rename."""

from __future__ import annotations

import io
import os
import shutil
from hashlib import sha256
from typing import TYPE_CHECKING, Final

import pyarrow.parquet as pq

from drivelint.errors import DriveLintError, ExitCode, UsageError
from drivelint.result.geometry import with_geometry
from drivelint.result.schemas import OUTPUT_VERSION, conform
from drivelint.sql.store import column_comments

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    import pyarrow as pa

ROW_GROUP: Final = 1 << 17


class OutputError(DriveLintError):
    """A result could not be written; nothing half-written is left under its final name."""

    exit_code = ExitCode.TEMPFAIL


def parquet_bytes(rows: pa.Table, table: str) -> bytes:
    """Return an output table as Parquet; its columns are those of `schemas/`, whatever the chunks and metadata of `rows` were."""
    about = {"drivelint.table": table, "drivelint.output_schema": str(OUTPUT_VERSION)}
    return described_parquet(conform(rows, table), table, about)


def described_parquet(rows: pa.Table, table: str, about: Mapping[str, str]) -> bytes:
    """Return a table of `schemas/` as Parquet with the metadata `about`: the same bytes for the same rows.

    Every column carries its comment from `schemas/` as Arrow field metadata (`comment`). Tables that have a geometry are GeoParquet.
    """
    comments = column_comments()[table]
    described = rows.schema.with_metadata(about)
    for i, field in enumerate(rows.schema):
        described = described.set(i, field.with_metadata({"comment": comments[field.name]}))
    sink = io.BytesIO()
    pq.write_table(
        with_geometry(rows.cast(described).combine_chunks(), table),
        sink,
        version="2.6",
        data_page_version="1.0",
        compression="zstd",
        compression_level=3,
        use_dictionary=True,
        write_statistics=True,
        write_page_checksum=True,
        row_group_size=ROW_GROUP,
        store_schema=True,
    )
    return sink.getvalue()


def prepare_folder(out: Path) -> None:
    """Make the folder for results and make sure that files can be written there, before hours of work are done for it.

    Errors: `UsageError` where it is a file, `OutputError`.
    """
    if out.exists() and not out.is_dir():
        raise UsageError(f"--out {out}: is a file: give a folder for the results")
    probe = out / f".drivelint.{os.getpid()}.tmp"
    try:
        out.mkdir(parents=True, exist_ok=True)
        probe.touch()
        probe.unlink()
    except OSError as error:
        raise _unwritable(out, error) from error


def publish(out: Path, contents: dict[str, bytes], moved: dict[str, Path | None], mark: str | None = None) -> None:
    """Write files into the folder `out`, all of them complete on disk before the first gets its name.

    `contents`: name -> bytes; `moved`: name -> a finished file that is taken over, or None: what an earlier run left
    under that name goes, because it is not of this run. Names are published in order, those of `moved` first. `mark`: the name
    of the file that tells that the folder is whole: the earlier one goes before anything else changes.
    Errors: `OutputError` when the folder cannot be written (exit 75).
    """
    staged: list[tuple[Path, Path]] = []
    try:
        out.mkdir(parents=True, exist_ok=True)
        for name, source in moved.items():
            if source is not None:
                staged.append(_temporary(out / name))
                shutil.move(source, staged[-1][0])
        for name, content in contents.items():
            staged.append(_temporary(out / name))
            staged[-1][0].write_bytes(content)
        for temporary, _ in staged:
            _sync(temporary)
        for name in [mark] if mark else []:
            (out / name).unlink(missing_ok=True)
            _sync(out)
        for name in [name for name, source in moved.items() if source is None]:
            (out / name).unlink(missing_ok=True)
        for temporary, final in staged:
            temporary.replace(final)
        _sync(out)
    except OSError as error:
        raise _unwritable(out, error) from error
    finally:
        for temporary, _ in staged:
            temporary.unlink(missing_ok=True)


def _temporary(final: Path) -> tuple[Path, Path]:
    """Return the name beside a file under which it is written, and its own."""
    final.parent.mkdir(exist_ok=True)
    # its own name may be as long as names can be
    digest = sha256(final.name.encode("utf-8", "surrogateescape")).hexdigest()
    return final.with_name(f".{digest[:16]}.{os.getpid()}.tmp"), final


def _unwritable(out: Path, error: OSError) -> OutputError:
    return OutputError(
        f"{out}: cannot write the results: {error.strerror or error}; free the disk or choose another --out"
    )


def _sync(path: Path) -> None:
    """Force a file's content, or a folder's names, to the disk."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
