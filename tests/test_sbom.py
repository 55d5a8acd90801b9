"""The SBOM beside the wheel: all that the wheel brings and nothing else, under accepted licences, and the same bytes each time."""

from __future__ import annotations

import hashlib
import json
import re
import subprocess
from typing import TYPE_CHECKING, Any

import pytest
from packaging.utils import canonicalize_name

from tests.installed import installed, refused
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from pathlib import Path

UNREACHABLE = 75


def licences(component: dict[str, Any]) -> str:
    told = component.get("licenses", ())
    each = (one.get("expression") or one["license"].get("id") or one["license"]["name"] for one in told)
    return "; ".join(each)


@pytest.mark.slow
@pytest.mark.timeout(1200)
def test_the_sbom_is_what_the_wheel_brings(tmp_path: Path) -> None:
    done = subprocess.run([ROOT / ".ci" / "sbom", tmp_path], check=False, capture_output=True, text=True)
    if done.returncode == UNREACHABLE:
        pytest.skip("the package index cannot be reached: no SBOM is made")
    assert done.returncode == 0, done.stderr
    (wheel,) = tmp_path.glob("*.whl")
    text = (tmp_path / f"{wheel.stem}.cdx.json").read_text(encoding="utf-8")
    sbom = json.loads(text)
    assert (sbom["bomFormat"], sbom["specVersion"]) == ("CycloneDX", "1.6")
    root = sbom["metadata"]["component"]
    digest = hashlib.sha256(wheel.read_bytes()).hexdigest()
    assert root["purl"] == f"pkg:pypi/drivelint@{wheel.name.split('-')[1]}"
    assert root["hashes"] == [{"alg": "SHA-256", "content": digest}]
    found = {str(canonicalize_name(component["name"])): component for component in sbom["components"]}
    due = installed(())
    assert found.keys() == due.keys()
    assert all(re.fullmatch(r"pkg:pypi/[\w.-]+@[\w.+-]+", component["purl"]) for component in found.values())
    said = {name: licences(component) or due[name] for name, component in found.items()}  # protobuf's is free text
    assert refused(said) == {}
    used = {ref for each in sbom["dependencies"] for ref in each.get("dependsOn", ())}
    assert used == {component["bom-ref"] for component in found.values()}
    assert not {"timestamp", "serialNumber"} & {*sbom, *sbom["metadata"]}
    assert not re.search(r"file:|/tmp|/home|/root", text)
    assert text == json.dumps(sbom, indent=1, sort_keys=True, ensure_ascii=False) + "\n"
