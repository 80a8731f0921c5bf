"""Imports run one way, as ARCHITECTURE.md draws them."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

import replicate

ROOT = Path(replicate.__file__).parent

#: What a room may import, besides itself and the errors.
ALLOWED = {
    "loops": set(),
    "exhibits": {"errors", "plain_text"},
    "figures": {"errors"},
    "baselines": {"display", "errors", "figures", "resources", "staging"},
    "teaching": {"errors", "exhibits", "loops"},
    "papers": {"errors", "exhibits", "figures", "loops", "teaching"},
    "verdicts": {"errors", "exhibits", "plain_text"},
    "run": {"errors", "exhibits", "figures", "languages", "plain_text", "verdicts"},
    "display": {"errors", "exhibits", "figures", "plain_text", "resources", "run", "verdicts"},
    "report": {"display", "errors", "exhibits", "figures", "plain_text", "resources", "run", "staging", "verdicts"},
    "handout": {"display", "errors", "exhibits", "figures", "languages", "plain_text", "resources", "run", "verdicts"},
    "sweeps": {"errors", "loops", "plain_text", "run", "staging"},
    "whatif": {"display", "errors", "exhibits", "figures", "loops", "resources"},
    "diff": {"display", "errors", "exhibits", "figures", "plain_text", "resources", "run", "staging", "verdicts"},
}

#: Rooms of the core in their order: each imports only rooms before it, and what lies beside them.
CORE = (
    "numerics",
    "plants",
    "frequency_domain",
    "time_domain",
    "closed_loop_poles",
    "saturation",
    "prediction",
    "design",
    "bounds",
    "notation",
    "tune",
    "sweep",
    "conformance",
)

#: Holds no paper itself: discovery walks it.
NAMESPACE = "replicate.papers"


def modules() -> dict[str, Path]:
    found = {}
    for path in sorted(ROOT.rglob("*.py")):
        parts = ("replicate", *path.relative_to(ROOT).with_suffix("").parts)
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


MODULES = modules()


@cache
def imports(path: Path, *, at_run_time: bool = False) -> tuple[str, ...]:
    """Return every module of ours that a file imports, wherever in the file it does."""
    return tuple(imported(path, at_run_time=at_run_time))


def imported(path: Path, *, at_run_time: bool) -> Iterator[str]:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in walk(tree, skip_types=at_run_time):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name.split(".")[0] == "replicate")
        elif isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "replicate":
            assert node.module is not None
            for alias in node.names:
                full = f"{node.module}.{alias.name}"
                yield full if full in MODULES else node.module


def walk(node: ast.AST, *, skip_types: bool) -> Iterator[ast.AST]:
    """Walk a tree; on request without what only type checkers see and what is imported inside functions."""
    yield node
    for child in ast.iter_child_nodes(node):
        types_only = isinstance(child, ast.If) and "TYPE_CHECKING" in ast.dump(child.test)
        if not (skip_types and (types_only or isinstance(child, ast.FunctionDef))):
            yield from walk(child, skip_types=skip_types)


def room(module: str) -> str:
    return module.split(".")[1] if "." in module else ""


@pytest.mark.parametrize("name", ALLOWED)
def test_a_room_imports_only_what_lies_below_it(name: str) -> None:
    wrong = [
        f"{module} imports {other}"
        for module, path in MODULES.items()
        if room(module) == name
        for other in imports(path)
        if room(other) not in ALLOWED[name] | {name, ""} and other != NAMESPACE
    ]
    assert not wrong


def core_room(module: str) -> str:
    return next((part for part in module.split(".")[2:3] if room(module) == "loops" and part in CORE), "")


@pytest.mark.parametrize("name", CORE)
def test_a_room_of_the_core_imports_only_what_lies_before_it(name: str) -> None:
    allowed = {*CORE[: CORE.index(name) + 1], ""}
    wrong = [
        f"{module} imports {other}"
        for module, path in MODULES.items()
        if core_room(module) == name
        for other in imports(path)
        if core_room(other) not in allowed
    ]
    assert any(core_room(module) == name for module in MODULES)
    assert not wrong


def test_no_paper_is_imported_by_the_framework_nor_by_another_paper() -> None:
    wrong = [
        f"{module} imports {other}"
        for module, path in MODULES.items()
        for other in imports(path)
        if other.startswith("replicate.papers.") and other.split(".")[2:3] != module.split(".")[2:3]
    ]
    assert not wrong


def test_no_module_imports_itself_through_others() -> None:
    try:
        graph = {name: set(imports(path, at_run_time=True)) & MODULES.keys() for name, path in MODULES.items()}
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        pytest.fail(" -> ".join(error.args[1]))


def test_no_room_imports_itself_through_others() -> None:
    rooms = {room(name): set[str]() for name in MODULES}
    for name, path in MODULES.items():
        rooms[room(name)] |= {room(other) for other in imports(path)} - {room(name), ""}
    TopologicalSorter(rooms).prepare()


def test_the_top_level_is_short() -> None:
    assert len(list(ROOT.glob("*.py"))) <= 9


def test_every_file_can_be_read_at_a_sitting() -> None:
    lines = {name: len(path.read_text(encoding="utf-8").splitlines()) for name, path in MODULES.items()}
    assert not {name: count for name, count in lines.items() if count > 350}
    assert sorted(lines.values())[len(lines) // 2] <= 110
