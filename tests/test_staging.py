"""Writing a folder: all or nothing, and never a file that is not ours. Kills at every step are in tests/torture."""

from __future__ import annotations

import io
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import textwrap
from collections.abc import Callable
from pathlib import Path

import pytest

from replicate.errors import OutputError
from replicate.staging import finish_interrupted, locked_folder, replace_files, staged

Run = Callable[..., tuple[int, str, str]]
posix = pytest.mark.skipif(os.name == "nt", reason="as POSIX has it")


def write(target: Path, files: dict[str, str], part: str = "report", **options: object) -> None:
    with staged(target, part, **options) as fresh:  # type: ignore[arg-type]
        for name, text in files.items():
            (fresh / name).parent.mkdir(parents=True, exist_ok=True)
            (fresh / name).write_text(text)


def seen(folder: Path) -> dict[str, str]:
    files = (path for path in folder.rglob("*") if path.is_file() and ".replicate" not in path.parts)
    return {path.relative_to(folder).as_posix(): path.read_text() for path in files}


def test_a_run_replaces_what_earlier_runs_wrote_and_leaves_everything_else(tmp_path: Path) -> None:
    write(tmp_path, {"tables/gone.csv": "old", "results.csv": "old"})
    write(tmp_path, {"handouts/kept.pdf": "kept"}, "handouts")
    (tmp_path / "tables/mine.csv").write_text("mine")
    write(tmp_path, {"tables/new.csv": "new", "results.csv": "new"})
    assert seen(tmp_path) == {
        "tables/new.csv": "new",
        "tables/mine.csv": "mine",
        "results.csv": "new",
        "handouts/kept.pdf": "kept",
    }
    write(tmp_path, {"charts/a.svg": "a"}, "charts", renews=lambda _: False)
    write(tmp_path, {"charts/b.svg": "b"}, "charts", renews=lambda _: False)
    write(tmp_path, {"results.csv": "newer"})
    assert set(seen(tmp_path)) == {
        "tables/mine.csv",
        "results.csv",
        "handouts/kept.pdf",
        "charts/a.svg",
        "charts/b.svg",
    }


@pytest.mark.parametrize("name", ["results.csv", "report/index.html"])
def test_a_file_that_is_not_ours_is_named_and_nothing_is_written(tmp_path: Path, name: str) -> None:
    (tmp_path / name).parent.mkdir(exist_ok=True)
    (tmp_path / name).write_text("mine")
    reached = []

    def run(**options: object) -> None:
        with staged(tmp_path, **options) as fresh:  # type: ignore[arg-type]
            reached.append(True)
            (fresh / name).parent.mkdir(exist_ok=True)
            (fresh / name).write_text("ours")
            (fresh / "another").write_text("ours")

    with pytest.raises(OutputError, match=f"{name}: is in the way.*nothing was written"):
        run()
    assert reached == [True]
    with pytest.raises(OutputError, match=f"{name}: is in the way"):
        run(expects=[name])  # known before: then the long computation does not even begin
    assert reached == [True]
    assert seen(tmp_path) == {name: "mine"}
    assert not (tmp_path / ".replicate").exists()


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda place: place.mkdir(), "a folder"),
        (lambda place: place.symlink_to("elsewhere"), "a symbolic link to nothing"),
        (lambda place: place.symlink_to(place.parent), "a symbolic link and"),
        pytest.param(os.mkfifo, "a pipe or device", marks=posix),
    ],
)
def test_neither_is_a_folder_or_a_link_replaced(tmp_path: Path, make: Callable[[Path], None], said: str) -> None:
    make(tmp_path / "results.csv")
    with pytest.raises(OutputError, match=said):
        write(tmp_path, {"results.csv": "new"})
    (tmp_path / "report").write_text("mine")
    with pytest.raises(OutputError, match="report is in the way, which is a file"):
        write(tmp_path, {"report/index.html": "new"})
    assert seen(tmp_path) == {"report": "mine"}


def test_a_folder_that_is_a_link_to_nothing_is_named(tmp_path: Path) -> None:
    (tmp_path / "report").symlink_to("elsewhere")
    with pytest.raises(OutputError, match="report is in the way, which is a symbolic link to nothing"):
        write(tmp_path, {"report/index.html": "new"})
    with pytest.raises(OutputError, match="/report: cannot be written: it is a link that leads nowhere"):
        replace_files(tmp_path, {"report/index.html": b"new"})
    assert [path.name for path in tmp_path.iterdir()] == ["report"]
    with pytest.raises(OutputError, match="report/lab: cannot be written: File exists"):
        replace_files(tmp_path / "report" / "lab", {"a": b"new"})


def test_a_file_of_ours_that_was_changed_belongs_to_who_changed_it(tmp_path: Path) -> None:
    write(tmp_path, {"a.html": "ours", "b.html": "ours"})
    (tmp_path / "a.html").write_text("edited")
    for files in ({"a.html": "new"}, {"b.html": "new"}):  # replaced or removed, both would lose it
        with pytest.raises(OutputError, match=r"a\.html: was changed after the run that wrote it"):
            write(tmp_path, files)
    assert seen(tmp_path) == {"a.html": "edited", "b.html": "ours"}
    (tmp_path / "a.html").unlink()
    write(tmp_path, {"a.html": "new"})
    assert seen(tmp_path) == {"a.html": "new"}


def test_what_is_in_place_already_is_in_nobodys_way(tmp_path: Path) -> None:
    (tmp_path / "results.csv").write_text("same")
    write(tmp_path, {"results.csv": "same"})
    write(tmp_path, {"results.csv": "new"})
    assert seen(tmp_path) == {"results.csv": "new"}


def test_unchanged_files_are_not_touched(tmp_path: Path) -> None:
    write(tmp_path, {"a": "same", "b": "old"})
    before = (tmp_path / "a").stat()
    write(tmp_path, {"a": "same", "b": "new"})
    assert (tmp_path / "a").stat().st_mtime_ns == before.st_mtime_ns
    assert (tmp_path / "a").stat().st_ino == before.st_ino


@posix
def test_a_folder_behind_a_link_stays_behind_it(tmp_path: Path) -> None:
    for name in ("build", "site"):
        (tmp_path / name).mkdir()
    (tmp_path / "build/report").symlink_to(Path("..") / "site")
    write(tmp_path / "build", {"report/index.html": "old", "report/gone.html": "old"})
    write(tmp_path / "build", {"report/index.html": "new"})
    assert (tmp_path / "build/report").readlink() == Path("..") / "site"
    assert seen(tmp_path / "site") == {"index.html": "new"}


@posix
def test_a_folder_behind_a_link_to_another_disk(tmp_path: Path) -> None:
    memory = Path("/dev/shm")  # noqa: S108  -- another disk; a folder of its own is made there
    if not os.access(memory, os.W_OK) or memory.stat().st_dev == tmp_path.stat().st_dev:
        pytest.skip("needs a second file system")
    elsewhere = Path(tempfile.mkdtemp(prefix="replicate-test-", dir=memory))
    try:
        (tmp_path / "report").symlink_to(elsewhere)
        write(tmp_path, {"report/index.html": "old"})
        write(tmp_path, {"report/index.html": "new"})
        assert seen(elsewhere) == {"index.html": "new"}
    finally:
        for path in elsewhere.iterdir():
            path.unlink()
        elsewhere.rmdir()


def test_an_interrupted_run_leaves_the_earlier_state(tmp_path: Path) -> None:
    write(tmp_path, {"results.csv": "old"})

    def interrupted() -> None:
        with staged(tmp_path) as fresh:
            (fresh / "results.csv").write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert seen(tmp_path) == {"results.csv": "old"}
    assert [path.name for path in (tmp_path / ".replicate").iterdir()] == ["manifest.json"]


@pytest.mark.parametrize("failing", range(6))
def test_a_step_that_fails_puts_everything_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, failing: int) -> None:
    earlier = {"a": "old", "b/c": "old", "gone": "old"}
    write(tmp_path, earlier)
    manifest = (tmp_path / ".replicate/manifest.json").read_bytes()
    count = 0

    def full(original: Callable[..., Path]) -> Callable[..., Path]:
        def step(self: Path, *arguments: object, **options: object) -> Path:
            nonlocal count
            after = (tmp_path / ".replicate/journal.json").exists()
            count += after
            if after and count == failing + 1:
                raise OSError(28, "No space left on device", str(self))
            return original(self, *arguments, **options)

        return step

    for name in ("replace", "unlink", "mkdir"):
        monkeypatch.setattr(Path, name, full(getattr(Path, name)))
    with pytest.raises(OutputError, match="cannot be written: No space left on device"):
        write(tmp_path, {"a": "new", "b/c": "new", "d/e/f": "new"})
    assert count > failing
    assert seen(tmp_path) == earlier
    assert (tmp_path / ".replicate/manifest.json").read_bytes() == manifest
    assert not (tmp_path / "d").exists()


def test_a_place_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match=r"file.*cannot be written: "), staged(tmp_path / "file" / "build"):
        pass


@pytest.mark.parametrize(
    "text", ["", "[]", "[" * 10**5, "{}", '{"format": 1, "parts": {"report": {"../x": "0"}}}', '{"format": 99}']
)
def test_a_damaged_manifest_is_named(tmp_path: Path, text: str) -> None:
    write(tmp_path, {"a": "old"})
    (tmp_path / ".replicate/manifest.json").write_text(text)
    with pytest.raises(OutputError, match=r"manifest\.json: is not a list of files"):
        write(tmp_path, {"a": "new"})
    assert seen(tmp_path) == {"a": "old"}


def test_a_journal_cannot_lead_out_of_the_folder(tmp_path: Path) -> None:
    room = tmp_path / "build/.replicate"
    (room / "old").mkdir(parents=True)
    (tmp_path / "mine").write_text("mine")
    (room / "journal.json").write_text('{"put": [], "remove": ["../mine"], "kept": [], "undo": false}')
    with pytest.raises(OutputError, match=r"journal\.json: is not a journal"):
        finish_interrupted(tmp_path / "build")
    assert (tmp_path / "mine").read_text() == "mine"


def test_a_journal_with_a_name_that_no_file_can_have_is_one_line(tmp_path: Path) -> None:
    room = tmp_path / "build/.replicate"
    room.mkdir(parents=True)
    (room / "journal.json").write_text(json.dumps({"put": [], "remove": ["x" * 300], "kept": [], "undo": False}))
    with pytest.raises(OutputError, match=r"x: cannot be written: "):
        finish_interrupted(tmp_path / "build")


@posix
def test_umask_decides_who_may_read(tmp_path: Path) -> None:
    earlier = os.umask(0o002)
    try:
        write(tmp_path / "build", {"report/index.html": "text"})
        replace_files(tmp_path / "accepted", {"lab/a.csv": b"text"})
    finally:
        os.umask(earlier)
    for name in ("build/report", "accepted/lab"):
        assert (tmp_path / name).stat().st_mode & 0o777 == 0o775
    for name in ("build/report/index.html", "accepted/lab/a.csv"):
        assert (tmp_path / name).stat().st_mode & 0o777 == 0o664


HOLDER = """
    import sys
    from pathlib import Path
    from replicate.staging import staged
    with staged(Path(sys.argv[1])) as fresh:
        (fresh / "first").write_text("first")
        print("holding", flush=True)
        sys.stdin.read()
"""


def hold(folder: Path) -> subprocess.Popen[str]:
    """Start a run that goes on until its standard input is closed."""
    command = [sys.executable, "-c", textwrap.dedent(HOLDER), str(folder)]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    assert process.stdout.readline() == "holding\n"
    return process


def test_the_second_run_waits_and_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Heard(io.StringIO):
        def write(self, text: str) -> int:
            assert first.stdin is not None
            first.stdin.close()
            return super().write(text)

    heard = Heard()
    monkeypatch.setattr(sys, "stderr", heard)
    with hold(tmp_path) as first:
        write(tmp_path, {"second": "second"}, "diff")
    assert first.returncode == 0
    assert heard.getvalue() == (
        f"{tmp_path}: another run is under way there (process {first.pid}); waiting for it to end\n"
    )
    assert seen(tmp_path) == {"first": "first", "second": "second"}


@posix
def test_a_killed_run_holds_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with hold(tmp_path) as first:
        first.send_signal(signal.SIGKILL)
    write(tmp_path, {"second": "second"})
    assert capsys.readouterr().err == f"{tmp_path}: removed what a run that was interrupted had begun\n"
    assert seen(tmp_path) == {"second": "second"}


def test_one_process_does_not_write_twice_at_once(tmp_path: Path) -> None:
    with staged(tmp_path), pytest.raises(OutputError, match="is writing to it already"), staged(tmp_path):
        pass


# --------------------------------------------------------------------------------------------- the commands


def test_a_report_beside_a_thesis(replicate: Run) -> None:
    own = {"figures/lab/photo.png": "mine", "report/main.tex": "thesis", "tables/data.csv": "1,2\n", "notes.md": "mine"}
    for name, text in own.items():
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        Path(name).write_text(text)
    for _ in range(2):
        assert replicate("report", "lab", "-j1", "--out", ".")[0] == 0
        assert {name: Path(name).read_text() for name in own} == own
    Path("figures/lab/fig-1.svg").write_text("mine")
    status, out, err = replicate("report", "lab", "-j1", "--out", ".")
    assert (status, out) == (2, "")
    assert err.startswith("replicate: figures/lab/fig-1.svg: was changed after the run that wrote it")
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    "name",
    ["figures/lab/fig-1.svg", "figures/lab/fig-1.png", "figures/lab/fig-1.csv", "tables/lab/table-1.as-written.csv"],
)
def test_a_report_over_files_of_others_is_refused_before_anything_is_computed(replicate: Run, name: str) -> None:
    Path(name).parent.mkdir(parents=True)
    Path(name).write_text("accepted long ago")
    status, out, err = replicate("report", "lab", "-j1", "--out", ".")
    assert (status, out) == (2, "")
    assert err.startswith(f"replicate: {name}: is in the way, and no earlier run wrote it; move it away, or choose")
    assert "delete" not in err  # least of all the present folder
    assert err.count("\n") == 1
    assert [path.name for path in Path().iterdir()] == [name.partition("/")[0]]


def test_only_what_looks_like_a_report_may_be_deleted(replicate: Run) -> None:
    Path("build/report").mkdir(parents=True)
    Path("build/results.csv").write_text("an older version's")
    status, _, err = replicate("report", "lab", "-j1")
    assert status == 2
    assert "if an older version left it, delete build (make clean)" in err
    Path("build/thesis.tex").write_text("mine")
    assert "delete" not in replicate("report", "lab", "-j1")[2]


@pytest.mark.parametrize("name", ["lab/photo.png", "raw/data.csv", "raw/setup.json"])
def test_accepting_removes_no_file_of_somebody_else(replicate: Run, name: str) -> None:
    accept = ("accept", "lab", "-j1", "--reason", "first", "--accepted", "accepted")
    assert replicate(*accept)[0] == 0
    mine = Path("accepted", name)
    mine.parent.mkdir(exist_ok=True)
    mine.write_text("mine\n")
    status, _, err = replicate(*accept)
    assert status == 2
    assert f"{name}: is not of an accepted state, so it is not removed" in err
    assert mine.read_text() == "mine\n"


def test_accepting_in_a_folder_of_others_is_refused(replicate: Run) -> None:
    Path("lab").mkdir()
    Path("lab/table-1.csv").write_text("mine\n")
    status, _, err = replicate("accept", "lab", "-j1", "--reason", "first", "--accepted", ".")
    assert status == 2
    assert "lab/table-1.csv: is in the way" in err
    Path("lab/table-1.csv").unlink()
    Path("CHANGES.md").write_text("# Changes\n")
    status, _, err = replicate("accept", "lab", "-j1", "--reason", "first", "--accepted", ".")
    assert status == 2
    assert "CHANGES.md: is not a log of accepted changes" in err
    assert Path("CHANGES.md").read_text() == "# Changes\n"
    assert not list(Path("lab").iterdir())


def test_a_report_on_one_paper_leaves_the_pages_of_the_others(replicate: Run, folder: Path) -> None:
    """Two small papers in a folder; the second run is about one of them."""
    for id in ("one", "two"):
        shutil.copytree(folder, Path("papers") / id)
        init = Path("papers") / id / "__init__.py"
        init.write_text(init.read_text().replace('id="lab"', f'id="{id}"').replace("A laboratory", f"Laboratory {id}"))
        exhibits = init.with_name("exhibits.py")
        exhibits.write_text(exhibits.read_text().replace("from lab_paper import paper", f"from {id} import paper"))
    assert replicate("report", "--papers", "papers", "-j1")[0] == 0
    everything = seen_bytes(Path("build"))
    notes = Path("papers/one/notes.md")
    notes.write_text(notes.read_text() + "\nA new sentence.\n")
    status, out, _ = replicate("report", "one", "--papers", "papers", "-j1")
    assert status == 0
    assert "two" not in out
    after = seen_bytes(Path("build"))
    assert after.keys() == everything.keys()
    assert [name for name in after if after[name] != everything[name]] == ["report/one.html"]
    index = Path("build/report/index.html").read_text(encoding="utf-8")
    assert "Laboratory one" in index
    assert "Laboratory two" in index


def seen_bytes(folder: Path) -> dict[str, bytes]:
    hidden = {"cache", ".replicate"}
    files = (path for path in sorted(folder.rglob("*")) if path.is_file() and not hidden & {*path.parts})
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


def test_a_folder_that_nobody_can_make_is_named_and_not_waited_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(path: Path, *_: object, **__: object) -> None:
        raise FileNotFoundError(2, "No such file or directory", str(path))

    monkeypatch.setattr(Path, "mkdir", refuse)
    with pytest.raises(OutputError, match="cannot be written: No such file or directory"), staged(tmp_path / "out"):
        pass


@posix
def test_what_lies_behind_a_link_of_the_hidden_folder_s_name_is_not_thrown_away(tmp_path: Path) -> None:
    mine, out = tmp_path / "mine", tmp_path / "out"
    (mine / "new").mkdir(parents=True)
    (mine / "new/thesis.tex").write_text("mine")
    out.mkdir()
    (out / ".replicate").symlink_to(mine)
    with pytest.raises(OutputError, match="is a symbolic link, which no run made; remove it"):
        write(out, {"results.csv": "new"})
    with pytest.raises(OutputError, match="is a symbolic link"), locked_folder(out):
        pass
    assert (mine / "new/thesis.tex").read_text() == "mine"
    assert list(out.iterdir()) == [out / ".replicate"]
