"""What pip installs with drivelint, and under which licences: as far as it is installed here."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Sequence
from importlib.metadata import PackageNotFoundError, distribution
from itertools import chain

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from tests.shared_data import ROOT

ACCEPTED = re.compile(
    r"\b(?:MIT|0?BSD|Apache|ISCL?|PSF|Python Software Foundation|Zlib|CC0|Unlicense"
    r"|MPL|Mozilla Public License|EPL-2\.0|LGPL|Lesser General Public License)\b",
    re.IGNORECASE,
)
COPYLEFT = re.compile(r"(?<!L)GPL|(?<!Lesser )General Public License|AGPL|SSPL|EUPL|CC-BY-SA", re.IGNORECASE)
USED = ("dask", "delta", "lanelet2", "live", "ray", "sumo", "timestamp", "viewers")
"""The extras of users; `dev` is what tests need."""


def licence(name: str) -> str:
    about = distribution(name).metadata
    classes = [
        each.rpartition(" :: ")[2] for each in about.get_all("Classifier") or [] if each.startswith("License ::")
    ]
    (expression, *_) = about.get_all("License-Expression") or [""]
    (text, *_) = about.get_all("License") or [""]
    return expression or "; ".join(classes) or text.split("\n")[0]


def installed(extras: Sequence[str] = USED) -> dict[str, str]:
    """Return the distributions that drivelint and its extras need, as far as they are installed, and their licences."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    wanted = [*project["dependencies"], *chain.from_iterable(project["optional-dependencies"][name] for name in extras)]
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


def refused_licences(licences: dict[str, str]) -> dict[str, str]:
    """Return those that cannot be accepted; of a choice of licences, one that can is enough."""
    return {
        name: said
        for name, said in licences.items()
        if all(COPYLEFT.search(one) or not ACCEPTED.search(one) for one in said.split(" OR "))
    }
