"""No dependency has a licence that would bind drivelint's users beyond MPL, EPL or LGPL: all that pip would install, extras included."""

from __future__ import annotations

import tomllib
from importlib.metadata import distribution

from packaging.requirements import Requirement

from tests.installed import installed, refused_licences
from tests.shared_data import ROOT


def test_every_licence_is_known_and_none_is_strong_copyleft() -> None:
    licences = installed()
    assert {"duckdb", "msgspec", "pyarrow", "typer"} <= licences.keys()
    assert [name for name, told in licences.items() if "LGPL" in told or "Lesser" in told] == []
    assert refused_licences(licences) == {}


def test_others_would_be_refused() -> None:
    bad = {
        "a": "GPL-3.0-or-later",
        "b": "GNU General Public License v3 (GPLv3)",
        "c": "GNU Affero General Public License v3",
        "d": "",
        "e": "Proprietary",
        "f": "MIT AND GPL-2.0-only",
        "j": "AGPL-3.0-only OR GPL-2.0-or-later",
    }
    good = {
        "g": "GNU Library or Lesser General Public License (LGPL)",
        "h": "LGPL-2.1-only",
        "i": "MPL-2.0",
        "k": "EPL-2.0 OR GPL-2.0-or-later",
    }
    assert refused_licences({**bad, **good}).keys() == bad.keys()


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
