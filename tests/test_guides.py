"""The pages of the documentation: links lead somewhere, the commands they name exist, the tables of words are whole."""

import re
from pathlib import Path

import pytest
import typer
from typer.main import get_command

from replicate.cli import app
from replicate.verdicts.ledger import CAUSES

ROOT = Path(__file__).parent.parent
PAGES = sorted([*(ROOT / "docs").glob("*.md"), ROOT / "README.md", *(ROOT / "examples").glob("*/README.md")])
GUIDES = [ROOT / "docs" / name for name in ("start.md", "tutorial.md")]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_links_lead_to_files(page: Path) -> None:
    for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8")):
        assert (page.parent / target).exists(), target


@pytest.mark.parametrize("page", GUIDES, ids=lambda page: page.stem)
def test_commands_exist(page: Path) -> None:
    command = get_command(app)
    assert isinstance(command, typer.core.TyperGroup)
    blocks = re.findall(r"^```sh\n(.*?)^```", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    named = [name for block in blocks for name in re.findall(r"^replicate (\w+)", block, flags=re.MULTILINE)]
    assert named
    assert set(named) <= set(command.commands)


def test_words_lists_exactly_the_causes() -> None:
    words = (ROOT / "docs" / "words.md").read_text(encoding="utf-8")
    table = words.split("**Ledger and cause.**")[1].split("**Consequence.**")[0]
    assert set(re.findall(r"^\| `([a-z-]+)` \|", table, flags=re.MULTILINE)) == set(CAUSES)
