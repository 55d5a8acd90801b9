"""No dependency has a licence that would bind drivelint's users beyond MPL or LGPL: all that pip would install, extras included."""

from __future__ import annotations

import re
import tomllib
from importlib.metadata import PackageNotFoundError, distribution
from itertools import chain

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from tests.shared_data import ROOT

ACCEPTED = re.compile(
    r"\b(?:MIT|0?BSD|Apache|ISCL?|PSF|Python Software Foundation|Zlib|CC0|Unlicense"
    r"|MPL|Mozilla Public License|LGPL|Lesser General Public License)\b",
    re.IGNORECASE,
)
COPYLEFT = re.compile(r"(?<!L)GPL|(?<!Lesser )General Public License|AGPL|SSPL|EUPL|CC-BY-SA", re.IGNORECASE)
USED = ("dask", "lanelet2", "ray", "timestamp", "viewers")
"""The extras of users; `dev` is what tests need."""


def licence(name: str) -> str:
    about = distribution(name).metadata
    classes = [
        each.rpartition(" :: ")[2] for each in about.get_all("Classifier") or [] if each.startswith("License ::")
    ]
    (expression, *_) = about.get_all("License-Expression") or [""]
    (text, *_) = about.get_all("License") or [""]
    return expression or "; ".join(classes) or text.split("\n")[0]


def installed() -> dict[str, str]:
    """Return the distributions that drivelint and its extras need, as far as they are installed, and their licences."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    wanted = [*project["dependencies"], *chain.from_iterable(project["optional-dependencies"][name] for name in USED)]
    todo = [Requirement(each) for each in wanted]
    found: dict[str, str] = {}
    while todo:
        requirement = todo.pop()
        name = canonicalize_name(requirement.name)
        if name in found or (requirement.marker and not requirement.marker.evaluate({"extra": ""})):
            continue
        try:
            found[name] = licence(name)
        except PackageNotFoundError:
            continue  # of an extra that is not installed here
        todo += [Requirement(each) for each in distribution(name).requires or []]
    return found


def refused(licences: dict[str, str]) -> dict[str, str]:
    return {name: said for name, said in licences.items() if COPYLEFT.search(said) or not ACCEPTED.search(said)}


def test_every_licence_is_known_and_none_is_strong_copyleft() -> None:
    licences = installed()
    assert {"duckdb", "pebble", "pyarrow", "typer"} <= licences.keys()
    assert refused(licences) == {}


def test_others_would_be_refused() -> None:
    bad = {
        "a": "GPL-3.0-or-later",
        "b": "GNU General Public License v3 (GPLv3)",
        "c": "GNU Affero General Public License v3",
        "d": "",
        "e": "Proprietary",
        "f": "MIT AND GPL-2.0-only",
    }
    good = {"g": "GNU Library or Lesser General Public License (LGPL)", "h": "LGPL-2.1-only", "i": "MPL-2.0"}
    assert refused({**bad, **good}).keys() == bad.keys()


def test_duckdb_and_its_spatial_extension_are_pinned_to_one_version() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    pins = {r.name: str(r.specifier) for r in map(Requirement, project["dependencies"]) if r.name.startswith("duckdb")}
    assert pins.keys() == {"duckdb", "duckdb-extension-spatial"}
    assert len(set(pins.values())) == 1
    assert (
        pins["duckdb"]
        == f"=={distribution('duckdb').version}"
        == f"=={distribution('duckdb-extension-spatial').version}"
    )
