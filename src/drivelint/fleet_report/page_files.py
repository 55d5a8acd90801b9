"""Maintains the list of the drive pages beside the fleet page. A later report uses it to remove pages that it does not write again."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Final

import msgspec

from drivelint.fleet_report.drive_pages import DRIVE_PAGES_FOLDER, is_page_name

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from drivelint.audit.store import ResultStore

LIST_FILE: Final = f"{DRIVE_PAGES_FOLDER}/pages.json"
_JSON_KEY: Final = "written_by_drivelint"


@contextmanager
def list_pages_and_remove_earlier_ones(results: ResultStore, names: Collection[str]) -> Iterator[set[str]]:
    """List the pages in `pages.json`; after the block, remove the pages of an earlier report that are not among `names`.

    Yields the set of the names: a caller that does not write one of the pages discards its name. During the block, the list also has the
    earlier pages: if this report is killed, the next one knows all of them. Files that are not listed are never removed.
    Errors: `OutputError`.
    """
    earlier = _pages_of_earlier_report(results)
    if earlier or names:
        _write_page_list(results, {*earlier, *names})
    page_names = set(names)
    yield page_names
    if outdated_names := earlier - page_names:
        results.delete(sorted(outdated_names))
    if page_names:
        _write_page_list(results, page_names)
    elif earlier or names:
        results.delete([LIST_FILE])


def _pages_of_earlier_report(results: ResultStore) -> set[str]:
    """Return the pages of an earlier report. Other names in the list are ignored, because no foreign file may be removed."""
    try:
        content = msgspec.json.decode(results.read(LIST_FILE) or b"{}", type=dict[str, list[str]])
    except msgspec.MsgspecError:
        return set()
    return {name for name in content.get(_JSON_KEY, ()) if is_page_name(name)}


def _write_page_list(results: ResultStore, names: Collection[str]) -> None:
    content = msgspec.json.format(msgspec.json.encode({_JSON_KEY: sorted(names)}), indent=1)
    results.write(LIST_FILE, content + b"\n")
