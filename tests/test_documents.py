"""What the project's documents and its Makefile name exists, and what exists is named."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / "replicate"
ARCHITECTURE = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")


def test_every_room_stands_in_the_architecture() -> None:
    rooms = [path.name for path in PACKAGE.iterdir() if path.is_dir() and (path / "__init__.py").is_file()]
    rooms += [path.name for path in PACKAGE.glob("*.py") if path.name not in ("__init__.py", "__main__.py")]
    missing = [name for name in rooms if f"`{name}" not in ARCHITECTURE and f"`{name}/`" not in ARCHITECTURE]
    assert not missing


def test_every_file_that_the_architecture_names_exists() -> None:
    named = re.findall(r"`([\w./-]+/[\w.-]+\.(?:py|toml|md))`", ARCHITECTURE)
    assert len(named) > 15
    assert not [name for name in named if not (PACKAGE / name).is_file() and not (ROOT / name).is_file()]


@pytest.mark.parametrize("document", ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md"])
def test_links_and_make_targets_of_the_documents_exist(document: str) -> None:
    text = (ROOT / document).read_text(encoding="utf-8")
    links = [link for link in re.findall(r"\]\(([^)#]+)[^)]*\)", text) if "://" not in link]
    assert not [link for link in links if not (ROOT / link).exists()]
    named = {target for words in re.findall(r"`make ([a-z ]+)", text) for target in words.split()}
    assert named <= targets()


def test_help_lists_every_target() -> None:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    assert targets() == set(re.findall(r"^([a-z]+):.*## ", makefile, flags=re.MULTILINE))


def targets() -> set[str]:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    return set(re.findall(r"^\.PHONY: ([a-z]+)$", makefile, flags=re.MULTILINE))
