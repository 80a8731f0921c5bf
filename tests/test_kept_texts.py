"""Texts that are kept between runs: made once, made again when their code or their entry has changed, and named."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from conftest import Run

from replicate.display import markdown, pandoc
from replicate.run.cache import Cache, stored
from replicate.run.kept_texts import KeptTexts
from replicate.whatif import DISTRIBUTIONS, ROOMS, Row, whatif_page

ROWS = [Row("one", "e^{-s}/(s+1)", "k=0.6,ki=0.5")]


class Said:
    """Counts what is made and remembers why."""

    def __init__(self) -> None:
        self.why: list[tuple[str, str]] = []

    def __call__(self, name: str, why: str) -> None:
        self.why.append((name, why))


def _never() -> str:
    msg = "it is there"
    raise AssertionError(msg)


def _kept(folder: Path | None, said: Callable[[str, str], object]) -> KeptTexts:
    return KeptTexts(folder, ("errors", "resources"), ("numpy",), said)


def _entry(folder: Path) -> Path:
    (entry,) = stored(folder)
    return entry.path


def test_a_text_is_made_once(tmp_path: Path) -> None:
    said = Said()
    assert _kept(tmp_path, said)("two\nlines", lambda: "a\nb \u2212 c") == "a\nb \u2212 c"
    assert _kept(tmp_path, said)("two\nlines", _never) == "a\nb \u2212 c"
    assert said.why == [("two\nlines", "it has not been computed before")]


def test_another_name_is_another_text(tmp_path: Path) -> None:
    kept = _kept(tmp_path, Said())
    assert [kept("one", lambda: "1"), kept("two", lambda: "2"), kept("one", _never)] == ["1", "2", "1"]


def test_without_a_folder_nothing_is_kept() -> None:
    said = Said()
    kept = _kept(None, said)
    assert [kept("one", lambda: "1"), kept("one", lambda: "2")] == ["1", "2"]
    assert said.why == [("one", "nothing is kept")] * 2


@pytest.mark.parametrize(
    ("group", "name", "why"),
    [
        ("framework", "errors", "replicate/errors has changed"),
        ("distribution", "numpy", "numpy was other, is "),
        ("python", "version", "Python was 'other', is '"),
    ],
)
def test_what_a_text_depends_on_makes_it_stale_and_is_named(tmp_path: Path, group: str, name: str, why: str) -> None:
    kept = _kept(tmp_path, Said())
    kept("one", lambda: "1")
    path = _entry(tmp_path)
    head, recorded, text = path.read_text().splitlines()
    state = json.loads(recorded)
    assert name in state[group]
    state[group][name] = "other"
    _write(path, json.loads(head), [json.dumps(state), text])
    said = Said()
    assert _kept(tmp_path, said)("one", lambda: "2") == "2"
    assert said.why[0][1].startswith(why)
    assert _kept(tmp_path, said)("one", _never) == "2"


def _write(path: Path, head: dict[str, str], rest: list[str]) -> None:
    import hashlib

    body = "".join(f"{line}\n" for line in rest).encode()
    head["digest"] = hashlib.sha256(body).hexdigest()
    path.write_bytes(f"{json.dumps(head)}\n".encode() + body)


def test_every_damaged_entry_is_made_again(tmp_path: Path) -> None:
    kept = _kept(tmp_path, Said())
    kept("one", lambda: "1")
    path = _entry(tmp_path)
    whole = path.read_bytes()
    head, recorded, text = whole.decode().splitlines()
    for content in (
        *(whole[:length] for length in range(0, len(whole), 7)),
        whole.replace(b'"1"', b'"2"'),
        b"\xff\n\n",
    ):
        path.write_bytes(content)
        assert _kept(tmp_path, Said())("one", lambda: "1 again") == "1 again"
    for rest in ([recorded], [recorded, text, text], ["[]", text], [recorded, "1"], ["{", text], [recorded, "{}"]):
        _write(path, json.loads(head), rest)
        assert _kept(tmp_path, Said())("one", lambda: "1 again") == "1 again"


def test_a_folder_that_cannot_be_written_costs_time_only(tmp_path: Path) -> None:
    (tmp_path / "texts").write_text("a file")
    kept = _kept(tmp_path, Said())
    assert [kept("one", lambda: "1"), kept("one", lambda: "2")] == ["1", "2"]


def test_kept_texts_count_and_go_with_the_results(tmp_path: Path) -> None:
    _kept(tmp_path, Said())("one", lambda: "1")
    (tmp_path / "notes.txt").touch()
    assert [entry.path.parent.name for entry in Cache(tmp_path).clear()] == ["texts"]
    assert [path.name for path in tmp_path.iterdir()] == ["notes.txt"]


# --------------------------------------------------------------------------------------------- the what-if page


def test_the_page_is_the_same_from_kept_texts(tmp_path: Path) -> None:
    first, again = Said(), Said()
    page = whatif_page(ROWS, keep=KeptTexts(tmp_path, ROOMS, DISTRIBUTIONS, first))
    assert whatif_page(ROWS, keep=KeptTexts(tmp_path, ROOMS, DISTRIBUTIONS, again)) == page == whatif_page(ROWS)
    assert len(first.why) == 3
    assert again.why == []


def test_another_plant_is_the_only_one_that_is_computed(tmp_path: Path) -> None:
    whatif_page(ROWS, keep=KeptTexts(tmp_path, ROOMS, DISTRIBUTIONS))
    said = Said()
    more = [*ROWS, Row("two", "e^{-s}/(2s+1)", "k=0.6,ki=0.5")]
    whatif_page(more, keep=KeptTexts(tmp_path, ROOMS, DISTRIBUTIONS, said))
    assert [name for name, _ in said.why] == ["what if: optimal controllers for e^{-s}/(2s+1)"]


def test_the_page_names_all_rooms_whose_code_it_loads() -> None:
    code = (
        "import sys\nfrom replicate.whatif import whatif_page, Row\n"
        "whatif_page([Row('one', 'e^{-s}/(s+1)', 'k=0.6,ki=0.5')])\n"
        "print(*{name.split('.')[1] for name in sys.modules if name.startswith('replicate.')})"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    # what renders the page around the kept texts need not be named
    assert set(run.stdout.split()) - {"verdicts", "run"} <= set(ROOMS)


# --------------------------------------------------------------------------------------- the texts of a report's pages


@pytest.fixture
def converted(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Note every text that pandoc converts."""
    noted: list[str] = []

    def convert(text: str, *options: str) -> str:
        noted.append(text)
        return original(text, *options)

    original = pandoc.convert
    monkeypatch.setattr(markdown, "convert", convert)
    return noted


def _pages() -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in Path("build", "report").glob("*.html")}


def test_only_the_page_whose_text_changes_is_converted_again(
    replicate: Run, folder: Path, converted: list[str]
) -> None:
    command = ("report", "--papers", str(folder.parent), "-v")
    notes = folder / "notes.md"
    notes.write_text("It was *cold*.\n")
    replicate(*command)
    first = _pages()
    Path("build", "cache", "report.json").unlink()
    converted.clear()
    replicate(*command)
    assert (converted, _pages()) == ([], first)
    notes.write_text("It was *warm*.\n")
    _, _, said = replicate(*command)
    assert all("warm" in text for text in converted)
    assert "computed texts of lab.html\n    because its source has changed" in said
    changed = _pages()
    assert b"<em>warm</em>" in changed["lab.html"]
    shutil.rmtree("build")
    replicate(*command)
    assert _pages() == changed


def test_what_is_kept_is_made_safe_each_time(tmp_path: Path) -> None:
    def page() -> str:
        batch = markdown.MarkdownBatch("page", KeptTexts(tmp_path, markdown.ROOMS, markdown.DISTRIBUTIONS))
        return batch.substitute(str(batch.inline("*one*")))

    assert page() == "<em>one</em>"
    path = _entry(tmp_path)
    head, recorded, text = path.read_text().splitlines()
    forged = json.dumps(json.loads(text).replace("one", "one<script>steal()</script>"))
    _write(path, json.loads(head), [recorded, forged])
    assert page() == "<em>one</em>"
