"""Describes in words which nation's law was applied, and in which drives it was assumed."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Final

from drivelint.catalogue import load_rules
from drivelint.drive.conditions import related_values
from drivelint.phrases import name_list, plural

if TYPE_CHECKING:
    from collections.abc import Iterator

    from drivelint.result.model import Result
    from drivelint.result.text import Row

_NATION_SOURCE_WORDS: Final = {"env": "--env", "trace": "the log", "map": "the map"}


def law_words(result: Result) -> str:
    """Return in words which nations' laws the rules implement, and whether these were applied; '' if no rule implements a law."""
    laws = sorted({tuple(rule["law"]) for rule in result.rules.select(["law"]).to_pylist() if rule["law"]})
    drives = [drive for drive in result.drives.to_pylist() if drive["status"] == "judged"]
    return (
        "; ".join(
            [*(_words_on_application_of_law(law, drives) for law in laws), *_words_on_unrequested_packs(laws, drives)]
        )
        if drives and laws
        else ""
    )


def _words_on_unrequested_packs(laws: list[tuple[str, ...]], drives: list[Row]) -> Iterator[str]:
    """Yield in words the packs that implement the law of a drive's nation, if no rule of the run implements it."""
    nations = {
        condition["value"]
        for drive in drives
        for condition in drive["conditions"]
        if condition["condition"] == "nation"
    }
    lacking = sorted(nation for nation in nations if not any(nation in related_values(law) for law in laws))
    for nation in lacking:
        rules = load_rules().values()
        packs = {
            rule.pack for rule in rules if rule.status == "stable" and rule.law and nation in related_values(rule.law)
        }
        if packs:
            yield f"of {nation} not requested: --rules {' --rules '.join(sorted(packs))}"


def _words_on_application_of_law(law: tuple[str, ...], drives: list[Row]) -> str:
    """Return in words whether this law was applied in the drives, and the source of each drive's nation."""
    applied = related_values(law)
    n_drives: Counter[str] = Counter()
    for drive in drives:
        nation = next((condition for condition in drive["conditions"] if condition["condition"] == "nation"), None)
        if nation is None:
            n_drives["assumed, as the nation is not known"] += 1
        else:
            how = "applied" if nation["value"] in applied else "not applied"
            n_drives[f"{how}: nation {nation['value']} by {_NATION_SOURCE_WORDS[nation['source']]}"] += 1
    texts = [words if n == len(drives) else f"{words} in {plural(n, 'drive')}" for words, n in sorted(n_drives.items())]
    return f"of {name_list(list(law))} {'; '.join(texts)}"
