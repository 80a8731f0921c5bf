"""Entries of the cache with any bit turned, any byte cut out or put in: none is used, or it is the right one."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import installed_paper
import pytest
from attack import Attack

from replicate.exhibits import Paper
from replicate.run.cache import Cache
from replicate.run.library import Library
from replicate.run.parallel import run
from replicate.run.storage import to_text
from replicate.run.units import Unit

EXHIBITS = {"table-1": "as-written", "fig-1": "", "claims": ""}
DAMAGES = ("turned", "cut", "put in", "doubled", "zeroed")


class Kept(NamedTuple):
    paper: Paper
    folder: Path
    entries: dict[str, Path]


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Kept]:
    with installed_paper.installed(tmp_path_factory.mktemp("site")):
        paper = Library().paper("lab")
        folder = tmp_path_factory.mktemp("cache")
        run([paper], jobs=1, cache_dir=folder)
        cache = Cache(folder)
        yield Kept(paper, folder, {id: cache._entries(unit(id))[0] for id in EXHIBITS})


def unit(exhibit: str) -> Unit:
    return Unit("lab", "lab_paper", exhibit, EXHIBITS[exhibit])


def damaged(content: bytes, how: str, place: int) -> bytes:
    before, after = content[:place], content[place + 1 :]
    return {
        "turned": before + bytes([content[place] ^ 1 << place % 8]) + after,
        "cut": before + after,
        "put in": before + b"0" + content[place:],
        "doubled": before + content[place : place + 64] + content[place:],
        "zeroed": before + bytes(len(content[place : place + 64])) + content[place + 64 :],
    }[how]


@pytest.mark.parametrize("how", DAMAGES)
def test_damaged_entries_are_not_used(attack: Attack, kept: Kept, how: str) -> None:
    cases = [
        (exhibit, share / 100) for exhibit in EXHIBITS for share in range(100)
    ]  # places in a file, as shares of its length

    def try_one(case: tuple[str, float]) -> str:
        exhibit, share = case
        path = kept.entries[exhibit]
        content = path.read_bytes()
        right, _ = Cache(kept.folder).get(kept.paper, unit(exhibit))
        assert right is not None
        try:
            path.write_bytes(damaged(content, how, int(share * len(content))))
            result, why = Cache(kept.folder).get(kept.paper, unit(exhibit))
        finally:
            path.write_bytes(content)
        if result is not None and to_text(result) != to_text(right):
            return "a wrong result is used"
        return "" if result is not None or why else "nothing is said"

    attack("damaged entries of the cache", cases, try_one, short=12)
