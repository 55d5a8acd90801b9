"""A cache, in the user's cache folder, for facts that depend on a text alone and take long to compute.

A stored fact is valid for the code, the versions and the declarations with which it was computed; any other version computes it again.
Without a writable cache folder, facts are always computed. `DRIVELINT_CACHE_DIR` names another folder; if it is empty, nothing is stored.
"""

from __future__ import annotations

import atexit
import os
import sys
from contextlib import suppress
from functools import cache
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path
from tempfile import NamedTemporaryFile
from typing import TYPE_CHECKING, Any, Final, Generic, TypeVar

import msgspec

from drivelint.resources import folder

if TYPE_CHECKING:
    from collections.abc import Callable

T = TypeVar("T")
SQL_CODE_GLOBS: Final = (
    "*.py",
    "sql/*.py",
    "catalogue/*",
    "drive/conditions.*",
    "drive/declared_events.*",
    "reasons/*",
)
"""The files of the package that read SQL and rules."""
MOST_FACTS_IN_FILE: Final = 4096
"""The largest number of facts in a file. If there are more, only the facts that this process has used are written."""
MOST_KEPT_FILES_OF_OTHER_VERSIONS: Final = 5
"""The number of files of other drivelint versions that are kept, since several environments may use the cache in turn."""


@cache
def cache_folder() -> Path | None:
    """Return the cache folder; None: nothing is cached."""
    from platformdirs import user_cache_path

    folder = os.environ.get("DRIVELINT_CACHE_DIR")
    if folder is not None:
        return Path(folder) if folder else None
    with suppress(OSError, RuntimeError):  # the user has no home folder
        return user_cache_path("drivelint")
    return None


@cache
def code_and_version_hash(code_globs: tuple[str, ...]) -> str:
    """Return the hash of what all facts depend on: versions, the files in `code_globs`, declarations and macros."""
    versions = [version(name) for name in ("duckdb", "jinja2", "msgspec")]
    digest = sha256(" ".join([sys.version, *versions]).encode())
    package = Path(__file__).parent
    files = [file for pattern in code_globs for file in package.glob(pattern)]
    files += [*folder("schemas").glob("*"), *(folder("queries") / "macros").glob("*")]
    files += (folder("queries") / "library").glob("*/*.sql")
    for file in sorted(file for file in files if file.is_file()):
        content = file.read_bytes()
        digest.update(f"{file.name} {len(content)}\0".encode() + content)
    return digest.hexdigest()


class Memo(Generic[T]):
    """Stores facts of one kind in one file. `fact_type`: their type, which msgspec must support; `code_globs`: the files that compute
    them."""

    def __init__(self, name: str, fact_type: Any, code_globs: tuple[str, ...] = SQL_CODE_GLOBS) -> None:
        self._name, self._kind, self._code = name, fact_type, code_globs
        self._facts: dict[str, T] | None = None
        self._used: set[str] = set()
        self._has_new = False

    def find_or_compute(self, text: str, compute: Callable[[], T]) -> T:
        """Return the fact about a text; if it is not stored, compute it by `compute`. Errors of `compute` are not stored."""
        value = self.get(text)
        return self.put(text, compute()) if value is None else value

    def get(self, text: str) -> T | None:
        """Return the fact about a text; None: it is not stored."""
        return self._stored_facts().get(self._key(text))

    def put(self, text: str, fact: T) -> T:
        """Store a fact, and return it."""
        self._stored_facts()[self._key(text)] = fact
        if not self._has_new:
            self._has_new = True
            atexit.register(self.save)
        return fact

    def save(self) -> None:
        """Write the facts to the file, completely or not at all."""
        file, facts = self._cache_file, self._facts
        if file is None or not facts or not self._has_new:
            return
        self._has_new = False
        if len(facts) > MOST_FACTS_IN_FILE:
            facts = {key: fact for key, fact in facts.items() if key in self._used}
        with suppress(OSError):
            file.parent.mkdir(parents=True, exist_ok=True)
            with NamedTemporaryFile(dir=file.parent, prefix=f".{self._name}-", delete=False) as part:
                part.write(msgspec.msgpack.encode(facts, enc_hook=str))
            Path(part.name).replace(file)
            files = sorted(file.parent.glob(f"{self._name}-*.msgpack"), key=lambda path: path.stat().st_mtime_ns)
            for old in files[: -1 - MOST_KEPT_FILES_OF_OTHER_VERSIONS]:
                old.unlink()

    @property
    def _cache_file(self) -> Path | None:
        home = cache_folder()
        return None if home is None else home / f"{self._name}-{code_and_version_hash(self._code)[:16]}.msgpack"

    def _key(self, text: str) -> str:
        key = sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:32]
        self._used.add(key)
        return key

    def _stored_facts(self) -> dict[str, T]:
        if self._facts is None:
            self._facts = {}
            if self._cache_file is not None:
                with suppress(OSError, msgspec.MsgspecError):  # a damaged file counts as missing
                    self._facts = msgspec.msgpack.decode(
                        self._cache_file.read_bytes(),
                        type=dict[str, self._kind],  # type: ignore[name-defined]
                        dec_hook=lambda kind, text: kind(text),  # a path: the only type here that msgspec does not know
                    )
        return self._facts
