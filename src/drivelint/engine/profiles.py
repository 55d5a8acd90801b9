"""Loads the profiles of `queries/profiles.toml`: styles of overtaking that a controller may follow (paper, Appendix A)."""

from __future__ import annotations

import math
import tomllib
from typing import TYPE_CHECKING

import msgspec
import pyarrow as pa

from drivelint.errors import RuleError, UsageError
from drivelint.phrases import hint
from drivelint.resources import folder
from drivelint.toml_text import parse_toml

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

DEFAULT_PROFILES = ("nominal", "observed")
"""The default profiles: an overtake as it is usually driven, and this overtake as it was driven."""


class Profile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One style of overtaking: angles in degrees, gaps in metres, and the range of speeds it applies to; all None for `observed`."""

    style: int
    pull_out_angle_deg: float | None = None
    cut_in_angle_deg: float | None = None
    pull_out_headroom_m: float | None = None
    cut_in_clearance_m: float | None = None
    v_min_mps: float | None = None
    v_max_mps: float | None = None


def load_profiles(dirs: Sequence[Path] = ()) -> dict[str, Profile]:
    """Return the built-in profiles, and those of the `profiles.toml` in each folder of `dirs`; later folders override earlier ones.

    Errors: `RuleError` naming the file, for invalid TOML or an unknown key.
    """
    profiles: dict[str, Profile] = {}
    for root in (folder("queries"), *dirs):
        file = root / "profiles.toml"
        if not file.is_file():
            continue
        try:
            profiles |= msgspec.convert(parse_toml(file.read_text(encoding="utf-8")), dict[str, Profile])
        except (tomllib.TOMLDecodeError, UnicodeDecodeError, msgspec.ValidationError, RecursionError) as error:
            raise RuleError(f"{file}: {error}") from error
    return profiles


def profile_table(profiles: dict[str, Profile], selected: Sequence[str]) -> pa.Table:
    """Return the rows of the library table `profile`. `selected`: names of profiles; empty: `DEFAULT_PROFILES`.

    Errors: `UsageError` for an unknown name, with the nearest known one.
    """
    names = set(selected or DEFAULT_PROFILES)
    for name in sorted(names - profiles.keys()):
        raise UsageError(f"no profile {name!r}; {hint(name, profiles)}")
    rows = []
    for name, profile in profiles.items():
        row = {"profile": name, **msgspec.structs.asdict(profile), "selected": name in names}
        for angle in ("pull_out_angle", "cut_in_angle"):
            degrees = row.pop(f"{angle}_deg")
            row[f"{angle}_rad"] = None if degrees is None else math.radians(degrees)
        rows.append(row)
    kinds = {"profile": pa.string(), "style": pa.int32(), "selected": pa.bool_()}
    return pa.Table.from_pylist(rows, schema=pa.schema([(key, kinds.get(key, pa.float64())) for key in rows[0]]))
