"""Which papers a command means, inside a project and outside."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from replicate.errors import PaperDefinitionError, ProjectError, UnknownPaperError
from replicate.new_paper import new_paper
from replicate.new_project import new_project
from replicate.resources import templates_dir
from replicate.run.library import Library
from replicate.run.project import find_project

Run = Callable[..., tuple[int, str, str]]

BUNDLED = ["ali", "bayhan", "khan", "krajewski", "panagopoulos"]


def made(folder: Path, *papers: str) -> Path:
    new_project(folder)
    for paper in papers:
        new_paper(paper, folder / "papers")
    return folder


def ids(library: Library) -> list[str]:
    return [paper.id for paper in library.papers()]


def test_a_project_is_found_from_below(tmp_path: Path) -> None:
    root = made(tmp_path / "mine", "gauss")
    project = find_project(root / "papers" / "gauss")
    assert project is not None
    assert project.root == root.resolve()
    assert project.title == "Mine"
    assert ids(Library(project)) == ["gauss"]
    assert find_project(tmp_path) is None


def test_a_project_in_pyproject(tmp_path: Path) -> None:
    new_paper("gauss", tmp_path / "replications")
    (tmp_path / "pyproject.toml").write_text('[tool.replicate]\npapers = ["replications"]\naccepted = "state"\n')
    project = find_project(tmp_path)
    assert project is not None
    assert project.accepted == tmp_path.resolve() / "state"
    assert ids(Library(project)) == ["gauss"]


def test_bundled_papers_are_meant_on_request_only(tmp_path: Path) -> None:
    project = find_project(made(tmp_path, "gauss"))
    assert ids(Library(project, bundled=True)) == BUNDLED
    assert Library(project).paper("khan").id == "khan"  # a paper that is named is found everywhere
    assert not Library(project).is_bundled("gauss")
    assert Library(project).is_bundled("khan")


def test_outside_a_project_a_bare_command_says_what_to_do() -> None:
    with pytest.raises(ProjectError, match=r"no project here; 'replicate init FOLDER' .* --bundled"):
        Library().papers()


def test_the_checkout_is_a_project_with_the_bundled_papers() -> None:
    project = find_project(Path(__file__).parent)
    assert project is not None
    assert ids(Library(project)) == BUNDLED


def test_folders_of_papers(tmp_path: Path) -> None:
    new_paper("gauss", tmp_path)
    new_paper("euler", tmp_path / "replicate-euler" / "src")
    (tmp_path / "replicate-euler" / "pyproject.toml").write_text('[project]\nname = "replicate-euler"\n')
    (tmp_path / "helpers").mkdir()
    (tmp_path / "helpers" / "__init__.py").write_text("")
    assert ids(Library(folders=[tmp_path])) == ["gauss", "euler"]
    assert ids(Library(folders=[tmp_path / "gauss"])) == ["gauss"]
    with pytest.raises(UnknownPaperError, match="there is no folder nowhere"):
        Library(folders=[Path("nowhere")]).papers()


def test_two_projects_with_a_paper_of_one_name(tmp_path: Path) -> None:
    for name in ("one", "other"):
        made(tmp_path / name, "gauss")
        file = tmp_path / name / "papers" / "gauss" / "__init__.py"
        file.write_text(file.read_text().replace("TODO: title of the paper", name))
        assert Library(find_project(tmp_path / name)).paper("gauss").title == name


@pytest.mark.parametrize(
    "folders",
    [
        ("mine/papers/gauss",),
        ("mine/papers", "mine/papers/gauss"),
        ("mine/papers/gauss", "mine/papers"),
        ("copy/papers",),
    ],
)
def test_folders_that_overlap_with_the_project_or_hide_its_papers(tmp_path: Path, folders: tuple[str, ...]) -> None:
    for name in ("mine", "copy"):
        made(tmp_path / name, "gauss", "euler")
    library = Library(find_project(tmp_path / "mine"), [tmp_path / folder for folder in folders])
    for name in ("euler", "gauss", *ids(library)):
        paper = library.paper(name)
        assert list(paper.exhibits) == ["table-1", "fig-1", "claims"]
        assert str(paper.folder()).startswith(str(tmp_path / Path(folders[0]).parts[0]))
    assert not library.broken


def test_two_folders_with_a_paper_of_one_name_are_refused(tmp_path: Path) -> None:
    for name in ("one", "other"):
        new_paper("gauss", tmp_path / name)
    library = Library(folders=[tmp_path / "one", tmp_path / "other"])
    with pytest.raises(PaperDefinitionError, match=r"^other/gauss: the paper 'gauss' is already defined in one/gauss;"):
        library.papers()


def test_a_paper_with_the_name_of_a_library_is_refused(tmp_path: Path) -> None:
    new_paper("gauss", tmp_path).rename(tmp_path / "scipy")
    library = Library(folders=[tmp_path])
    new_paper("euler", tmp_path)
    assert ids(library) == ["euler"]
    assert library.broken == [
        f"{tmp_path.name}/scipy: another module on this machine is called 'scipy'; rename the folder"
    ]


def test_folders_one_after_the_other_have_papers_of_their_own(tmp_path: Path) -> None:
    for folder, names in {"one": ("gauss", "euler"), "two": ("gauss",), "three": ("euler",)}.items():
        for name in names:
            new_paper(name, tmp_path / folder)
        library = Library(folders=[tmp_path / folder])
        assert (ids(library), library.broken) == (sorted(names), [])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('titel = "x"', "replicate.toml:1: 'titel' is unknown; allowed: title, intro, methods, papers,"),
        ("title = 3", "replicate.toml:1: title is 3; expected: a text in quotes"),
        ('# why\npapers = "papers"', "replicate.toml:2: papers is 'papers'; expected: a list of folders"),
        ('papers = ["../nowhere"]', "replicate.toml:1: papers: there is no folder ../nowhere"),
        ('methods = "m.md"', "replicate.toml:1: methods: there is no file m.md"),
        ('[theme]\naccent = "red"', "replicate.toml:2: theme: accent = 'red'; allowed: accent, paper, ink, each a"),
        ('language = "English"', "replicate.toml:1: language is 'English', allowed: de, en, or the path of"),
        (
            '"language" = "xx"',
            "replicate.toml:1: language is 'xx', allowed: de, en, or the path of a file",
        ),
        ('language = "fr.toml"', "replicate.toml:1: language is '"),
        ('title = "x"\n\ntheme = {\naccent = "red" }', "replicate.toml:3: is not readable TOML"),
        (
            'title = "x"\n# theme\ntheme = { accent = "red" }',
            "replicate.toml:3: theme: accent = 'red'; allowed",
        ),
        ('title = "x"\ntheme.accent = "red"', "replicate.toml:2: theme: accent = 'red'; allowed: accent, paper, ink"),
        ('title = """\nout = 3"""\nout = 3', "replicate.toml:3: out is 3; expected: a text in quotes"),
        ('papers = [\n  "papers",\n  "../nowhere",\n]', "replicate.toml:1: papers: there is no folder"),
        ("title = ", "replicate.toml:1: is not readable TOML: Invalid value"),
    ],
)
def test_a_malformed_project_file(text: str, message: str, tmp_path: Path) -> None:
    (tmp_path / "replicate.toml").write_text(text)
    with pytest.raises(ProjectError, match=re.escape(message)):
        find_project(tmp_path)


def test_a_third_language_is_a_file_beside_the_project_file(tmp_path: Path) -> None:
    english = (templates_dir() / "languages" / "en.toml").read_text(encoding="utf-8")
    (tmp_path / "words").mkdir()
    words = tmp_path / "words/fr.toml"
    words.write_text(english.replace('"gb"', '"fr"').replace('"Exercise"', '"Exercice"'), encoding="utf-8")
    (tmp_path / "replicate.toml").write_text('papers = []\nlanguage = "words/fr.toml"')
    project = find_project(tmp_path)
    assert project is not None
    assert (project.language.code, project.language["exercise"]) == ("fr-FR", "Exercice")


def test_a_paper_in_a_folder_and_one_of_that_id_that_is_installed(
    replicate: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    replicate("init", "mine")
    monkeypatch.chdir("mine")
    assert replicate("new", "lab")[0] == 2  # there is one of this id
    replicate("new", "gauss")
    init = Path("papers/gauss/__init__.py")
    init.write_text(init.read_text(encoding="utf-8").replace('id="gauss"', 'id="lab"'), encoding="utf-8")
    said = "the paper 'lab' is already defined in papers/gauss; one of them needs another id"
    for command in (("report",), ("check", "lab"), ("show", "lab", "table-1"), ("diff",), ("handout", "lab")):
        status, _, errors = replicate(*command)
        assert status == 2
        assert errors.splitlines() == [f"replicate: entry point 'lab': {said}"]


def test_an_installed_paper_in_its_own_folder_is_one_paper(replicate: Run, folder: Path) -> None:
    status, out, errors = replicate("list", "--papers", str(folder))
    assert (status, errors, re.findall(r"^lab", out, re.MULTILINE)) == (0, "", ["lab"])


def test_an_installed_paper_that_is_not_installed(tmp_path: Path) -> None:
    (tmp_path / "replicate.toml").write_text('papers = ["gauss"]')
    with pytest.raises(ProjectError, match=r"papers: there is neither a folder nor an installed paper 'gauss'"):
        Library(find_project(tmp_path)).papers()


def test_one_broken_paper_breaks_nothing_else(replicate: Run) -> None:
    assert replicate("init", "mine")[0] == 0
    (Path("mine") / "here").mkdir()
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir("mine")
        replicate("new", "gauss")
        replicate("new", "euler")
        replicate("new", "riemann")
        with Path("papers/gauss/claims.py").open("a") as file:
            file.write("ratio = 1 / 0\n")
        Path("papers/riemann/printed/table-1.csv").write_text("row,mean,sd\nA,1.0,x\nB,1,1\nC,1,1\n")
        status, out, err = replicate("report", "-j1")
        assert status == 2
        assert "report: build/report/index.html" in out
        assert "broken: papers/gauss cannot be loaded: gauss/claims.py:20: ZeroDivisionError" in err
        assert "broken: riemann/printed/table-1.csv:2: column 'sd': 'x' is not a number" in err
        assert Path("build/report/euler.html").is_file()
        assert not Path("build/report/gauss.html").exists()
        page = Path("build/report/index.html").read_text()
        assert "<h1>Mine</h1>" in page
        assert "PID" not in page
        assert "dead time" not in page
        stamp = page.partition('<ul class="versions">')[2].partition("</ul>")[0]
        versions = set(re.findall(r"<li>([\w-]+) [\d.]+</li>", stamp))
        assert {"numpy", "pandas"} <= versions
        assert not {"control", "scipy", "schemdraw"} & versions
        assert not Path("build/report/methods.html").exists()


def test_accepting_says_where(replicate: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    replicate("init", "mine")
    monkeypatch.chdir("mine")
    replicate("new", "gauss")
    Path("below").mkdir()
    monkeypatch.chdir("below")
    status, out, _ = replicate("accept", "gauss", "--reason", "first", "-j1")
    assert status == 0
    assert "changes accepted: 3; in " in out
    assert Path("../accepted/gauss/table-1.csv").is_file()
    assert replicate("diff", "-j1")[0] == 0
    monkeypatch.chdir("../..")
    status, _, err = replicate("accept", "gauss", "--papers", "mine/papers", "--reason", "x", "-j1")
    assert status == 2
    assert "there is no project here: name the folder of the accepted state with --accepted" in err


def test_a_paper_that_lies_here_is_pointed_at(replicate: Run) -> None:
    replicate("new", "simc")
    status, _, err = replicate("report", "simc")
    assert status == 2
    assert "there is no paper 'simc'" in err
    assert "There is a folder simc here: --papers . includes it" in err
    assert replicate("report", "simc", "--papers", ".", "-j1")[0] == 0
