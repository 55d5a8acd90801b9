"""Object stores (`s3://`, `gs://`, `az://`) for results, logs, maps and manifests. Credentials come from the environment."""

from __future__ import annotations

import re
from contextlib import contextmanager
from datetime import timedelta
from functools import cache
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeVar

import obstore
from obstore import exceptions
from obstore.store import from_url

from drivelint.errors import DriveLintError, ExitCode, TraceError, UsageError
from drivelint.result.publishing import OutputError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator
    from pathlib import Path

T = TypeVar("T")

SCHEMES: Final = ("s3", "gs", "az")
_URL: Final = re.compile(rf"({'|'.join(SCHEMES)})://([^/]+)/?(.*)", re.DOTALL)
_RETRY_OPTIONS: Final[Any] = {
    "max_retries": 8,
    "retry_timeout": timedelta(seconds=120),
    "backoff": {"init_backoff": timedelta(seconds=0.1), "max_backoff": timedelta(seconds=10), "base": 2},
}
"""Requests to a busy store are repeated with increasing pauses; then the run ends with exit code 75."""
_MAX_REQUESTS_PER_ANSWER: Final = 6
"""Largest number of requests for an answer that is cut off each time."""
_CLIENT_OPTIONS: Final[Any] = {"allow_http": True, "timeout": timedelta(seconds=60)}


class StoreError(DriveLintError):
    """An object store does not answer, or refuses a request. The same command can be run again."""

    exit_code = ExitCode.TEMPFAIL


class BucketObject(NamedTuple):
    """An object of a store: its URL, its size in bytes, and its ETag, which changes with its content."""

    url: str
    size: int
    e_tag: str


def is_url(text: str) -> bool:
    """Return whether a text is a URL of an object store."""
    return _URL.fullmatch(text) is not None


def url_of_path(path: Path) -> str | None:
    """Return the URL in a path that was made from a URL, which drops one `/`; None: the path is local."""
    text = re.sub(r"^(\w+):/(?=[^/])", r"\1://", path.as_posix())
    return text if is_url(text) else None


@cache
def _bucket_client(root: str) -> Any:
    """Return the client for a bucket (`s3://name`). Errors: `UsageError` if it cannot be configured."""
    try:
        return from_url(root, client_options=_CLIENT_OPTIONS, retry_config=_RETRY_OPTIONS)
    except (exceptions.BaseError, ValueError) as error:
        raise UsageError(f"{root}: {_error_text(error)}") from error


def _client_and_prefix(url: str) -> tuple[Any, str]:
    match = _URL.fullmatch(url)
    if match is None:
        raise UsageError(f"{url}: write s3://BUCKET/PREFIX, gs://BUCKET/PREFIX or az://CONTAINER/PREFIX")
    return _bucket_client(f"{match[1]}://{match[2]}"), match[3].strip("/")


class Bucket:
    """A prefix of a bucket as `ResultStore`. An object exists completely or not at all; `create` is one conditional PUT."""

    def __init__(self, url: str) -> None:
        self._client, self._prefix = _client_and_prefix(url)
        self._url = url.rstrip("/")

    def create(self, name: str, content: bytes) -> bool:
        """See `ResultStore.create`."""
        with self._convert_errors(name):
            try:
                obstore.put(self._client, self._full_path(name), content, mode="create")
            except (exceptions.AlreadyExistsError, exceptions.PreconditionError):
                return False
        return True

    def write(self, name: str, content: bytes) -> None:
        """See `ResultStore.write`."""
        with self._convert_errors(name):
            obstore.put(self._client, self._full_path(name), content)

    def read(self, name: str) -> bytes | None:
        """See `ResultStore.read`."""
        with self._convert_errors(name):
            try:
                return _run_with_retries(lambda: bytes(obstore.get(self._client, self._full_path(name)).bytes()))
            except FileNotFoundError:
                return None

    def names(self, prefix: str) -> Iterator[str]:
        """See `ResultStore.names`."""
        with self._convert_errors(prefix):
            for about in _list_with_retries(self._client, self._full_path(prefix)):
                yield about["path"].removeprefix(self._prefix).lstrip("/")

    def delete(self, names: Iterable[str]) -> None:
        """See `ResultStore.delete`."""
        with self._convert_errors(""):
            some = [self._full_path(name) for name in names]
            for start in range(0, len(some), 1_000):
                obstore.delete(self._client, some[start : start + 1_000])

    def fetch(self, name: str, folder: Path) -> Path:
        """See `ResultStore.fetch`."""
        path = folder / name
        if not path.is_file():
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(self.read(name) or b"")
        return path

    def _full_path(self, name: str) -> str:
        return f"{self._prefix}/{name}".strip("/")

    @contextmanager
    def _convert_errors(self, name: str) -> Iterator[None]:
        try:
            yield
        except (exceptions.BaseError, OSError) as error:
            raise OutputError(f"{self._url}/{name}: {_error_text(error)}: try again later") from error


def list_objects(url: str) -> Iterator[BucketObject]:
    """Yield the objects below a URL prefix, in the order of the store. Errors: `StoreError`, `UsageError`."""
    client, prefix = _client_and_prefix(url)
    root = "/".join(url.split("/")[:3])
    try:
        for about in _list_with_retries(client, prefix):
            yield BucketObject(f"{root}/{about['path']}", about["size"], about["e_tag"] or "")
    except (exceptions.BaseError, OSError) as error:
        raise StoreError(f"{url}: {_error_text(error)}: try again later") from error


def find_object(url: str) -> BucketObject | None:
    """Return an object with its size and ETag; None: it does not exist. Errors: `StoreError`."""
    client, path = _client_and_prefix(url)
    try:
        about = obstore.head(client, path)
    except FileNotFoundError:
        return None
    except (exceptions.BaseError, OSError) as error:
        raise StoreError(f"{url}: {_error_text(error)}: try again later") from error
    return BucketObject(url, about["size"], about["e_tag"] or "")


def download(bucket_object: BucketObject, folder: Path) -> Path:
    """Download an object into a folder under the object's name; return the path of the copy.

    Errors: `TraceError` if the object was removed or has changed since it was listed; `StoreError`.
    """
    client, path = _client_and_prefix(bucket_object.url)
    copy = folder / (path.rpartition("/")[2] or "object")
    options: Any = {"if_match": bucket_object.e_tag} if bucket_object.e_tag else {}

    def download_into_local_file() -> None:
        with copy.open("wb") as file:
            for part in obstore.get(client, path, options=options).stream():
                file.write(part)

    try:
        _run_with_retries(download_into_local_file)
    except FileNotFoundError:
        raise TraceError(f"{bucket_object.url}: no such object: check the URL") from None
    except exceptions.PreconditionError:
        raise TraceError(f"{bucket_object.url}: changed since it was listed: audit it again") from None
    except (exceptions.BaseError, OSError) as error:
        raise StoreError(f"{bucket_object.url}: {_error_text(error)}: try again later") from error
    if copy.stat().st_size != bucket_object.size:
        raise StoreError(
            f"{bucket_object.url}: {copy.stat().st_size} of {bucket_object.size} bytes came: try again later"
        )
    return copy


def _list_with_retries(client: Any, prefix: str) -> Iterator[Any]:
    """Yield the objects below a prefix, page by page; a page that was cut off is requested again."""
    last: str | None = None
    for attempt in range(_MAX_REQUESTS_PER_ANSWER):
        try:
            for some in obstore.list(client, prefix=prefix or None, offset=last):
                for about in some:
                    yield about
                    last = about["path"]
            return  # noqa: TRY300 - return ends the loop
        except (exceptions.GenericError, OSError):
            if attempt + 1 == _MAX_REQUESTS_PER_ANSWER:
                raise


def _run_with_retries(job: Callable[[], T]) -> T:
    """Run a job that reads an object, and repeat it if the answer was cut off: the client does not repeat such requests itself."""
    for _ in range(_MAX_REQUESTS_PER_ANSWER - 1):
        try:
            return job()
        except FileNotFoundError:
            raise
        except (exceptions.GenericError, OSError):
            continue
    return job()


def _error_text(error: Exception) -> str:
    return " ".join(str(error).split())[:300]
