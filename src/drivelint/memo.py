"""Facts that follow from content alone, and take long to find, kept in the user's cache folder.

A fact is kept for the code, the versions and the declarations that it was found with: any other version computes it again. The same
happens without a writable cache folder. `DRIVELINT_CACHE_DIR` names another folder; empty, nothing is kept.
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
SQL_CODE: Final = ("*.py", "sql/*.py", "catalogue/*", "drive/conditions.*", "drive/declared_events.*", "reasons/*")
"""The files of the package that read SQL and rules."""
MOST_FACTS: Final = 4096
"""With more, only those that were asked for are kept."""
MOST_VERSIONS: Final = 5
"""Files of other versions that are kept: several environments may take turns."""


@cache
def cache_folder() -> Path | None:
    """Return the cache folder; None: nothing is kept."""
    from platformdirs import user_cache_path

    given = os.environ.get("DRIVELINT_CACHE_DIR")
    if given is not None:
        return Path(given) if given else None
    with suppress(OSError, RuntimeError):  # a user without a home
        return user_cache_path("drivelint")
    return None


@cache
def foundation(code: tuple[str, ...]) -> str:
    """Return the hash of the inputs of facts: versions, these files of the package, declarations and macros."""
    versions = [version(name) for name in ("duckdb", "jinja2", "msgspec")]
    said = sha256(" ".join([sys.version, *versions]).encode())
    package = Path(__file__).parent
    files = [file for pattern in code for file in package.glob(pattern)]
    files += [*folder("schemas").glob("*"), *(folder("queries") / "macros").glob("*")]
    for file in sorted(file for file in files if file.is_file()):
        content = file.read_bytes()
        said.update(f"{file.name} {len(content)}\0".encode() + content)
    return said.hexdigest()


class Memo(Generic[T]):
    """Keeps facts of one kind, in one file. `kind`: their type, which msgspec can write; `code`: the files that find them."""

    def __init__(self, name: str, kind: Any, code: tuple[str, ...] = SQL_CODE) -> None:
        self._name, self._kind, self._code = name, kind, code
        self._facts: dict[str, T] | None = None
        self._used: set[str] = set()
        self._has_new = False

    def of(self, content: str, find: Callable[[], T]) -> T:
        """Return the fact about a content, which `find` finds where it is not kept. Its errors are not kept."""
        known = self.get(content)
        return self.put(content, find()) if known is None else known

    def get(self, content: str) -> T | None:
        """Return the fact about a content; None: it is not kept."""
        return self._read().get(self._key(content))

    def put(self, content: str, fact: T) -> T:
        """Keep a fact, and return it."""
        self._read()[self._key(content)] = fact
        if not self._has_new:
            self._has_new = True
            atexit.register(self.save)
        return fact

    def save(self) -> None:
        """Write the facts, at once or not at all."""
        file, facts = self._file, self._facts
        if file is None or not facts or not self._has_new:
            return
        self._has_new = False
        if len(facts) > MOST_FACTS:
            facts = {key: fact for key, fact in facts.items() if key in self._used}
        with suppress(OSError):
            file.parent.mkdir(parents=True, exist_ok=True)
            with NamedTemporaryFile(dir=file.parent, prefix=f".{self._name}-", delete=False) as part:
                part.write(msgspec.msgpack.encode(facts, enc_hook=str))
            Path(part.name).replace(file)
            files = sorted(file.parent.glob(f"{self._name}-*.msgpack"), key=lambda each: each.stat().st_mtime_ns)
            for old in files[: -1 - MOST_VERSIONS]:
                old.unlink()

    @property
    def _file(self) -> Path | None:
        home = cache_folder()
        return None if home is None else home / f"{self._name}-{foundation(self._code)[:16]}.msgpack"

    def _key(self, content: str) -> str:
        key = sha256(content.encode("utf-8", "surrogatepass")).hexdigest()[:32]
        self._used.add(key)
        return key

    def _read(self) -> dict[str, T]:
        if self._facts is None:
            self._facts = {}
            if self._file is not None:
                with suppress(OSError, msgspec.MsgspecError):  # a damaged file is none
                    self._facts = msgspec.msgpack.decode(
                        self._file.read_bytes(),
                        type=dict[str, self._kind],  # type: ignore[name-defined]
                        dec_hook=lambda kind, text: kind(text),  # a path, the one type that it does not know
                    )
        return self._facts
