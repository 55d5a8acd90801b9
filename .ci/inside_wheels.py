"""Completes an SBOM by what wheels say of themselves: their licence, and what they carry inside."""

import json
from email.message import Message
from importlib.metadata import Distribution, distributions
from pathlib import Path, PurePosixPath
from typing import Any

KEPT = ("type", "name", "version", "licenses", "purl")


def complete(sbom: dict[str, Any], folder: Path) -> None:
    """Give each component its licence and its inner components, as far as the metadata in `folder` (site-packages) tells."""
    installed = {_plain(each.metadata["Name"]): each for each in distributions(path=[str(folder)])}
    for component in sbom["components"]:
        wheel = installed.get(_plain(component["name"]))
        if wheel is None:
            continue
        if not component.get("licenses"):
            component["licenses"] = [{"license": {"name": _licence(wheel.metadata)}}]
        if inner := [*_said(wheel), *_libraries(wheel)]:
            component["components"] = [
                {**each, "bom-ref": f"{component['bom-ref']}/{no}"} for no, each in enumerate(inner, 1)
            ]


def _plain(name: str) -> str:
    return name.lower().replace("_", "-").replace(".", "-")


def _licence(metadata: Message) -> str:
    """Return the first line of what is said of the licence, for a wheel that gives neither an expression nor a classifier."""
    return next((line.strip() for line in (metadata["License"] or "").splitlines() if line.strip()), "not said")


def _said(wheel: Distribution) -> list[dict[str, Any]]:
    """Return what the SBOMs in a wheel name (PEP 770), each once, without itself."""
    found: dict[tuple[str, str], dict[str, Any]] = {}
    for file in _files(wheel):
        if ".dist-info/sboms/" not in str(file) or file.suffix != ".json":
            continue
        told = json.loads(Path(str(wheel.locate_file(file))).read_text("utf-8"))
        for each in told.get("components", ()):
            if _plain(each["name"]) == _plain(wheel.metadata["Name"]):
                continue
            kept = {key: each[key] for key in KEPT if key in each}
            if "purl" in kept:
                kept["purl"] = kept["purl"].partition("?")[0].partition("#")[0]  # where it was built is of no interest
            found[each["name"], each.get("version", "")] = kept
    return [found[key] for key in sorted(found)]


def _libraries(wheel: Distribution) -> list[dict[str, Any]]:
    """Return shared libraries that a wheel was given when it was built for many systems, unless an SBOM in it names them."""
    files = _files(wheel)
    if any("/sboms/auditwheel" in str(file) for file in files):
        return []
    return [
        {"type": "file", "name": file.name} for file in files if file.parts[0].endswith(".libs") and ".so" in file.name
    ]


def _files(wheel: Distribution) -> list[PurePosixPath]:
    return sorted(wheel.files or [])
