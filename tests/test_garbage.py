"""Where nothing looks for garbage, and that it is looked for everywhere else."""

from __future__ import annotations

import gc
import subprocess
import sys
import weakref
from collections.abc import Iterator
from pathlib import Path

import pytest
import rogue

from replicate.exhibits.results import TableResult
from replicate.run.garbage import staying
from replicate.run.library import Library
from replicate.run.parallel import run

#: What a worker says of itself: what it looks through, what it does not, and whether it has found a circle.
LOOKS = """
import gc, sys, weakref
class Circle:
    def __init__(self): self.own = self
found = weakref.ref(Circle())
gc.collect()
seen = {id(one) for one in gc.get_objects()}
package = sys.modules["rogue_paper"].__dict__
looked = [gc.isenabled(), found() is None, id(package) in seen, id(np.__dict__) in seen]
return pd.DataFrame([[float(one) for one in looked]], index=["a"], columns=["on", "found", "paper", "library"])
"""


class Circle:
    def __init__(self) -> None:
        self.own = self


@pytest.fixture(autouse=True)
def _looked_through_again() -> Iterator[None]:
    yield
    gc.unfreeze()


def test_what_a_block_makes_stays_also_if_it_fails() -> None:
    made: list[Circle] = []

    def fail() -> None:
        made.append(Circle())
        raise KeyError

    with pytest.raises(KeyError), staying():
        fail()
    assert gc.isenabled()
    assert not any(one is made[0] for one in gc.get_objects())
    after = weakref.ref(Circle())
    gc.collect()
    assert after() is None


def test_who_collects_nothing_is_left_in_peace() -> None:
    gc.disable()
    try:
        with staying():
            assert not gc.isenabled()
        assert not gc.isenabled()
    finally:
        gc.enable()


def test_workers_collect_garbage_but_do_not_look_through_papers_and_libraries(tmp_path: Path) -> None:
    readings = {"looks": LOOKS}
    with rogue.installed(tmp_path, readings):
        results = run([Library().paper("rogue")], jobs=1, cache_dir=None)
    table = results["rogue", "table-1"]
    assert isinstance(table, TableResult)
    assert table.frames["looks"].loc["a"].to_dict() == {"on": 1.0, "found": 1.0, "paper": 0.0, "library": 0.0}


def test_importing_what_workers_start_with_leaves_the_search_for_garbage_on() -> None:
    code = "import gc, replicate.run.preload; print(gc.isenabled(), gc.get_freeze_count() > 0)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "True True\n"
