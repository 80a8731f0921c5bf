"""The pages of the documentation: links lead somewhere, the commands they name exist, the tables of words are whole."""

import doctest
import re
import runpy
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import typer
from typer.main import get_command

from replicate.cli import app
from replicate.handout import handouts
from replicate.new_paper import new_paper
from replicate.run.library import Library
from replicate.run.outcome import recompute
from replicate.verdicts.causes import CAUSES

ROOT = Path(__file__).parent.parent
DOCS = ROOT / "docs"
PAGES = sorted([*(ROOT / "docs").glob("*.md"), ROOT / "README.md", *(ROOT / "examples").glob("*/README.md")])
hooks = runpy.run_path(str(DOCS / "site_hooks.py"))
GUIDES = [ROOT / "docs" / name for name in ("start.md", "tutorial.md", "handouts.md", "class-sets.md")]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_links_lead_to_files(page: Path) -> None:
    for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8")):
        assert (page.parent / target).exists() or (page.parent == DOCS and _is_made(target)), target


def _is_made(target: str) -> bool:
    """Say whether a page or a plot is made when the site is built."""
    drawn = DOCS / "plots" / f"{Path(target).stem}.py"
    return target in {f"api/{name}.md" for name in hooks["API"]} or (target.endswith(".svg") and drawn.is_file())


@pytest.mark.parametrize("page", sorted(DOCS.glob("*.md")), ids=lambda page: page.stem)
def test_snippets_give_what_they_show(page: Path) -> None:
    options = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
    assert doctest.testfile(str(page), module_relative=False, optionflags=options, encoding="utf-8").failed == 0


@pytest.mark.parametrize("script", sorted(DOCS.glob("plots/*.py")), ids=lambda script: script.stem)
def test_plots_are_drawn_and_shown(script: Path) -> None:
    assert runpy.run_path(str(script))["draw"]().axes
    assert [page for page in DOCS.glob("*.md") if f"(plots/{script.stem}.svg)" in page.read_text(encoding="utf-8")]


def test_every_page_stands_in_the_contents() -> None:
    contents = (ROOT / "mkdocs.yml").read_text(encoding="utf-8").partition("\nnav:")[2]
    named = set(re.findall(r"- ([\w/-]+\.md)$", contents, flags=re.MULTILINE))
    made = {*hooks["DOCUMENTS"], *(f"api/{name}.md" for name in hooks["API"])}
    assert named == {page.name for page in DOCS.glob("*.md")} | made


@pytest.mark.parametrize(
    ("link", "page", "becomes"),
    [
        ("[A](../ARCHITECTURE.md)", "start.md", "[A](architecture.md)"),
        ("[S](../examples/student/README.md#x)", "tutorial.md", "[S](examples/student.md#x)"),
        ("[words](docs/words.md)", "contributing.md", "[words](words.md)"),
        ("[L](../replicate/schemas/ledger.schema.json)", "formats.md", "[L](schemas/ledger.schema.json)"),
        ("[file](../Makefile)", "start.md", "file"),
        ("[net](https://example.org)", "start.md", "[net](https://example.org)"),
    ],
)
def test_links_of_the_site(link: str, page: str, becomes: str) -> None:
    source = SimpleNamespace(file=SimpleNamespace(src_uri=page))
    assert hooks["on_page_markdown"](link, source, None, None) == becomes


@pytest.mark.parametrize("page", GUIDES, ids=lambda page: page.stem)
def test_commands_exist(page: Path) -> None:
    command = get_command(app)
    assert isinstance(command, typer.core.TyperGroup)
    blocks = re.findall(r"^```sh\n(.*?)^```", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    named = [name for block in blocks for name in re.findall(r"^replicate (\w+)", block, flags=re.MULTILINE)]
    assert named
    assert set(named) <= set(command.commands)


def _options(command: Any, name: str = "replicate") -> Iterator[tuple[str, str]]:
    """Yield every option of a command and of those below it, with the name of the command."""
    yield from ((name, option) for parameter in command.params for option in parameter.opts if option.startswith("--"))
    for below in getattr(command, "commands", {}).values():
        yield from _options(below, f"{name} {below.name}")


def test_every_option_is_documented() -> None:
    text = "".join(page.read_text(encoding="utf-8") for page in PAGES)
    options = list(_options(get_command(app)))
    assert ("replicate figures accept", "--only") in options
    assert [one for one in options if not re.search(rf"{one[1]}(?![\w-])", text)] == []


def test_the_commands_of_the_first_guide_do_what_it_says(
    replicate: Callable[..., tuple[int, str, str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    text = (DOCS / "start.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```sh\n(.*?)^```", text, flags=re.MULTILINE | re.DOTALL)
    statuses = {}
    for line in "".join(blocks).splitlines():
        program, *arguments = line.split()
        if program == "cd":
            monkeypatch.chdir(arguments[0])
        elif program == "replicate":
            statuses[arguments[0]] = replicate(*arguments)[0]
    # What is left to do in a new paper is open: status 1, as the guide says.
    assert statuses == {"init": 0, "new": 0, "report": 0, "show": 0, "check": 1}
    assert Path("build/report/index.html").is_file()
    named = re.findall(r"^\| `([\w./-]+)`", text, flags=re.MULTILINE)
    assert len(named) > 5
    assert not [name for name in named if not Path("papers/gauss", name).is_file()]


def test_the_handout_of_the_guide_is_built(tmp_path: Path) -> None:
    folder = new_paper("gauss", tmp_path)
    guide = (DOCS / "handouts.md").read_text(encoding="utf-8")
    (text,) = re.findall(r"^````markdown\n(.*?)^````", guide, flags=re.MULTILINE | re.DOTALL)
    (folder / "handout.md").write_text(text, encoding="utf-8")
    papers = Library(folders=[tmp_path]).papers()
    outcome = recompute(papers, jobs=1, cache_dir=None)
    made = handouts(papers, outcome.results, outcome.judgement.verdicts, solutions=[True], file_format="html")
    page = dict(made)["gauss-solutions.html"].decode()
    for words in ("One degree of freedom", "1.9313", "1.931", "1.93"):
        assert words in page


def test_words_lists_exactly_the_causes() -> None:
    words = (ROOT / "docs" / "words.md").read_text(encoding="utf-8")
    table = words.split("**Ledger and cause.**")[1].split("**Consequence.**")[0]
    assert set(re.findall(r"^\| `([a-z-]+)` \|", table, flags=re.MULTILINE)) == set(CAUSES)
