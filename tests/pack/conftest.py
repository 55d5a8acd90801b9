"""The overtake fixture's collision, checked and packed once; and a second pack, of the near miss."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import pytest

from tests.explain.overtake_check import OVERTAKE, check
from tests.pack.packed import make_key, make_pack

if TYPE_CHECKING:
    from pathlib import Path


class Packed(NamedTuple):
    result: Path
    pack: Path
    other_pack: Path
    key: Path
    public: Path
    other_key: Path
    other_public: Path


@pytest.fixture(scope="session")
def packed(tmp_path_factory: pytest.TempPathFactory) -> Packed:
    folder = tmp_path_factory.mktemp("packed")
    key, public = make_key(folder, "ours")
    other_key, other_public = make_key(folder, "theirs")
    packs = []
    for name in ("collision", "near_miss"):
        check(folder / name, traces=(str(OVERTAKE / f"{name}.csv"),))
        packs.append(make_pack(folder / name, folder / f"{name}.pack", key, with_inputs=True))
    return Packed(folder / "collision", packs[0], packs[1], key, public, other_key, other_public)
