"""Results that are kept: what their key covers, that they are data and nothing else, and that no wrong one is used."""

from __future__ import annotations

import dataclasses
import hashlib
import importlib
import importlib.metadata
import json
import math
import os
import pickle
import subprocess
import sys
import threading
import zipfile
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import installed_paper
import numpy as np
import pandas as pd
import pytest
import synthetic
from hypothesis import given
from hypothesis import strategies as st

import replicate as package
from replicate.exhibits import Finding, Paper
from replicate.exhibits.results import ClaimsResult, FigureResult, TableResult
from replicate.run import storage
from replicate.run.cache import Cache, stored
from replicate.run.costs import Costs, user_folder
from replicate.run.dependencies import Looked
from replicate.run.library import Library
from replicate.run.modules import file_of, installed, modules_of
from replicate.run.parallel import Progress, run
from replicate.run.storage import from_text, to_text
from replicate.run.units import Unit

UNITS = {"lab/table-1 (as-written)", "lab/table-1 (decimal)", "lab/fig-1", "lab/claims"}

#: A paper that needs files around it: siblings that it imports in every way, data, a distribution.
AROUND = {
    "lab_siblings/__init__.py": "",
    "lab_siblings/direct.py": "from lab_siblings import indirect\nVALUE = indirect.VALUE\n",
    "lab_siblings/indirect.py": "VALUE = 1\n",
    "lab_lazy.py": "VALUE = 2\n",
    "lab_dynamic.py": "VALUE = 3\n",
    "lab_unused.py": "VALUE = 4\n",
    "lab_distribution/__init__.py": "VALUE = 5\n",
    "lab_distribution-1.0.dist-info/METADATA": "Metadata-Version: 2.1\nName: lab-distribution\nVersion: 1.0\n",
    "lab_distribution-1.0.dist-info/RECORD": "lab_distribution/__init__.py,,\n",
    "measured/run-1.csv": "1\n",
    "declared/one.dat": "1\n",
    "lab_paper/data/inside.csv": "1\n",
}

USING = """

import importlib
from lab_siblings import direct

more = paper.table("table-2", "Numbers", rows=("a",), columns=("x",), printed=False, depends=["../declared"])


@more.reading("as-written", "As written")
def _more():
    import lab_lazy
    import lab_distribution

    dynamic = importlib.import_module("lab_" + "dynamic")
    total = direct.VALUE + lab_lazy.VALUE + dynamic.VALUE + lab_distribution.VALUE
    total += float(paper.data("../measured/run-1.csv").read_text()) + float(paper.data("data/inside.csv").read_text())
    return pd.DataFrame({"x": [total]}, index=["a"])
"""


@pytest.fixture
def site(tmp_path: Path) -> Iterator[Path]:
    with installed_paper.installed(tmp_path / "site-packages") as folder:
        for name, text in AROUND.items():
            path = folder.parent / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        with (folder / "exhibits.py").open("a", encoding="utf-8") as file:
            file.write(USING)
        yield folder.parent
    for name in [name for name in sys.modules if name.startswith("lab_")]:
        del sys.modules[name]


def fresh() -> Paper:
    """The paper, imported anew as in another run."""
    for name in [name for name in sys.modules if name.startswith("lab_")]:
        del sys.modules[name]
    return Library().paper("lab")


def why(cache: Path, exhibits: list[tuple[str, str]] | None = None) -> dict[str, str]:
    """Run, and return why each unit was computed."""
    steps: list[Progress] = []
    run([fresh()], exhibits, jobs=1, cache_dir=cache, progress=steps.append)
    assert not [step.errors for step in steps if step.errors]
    return {str(step.unit): step.why for step in steps if not step.from_cache}


TABLE_2 = [("lab", "table-2")]
OF_TABLE_2 = "lab/table-2 (as-written)"


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("lab_siblings/direct.py", "module lab_siblings.direct has changed"),
        ("lab_siblings/indirect.py", "module lab_siblings.indirect has changed"),
        ("lab_siblings/__init__.py", "module lab_siblings has changed"),
        ("lab_lazy.py", "module lab_lazy has changed"),
        ("lab_dynamic.py", "module lab_dynamic has changed"),
        ("measured/run-1.csv", "../measured/run-1.csv has changed"),
        ("declared/one.dat", "../declared has changed"),
        ("declared/two.dat", "../declared has changed"),
        ("lab_paper/data/inside.csv", "lab/data/inside.csv has changed"),
        ("lab_paper/new.py", "lab/new.py is new"),
        ("lab_paper/printed/table-1.csv", "lab/printed/table-1.csv has changed"),
        ("lab_unused.py", ""),
        ("lab_paper/notes.md", ""),
    ],
)
def test_whatever_a_result_depends_on_makes_it_stale_and_is_named(
    site: Path, tmp_path: Path, name: str, said: str
) -> None:
    assert why(tmp_path / "cache", TABLE_2) == {OF_TABLE_2: "it has not been computed before"}
    assert why(tmp_path / "cache", TABLE_2) == {}
    with (site / name).open("a", encoding="utf-8") as file:
        file.write("\n")
    assert why(tmp_path / "cache", TABLE_2) == ({OF_TABLE_2: said} if said else {})


def test_what_changes_in_a_module_recomputes_the_exhibits_that_use_it(site: Path, tmp_path: Path) -> None:
    paper = site / "lab_paper"
    (paper / "more.py").write_text(
        "from lab_paper import paper\n\n\n"
        "@paper.figure('fig-3', 'Three')\ndef _three(figure):\n    figure.add_subplot().plot([0, 1])\n"
    )
    face = paper / "__init__.py"
    face.write_text(face.read_text().replace('"exhibits",', '"exhibits", "more",'))
    both = [*TABLE_2, ("lab", "fig-3")]
    assert set(why(tmp_path / "cache", both)) == {OF_TABLE_2, "lab/fig-3"}
    with (paper / "exhibits.py").open("a") as file:
        file.write("\n")
    assert why(tmp_path / "cache", both) == {OF_TABLE_2: "lab/exhibits.py has changed"}
    with (paper / "more.py").open("a") as file:
        file.write("\n")
    changed = "lab/more.py has changed"  # exhibits.py imports by a name that no statement gives
    assert why(tmp_path / "cache", both) == {OF_TABLE_2: changed, "lab/fig-3": changed}


def test_a_module_that_begins_to_change_another_is_used_by_all(site: Path, tmp_path: Path) -> None:
    paper = site / "lab_paper"
    figure = "from lab_paper import paper, state\n\n\n@paper.figure('fig-{0}', '{0}')\ndef _draw(figure):\n"
    (paper / "state.py").write_text("LIMITS = [0, 1]\n\n\ndef limits():\n    return LIMITS\n")
    (paper / "three.py").write_text(figure.format(3) + "    figure.add_subplot().plot(state.LIMITS)\n")
    (paper / "four.py").write_text(figure.format(4) + "    figure.add_subplot().plot([0, 1])\n")
    face = paper / "__init__.py"
    face.write_text(face.read_text().replace('"exhibits",', '"four", "three",'))
    figures = [("lab", "fig-3"), ("lab", "fig-4")]

    def after(name: str, text: str) -> dict[str, str]:
        (paper / name).write_text(text)
        return why(tmp_path / "cache", figures)

    four = (paper / "four.py").read_text()
    assert set(after("four.py", four)) == {"lab/fig-3", "lab/fig-4"}
    changed = "lab/four.py has changed"
    assert after("four.py", four + "\n") == {"lab/fig-4": changed}
    assert after("four.py", four + "state.LIMITS.append(3)\n") == {"lab/fig-3": changed, "lab/fig-4": changed}
    assert after("four.py", four + "\nHERE = tuple(state.limits())\n") == {"lab/fig-4": changed}


def test_another_version_of_a_library_makes_results_stale(site: Path, tmp_path: Path) -> None:
    why(tmp_path / "cache", TABLE_2)
    metadata = site / "lab_distribution-1.0.dist-info" / "METADATA"
    metadata.write_text(metadata.read_text().replace("1.0", "1.1"))
    assert why(tmp_path / "cache", TABLE_2) == {OF_TABLE_2: "lab-distribution was 1.0, is 1.1"}


def test_a_file_that_is_gone_makes_results_stale(site: Path, tmp_path: Path) -> None:
    why(tmp_path / "cache", TABLE_2)
    (site / "lab_paper" / "data" / "extra.csv").write_text("")
    why(tmp_path / "cache", TABLE_2)
    (site / "lab_paper" / "data" / "extra.csv").unlink()
    assert why(tmp_path / "cache", TABLE_2) == {}, "the entry of the earlier state is still there"


def test_a_result_of_a_file_that_is_edited_meanwhile_is_not_kept(site: Path, tmp_path: Path) -> None:
    """What was loaded is the file as it was before; its digest would be that of the file as it is now."""
    edit = f"open({str(site / 'lab_lazy.py')!r}, 'a').write('VALUE = 20\\n')"
    with (site / "lab_paper" / "exhibits.py").open("a", encoding="utf-8") as file:
        file.write(
            "\n\n@more.reading('edits', 'Edits')\ndef _edits():\n    import time, lab_lazy\n"
            f"    time.sleep(0.1)\n    {edit}\n    return pd.DataFrame({{'x': [lab_lazy.VALUE]}}, index=['a'])\n"
        )
    assert "lab/table-2 (edits)" in why(tmp_path / "cache", TABLE_2)
    (site / "lab_lazy.py").write_text("VALUE = 20\n")
    results = run([fresh()], TABLE_2, jobs=1, cache_dir=tmp_path / "cache")
    table = results["lab", "table-2"]
    assert isinstance(table, TableResult)
    assert table.frames["edits"].iloc[0, 0] == 20


def test_the_same_module_elsewhere_is_another_module(
    site: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    why(tmp_path / "cache", TABLE_2)
    shadow = tmp_path / "shadow"
    shadow.mkdir()
    (shadow / "lab_lazy.py").write_text("VALUE = 20\n")
    monkeypatch.syspath_prepend(str(shadow))
    assert site.is_dir()
    assert why(tmp_path / "cache", TABLE_2) == {OF_TABLE_2: "module lab_lazy has changed"}


def test_a_folder_that_moves_keeps_its_results(site: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    why(tmp_path / "cache", TABLE_2)
    moved = tmp_path / "moved"
    site.rename(moved)
    monkeypatch.syspath_prepend(str(moved))
    assert why(tmp_path / "cache", TABLE_2) == {}


@pytest.mark.parametrize("id", ["khan", "krajewski", "bayhan", "ali", "panagopoulos"])
def test_every_file_that_a_bundled_paper_loads_is_in_the_key(id: str) -> None:
    code = (
        "import sys; from replicate.run.library import Library; before = set(sys.modules);"
        f"paper = Library(bundled=True).paper('{id}');"
        "print('\\n'.join(str(sys.modules[name].__file__) for name in set(sys.modules) - before"
        " if getattr(sys.modules[name], '__file__', None)))"
    )
    root = Path(package.__file__).parent
    listed = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    ).stdout.splitlines()
    loaded = {Path(line).relative_to(root).as_posix() for line in listed if line.startswith(str(root))}
    paper = Library(bundled=True).paper(id)
    exhibit = next(iter(paper.exhibits.values()))
    key = Looked().record(paper, exhibit, modules_of(paper.package, [paper.package]))
    own = f"papers/{id}/"
    covered = {*key["framework"], *(f"{own}{name}" for name in key["paper"])}
    # Other papers are imported to be found, not to be used; what a package's face holds is in its own room.
    needed = {name for name in loaded if not name.startswith("papers/") or name.startswith(own)}
    assert len([name for name in needed if name.startswith(own)]) > 3
    assert not needed - covered - {"papers/__init__.py"}
    assert {"numpy", "pandas", "scipy"} <= key["distribution"].keys()


# ------------------------------------------------------------------------------------------------------ storage

numbers = st.one_of(
    st.floats(), st.integers(-(10**300), 10**300), st.none(), st.booleans(), st.text("ab é", max_size=5)
)  # fmt: skip


@given(st.lists(st.lists(numbers, min_size=2, max_size=2), max_size=4))
def test_every_cell_comes_back_as_it_was(cells: list[list[Any]]) -> None:
    rows = [f"r{i}" for i in range(len(cells))]
    frame = pd.DataFrame(cells, index=pd.Index(rows, dtype=object), columns=["a", "b"], dtype=object)
    result = from_text(to_text(TableResult("lab", "t", {"as-written": frame}, {"other": "why"})))
    assert isinstance(result, TableResult)
    back = result.frames["as-written"]
    assert list(back.index) == rows
    assert result.errors == {"other": "why"}
    for line, same in zip(cells, back.to_numpy(dtype=object).tolist(), strict=True):
        for before, after in zip(line, same, strict=True):
            if before is None or before != before:  # noqa: PLR0124  -- NaN
                assert after is None or after != after  # noqa: PLR0124
            else:
                assert after == before


@given(st.lists(st.tuples(st.sampled_from("ab"), st.floats(), st.floats()), max_size=20), st.binary(max_size=50))
def test_a_figure_comes_back_as_it_was(points: list[tuple[str, float, float]], png: bytes) -> None:
    curves = pd.DataFrame(
        {
            "panel": pd.Series(["p" for _ in points], dtype=object),
            "curve": pd.Series([curve for curve, _, _ in points], dtype=object),
            "x": np.array([x for _, x, _ in points], dtype=float),
            "y": np.array([y for _, _, y in points], dtype=float),
        }
    )
    figure = FigureResult("lab", "f", "<svg>\u2028é</svg>", png, curves, [{"xlim": [0.1, 0.2]}], "", {"size": [1, 2]})
    back = from_text(to_text(figure))
    assert isinstance(back, FigureResult)
    pd.testing.assert_frame_equal(back.curves, curves, check_exact=True)
    assert (back.svg, back.png, back.axes, back.figure) == (figure.svg, figure.png, figure.axes, figure.figure)


@pytest.mark.parametrize("kind", [TableResult, FigureResult, ClaimsResult])
def test_every_field_of_a_result_is_kept(kind: type) -> None:
    fields, _ = storage._READERS[kind.__name__]
    assert {"paper", "exhibit", *fields} == {field.name for field in dataclasses.fields(kind)}


@pytest.mark.parametrize("value", [0.1, 5e-324, 1.7976931348623157e308, -0.0, math.inf, 3])
def test_the_value_of_a_claim_comes_back_as_it_was(value: float) -> None:
    result = from_text(to_text(ClaimsResult("lab", "claims", {"a": Finding("holds", value, "So.")})))
    assert isinstance(result, ClaimsResult)
    assert repr(result.findings["a"].value) == repr(value)


# ------------------------------------------------------------------------------------------------- wrong entries


def entries(cache: Path) -> dict[str, Path]:
    return {json.loads(path.read_bytes().splitlines()[0])["unit"]["exhibit"]: path for path in cache.rglob("*.result")}


def rewritten(path: Path, change: Callable[[dict[str, Any]], None], line: int) -> None:
    """Change one of the three lines of an entry as someone would who knows the form: the digest fits again."""
    lines = [json.loads(text) for text in path.read_text(encoding="utf-8").splitlines()]
    change(lines[line])
    rest = "".join(f"{json.dumps(text)}\n" for text in lines[1:])
    if line:
        lines[0]["digest"] = hashlib.sha256(rest.encode()).hexdigest()
    path.write_text(f"{json.dumps(lines[0])}\n{rest}", encoding="utf-8")


FIELDS = {"table-2": ("frames", "errors"), "fig-1": ("svg", "png", "curves", "axes", "figure", "error")}
FIELDS["claims"] = ("findings", "errors")
WRONG: list[tuple[str, str, Any]] = [
    (exhibit, field, wrong) for exhibit, names in FIELDS.items() for field in names for wrong in (None, 7, "x", [1])
]


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Paper, Path]]:
    with installed_paper.installed(tmp_path_factory.mktemp("site")) as folder:
        for name, text in AROUND.items():
            path = folder.parent / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        with (folder / "exhibits.py").open("a", encoding="utf-8") as file:
            file.write(USING)
        paper = fresh()
        cache = tmp_path_factory.mktemp("cache")
        run([paper], jobs=2, cache_dir=cache)
        yield paper, cache


def unit_of(exhibit: str) -> Unit:
    return Unit("lab", "lab_paper", exhibit, "as-written" if exhibit.startswith("table") else "")


def refused(kept: tuple[Paper, Path], exhibit: str, damage: Callable[[Path], object]) -> str:
    """Damage an entry, return why it is not used, and mend it."""
    paper, cache = kept
    path = entries(cache)[exhibit]
    content = path.read_bytes()
    try:
        damage(path)
        result, reason = Cache(cache).get(paper, unit_of(exhibit))
        assert result is None
        return reason
    finally:
        path.write_bytes(content)
        assert Cache(cache).get(paper, unit_of(exhibit))[0] is not None


@pytest.mark.parametrize(("exhibit", "field", "wrong"), WRONG)
def test_a_field_of_another_type_is_recognised(
    kept: tuple[Paper, Path], exhibit: str, field: str, wrong: object
) -> None:
    if field in {"svg", "error"} and isinstance(wrong, str):
        pytest.skip("that is a text")
    reason = refused(kept, exhibit, lambda path: rewritten(path, lambda fields: fields.update({field: wrong}), 2))
    assert reason == "its entry in the cache is damaged"


@pytest.mark.parametrize(("exhibit", "field"), [(id, field) for id, names in FIELDS.items() for field in names])
def test_a_missing_field_is_recognised(kept: tuple[Paper, Path], exhibit: str, field: str) -> None:
    reason = refused(kept, exhibit, lambda path: rewritten(path, lambda fields: fields.pop(field), 2))
    assert reason == "its entry in the cache is damaged"


@pytest.mark.parametrize("field", ["form", "schema", "unit", "digest"])
def test_a_missing_field_of_the_head_is_recognised(kept: tuple[Paper, Path], field: str) -> None:
    assert refused(kept, "claims", lambda path: rewritten(path, lambda head: head.pop(field), 0))


@pytest.mark.parametrize("group", ["python", "framework", "paper", "distribution", "module", "data"])
def test_missing_dependencies_are_recognised(kept: tuple[Paper, Path], group: str) -> None:
    assert refused(kept, "claims", lambda path: rewritten(path, lambda groups: groups.pop(group), 1))
    assert refused(kept, "claims", lambda path: rewritten(path, lambda groups: groups.update({group: {"x": "y"}}), 1))


@pytest.mark.parametrize("exhibit", FIELDS)
@pytest.mark.parametrize("other", FIELDS)
def test_an_entry_in_another_place_is_recognised(kept: tuple[Paper, Path], exhibit: str, other: str) -> None:
    if exhibit == other:
        return
    there = entries(kept[1])[other]
    assert "another unit" in refused(kept, exhibit, lambda path: path.write_bytes(there.read_bytes()))

    def disguised(path: Path) -> None:
        head, rest = there.read_bytes().split(b"\n", 1)
        unit = json.loads(path.read_bytes().splitlines()[0])["unit"]
        path.write_bytes(json.dumps(json.loads(head) | {"unit": unit}).encode() + b"\n" + rest)

    assert "another unit" in refused(kept, exhibit, disguised)


def shorten(path: Path, length: int) -> None:
    path.write_bytes(path.read_bytes()[:length])


def test_every_shorter_entry_is_recognised(kept: tuple[Paper, Path]) -> None:
    size = entries(kept[1])["claims"].stat().st_size
    for length in range(0, size, max(1, size // 40)):
        assert refused(kept, "claims", partial(shorten, length=length))


def test_nothing_in_the_cache_is_run(kept: tuple[Paper, Path], tmp_path: Path) -> None:
    class Bomb:
        def __reduce__(self) -> tuple[Any, ...]:
            return os.mkdir, (str(tmp_path / "exploded"),)

    assert refused(kept, "claims", lambda path: path.write_bytes(pickle.dumps(Bomb())))
    assert not (tmp_path / "exploded").exists()


def test_a_deep_or_huge_text_is_recognised(kept: tuple[Paper, Path]) -> None:
    assert refused(kept, "claims", lambda path: path.write_bytes(b"[" * 10**6))
    assert refused(kept, "claims", lambda path: path.write_bytes(b'{"form": ' + b"9" * 10**5 + b"}"))


@pytest.mark.skipif(sys.platform == "win32", reason="files have no such mode there")
@pytest.mark.parametrize("mode", [0o620, 0o602, 0o666])
def test_an_entry_that_others_can_write_is_not_used(kept: tuple[Paper, Path], mode: int) -> None:
    path = entries(kept[1])["claims"]
    try:
        assert "by others" in refused_once(kept, lambda: path.chmod(mode))
    finally:
        path.chmod(0o600)
    assert Cache(kept[1]).get(kept[0], unit_of("claims"))[0] is not None


@pytest.mark.skipif(sys.platform == "win32", reason="files have no owner there")
def test_an_entry_of_another_user_is_not_used(kept: tuple[Paper, Path], monkeypatch: pytest.MonkeyPatch) -> None:
    other = os.getuid() + 1
    with monkeypatch.context() as patch:
        assert "by others" in refused_once(kept, lambda: patch.setattr(os, "getuid", lambda: other))


def refused_once(kept: tuple[Paper, Path], change: Callable[[], object]) -> str:
    """Change what is around the entry of the claims and return why it is not used."""
    change()
    result, reason = Cache(kept[1]).get(kept[0], unit_of("claims"))
    assert result is None
    return reason


# ---------------------------------------------------------------------------------------------------- the folder


def test_a_folder_that_cannot_be_written_costs_time_only(site: Path, tmp_path: Path) -> None:
    assert site.is_dir()
    (tmp_path / "cache").write_text("a file")
    assert set(why(tmp_path / "cache", TABLE_2)) == {OF_TABLE_2}


def test_clearing_removes_results_and_nothing_else(kept: tuple[Paper, Path], tmp_path: Path) -> None:
    paper, cache = kept
    own = tmp_path / "cache"
    run([paper], TABLE_2, jobs=1, cache_dir=own)
    mine = {"mine.txt", "model.pickle", "fit.result", ".aside-from-mine"}
    for name in mine:
        (own / name).write_text("mine")
    (removed,) = Cache(own).clear()
    assert removed.size > 0
    assert {path.name for path in own.rglob("*")} == mine
    assert len(list(stored(cache))) == len(UNITS) + 1


def test_what_has_not_been_used_for_longest_goes_first(kept: tuple[Paper, Path], tmp_path: Path) -> None:
    paper, _ = kept
    cache = Cache(tmp_path)
    for age, exhibit in enumerate(["claims", "fig-1", "table-1", "table-2"]):
        run([paper], [("lab", exhibit)], jobs=1, cache_dir=tmp_path)
        for path in tmp_path.rglob("*.result"):
            if json.loads(path.read_bytes().splitlines()[0])["unit"]["exhibit"] == exhibit:
                os.utime(path, (1000 + age, 1000 + age))
    assert cache.get(paper, unit_of("claims"))[0] is not None  # used just now
    assert cache.trim(entries(tmp_path)["claims"].stat().st_size) > 0
    assert set(entries(tmp_path)) == {"claims"}


def test_two_runs_share_a_cache(kept: tuple[Paper, Path], tmp_path: Path) -> None:
    paper, _ = kept
    failures: list[BaseException] = []

    def one() -> None:
        try:
            for _ in range(3):
                run([paper], TABLE_2, jobs=1, cache_dir=tmp_path / "cache")
                Cache(tmp_path / "cache").clear()
        except BaseException as error:  # noqa: BLE001  -- a thread's error must not get lost
            failures.append(error)

    threads = [threading.Thread(target=one) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failures
    assert not list(tmp_path.rglob(".aside-*"))


def test_nothing_is_started_when_everything_is_kept(kept: tuple[Paper, Path], monkeypatch: pytest.MonkeyPatch) -> None:
    paper, cache = kept

    def refuse(*_: object) -> None:
        msg = "a pool was started"
        raise AssertionError(msg)

    monkeypatch.setattr("replicate.run.pool.LocalPool.__init__", refuse)
    results = run([paper], jobs=2, cache_dir=cache)
    assert len(results) == 4


# -------------------------------------------------------------------------------------------------- order of work


def test_the_longest_comes_first(tmp_path: Path) -> None:
    units = [Unit("lab", "lab_paper", id) for id in ("short", "long", "unknown", "middle")]
    costs = Costs(tmp_path)
    for unit, seconds in zip(units, (1.0, 9.0, None, 5.0), strict=True):
        if seconds is not None:
            costs.add(unit, seconds)
    costs.save()
    again = Costs(tmp_path).longest_first(units)
    assert [unit.exhibit for unit in again] == ["unknown", "long", "middle", "short"]


@pytest.mark.parametrize("content", ["", "[]", '{"lab/short": "much"}', f'{{"lab/short": {"9" * 400}}}', "\x00"])
def test_a_damaged_file_of_costs_is_no_loss(tmp_path: Path, content: str) -> None:
    (tmp_path / "costs.json").write_text(content)
    units = [Unit("lab", "lab_paper", id) for id in ("a", "b")]
    assert Costs(tmp_path).longest_first(units) == units


@pytest.mark.skipif(sys.platform == "win32", reason="the folder is another there")
def test_a_home_that_depends_on_the_current_folder_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("XDG_CACHE_HOME", "HOME"):
        monkeypatch.setenv(name, "here")
    assert user_folder() is None


def test_a_run_notes_what_units_cost(kept: tuple[Paper, Path], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    run([kept[0]], TABLE_2, jobs=1, cache_dir=None)
    noted = json.loads((tmp_path / "replicate" / "costs.json").read_text())
    assert list(noted) == [OF_TABLE_2]
    assert noted[OF_TABLE_2] > 0


def test_a_module_of_another_paper_counts_where_it_is_imported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A worker serves several papers, and what it has loaded for one of them belongs to no other."""
    files = {
        "first_paper/__init__.py": "import helper_of_all",
        "second_paper/__init__.py": "",
        "second_paper/used.py": "from . import deeper",
        "second_paper/deeper.py": "",
        "second_paper/alone.py": "",
        "helper_of_all.py": "def later():\n    from second_paper import used\n",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    monkeypatch.syspath_prepend(tmp_path)
    names = {name.removesuffix(".py").removesuffix("/__init__").replace("/", ".") for name in files}
    try:
        for name in names:
            importlib.import_module(name)
        found = modules_of("first_paper", ["first_paper", "second_paper"]) & names
    finally:
        for name in names:
            sys.modules.pop(name, None)
    assert found == names - {"second_paper.alone"}


def test_installed_modules_are_those_that_python_finds(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(tmp_path)
    files = {
        "listed-1.dist-info/RECORD": 'alone.py,,\n"listed_one/a,b.py",,\nlisted_two/deep/er.py,,\n../bin/tool.py,,\n',
        "declared-1.dist-info/RECORD": "other.py,,\n",
        "declared-1.dist-info/top_level.txt": "declared\nalone\n",
        "older.egg-info/SOURCES.txt": "older/__init__.py\n",
        "silent-1.dist-info/INSTALLER": "",
    }
    for name in ("listed-1.dist-info", "declared-1.dist-info", "silent-1.dist-info"):
        files[f"{name}/METADATA"] = f"Metadata-Version: 2.1\nName: {name.partition('-')[0]}\nVersion: 1\n"
    files |= {"older.egg-info/PKG-INFO": "Metadata-Version: 1.1\nName: older\nVersion: 1\n", "older/__init__.py": ""}
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    found, expected = installed.__wrapped__(), importlib.metadata.packages_distributions()
    assert {"listed_one", "listed_two", "alone", "declared", "older", "numpy"} <= expected.keys()
    assert {top: found.get(top) for top in expected if top != ".."} == {
        top: names
        for top, names in expected.items()
        if top != ".."  # a program beside the modules
    }
    assert len(found["alone"]) == 2


def test_what_a_module_defines_has_no_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "lab_package").mkdir()
    for name in ("__init__", "module", "unloaded"):
        (tmp_path / "lab_package" / f"{name}.py").write_text("VALUE = 1\n")
    try:
        importlib.import_module("lab_package.module")
        files = [file_of(f"lab_package.{name}") for name in ("module", "module.VALUE", "unloaded", "VALUE")]
    finally:
        for name in ("lab_package", "lab_package.module"):
            sys.modules.pop(name, None)
    assert files == [tmp_path / "lab_package" / "module.py", None, tmp_path / "lab_package" / "unloaded.py", None]


def test_inner_parts_of_installed_packages_count_with_their_package() -> None:
    """Which of several modules called _cyutility a process has depends on what it loaded first."""
    import pandas as pd
    import scipy.linalg

    assert pd.DataFrame().empty
    assert scipy.linalg.norm([0.0]) == 0.0
    assert "_cyutility" not in modules_of("lab_paper", ["lab_paper"])


def test_a_module_in_an_archive_counts_with_the_archive(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    paper, archive = synthetic.paper(tmp_path), tmp_path.with_name(f"{tmp_path.name}.zip")
    monkeypatch.syspath_prepend(str(archive))
    found = []
    for content in ("A = 1", "A = 2"):
        with zipfile.ZipFile(archive, "w") as opened:
            opened.writestr("archived.py", content)
        importlib.invalidate_caches()
        importlib.import_module("archived")
        found.append(Looked().record(paper, paper.exhibits["table-1"], ["archived"])["module"]["archived"])
    monkeypatch.delitem(sys.modules, "archived")
    assert len({*found, "missing"}) == 3
