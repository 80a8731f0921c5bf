"""Rosters: as spreadsheets save them, with names of any script, and what cannot be used is one line."""

from __future__ import annotations

from pathlib import Path

import pytest

from replicate.errors import ReplicateError
from replicate.handout import read_roster
from replicate.handout.roster import file_stem


def test_a_roster_of_many_scripts() -> None:
    students = read_roster(Path(__file__).parents[1] / "examples" / "roster.csv")
    assert len(students) == len(set(students)) >= 8
    assert any(not student.isascii() for student in students)


@pytest.mark.parametrize(
    ("text", "column", "message"),
    [
        ("", "", "roster is empty"),
        ("name,mail\n\n", "", "roster is empty"),
        ("Student,ID\n    Points Possible,\n", "", "roster is empty"),
        ('Student,ID\n    Points Possible,\n"Student, Test",9\n', "", "roster is empty"),
        ("Status;Name\nMitglied;Ada\nMitglied;Bob\n", "", "choose a column in which all differ with --roster-id"),
        ("name,mail\nAda,a\nada,b\n", "", "r.csv:3: 'ada' names the same sheet as 'Ada' in line 2"),
        ("name;mail\nAda;a\n", "id", "no column 'id'; allowed: name, mail"),
        ("name,id\nAda,\n", "id", "r.csv:2: no entry in the column 'id'"),
        ("name\nA/B\nA:B\n", "", "names the same sheet"),
        ("name\nZo\u00eb\nZoe\u0308\n", "", "r.csv:3: 'Zoë' names the same sheet as 'Zoë' in line 2"),
        ("name\nSTRASSE\nStraße\n", "", "r.csv:3: 'Straße' names the same sheet as 'STRASSE' in line 2"),
        (f"name\n{'x' * 300}\n{'x' * 300}\n", "", r"r.csv:3: 'x{60}\.\.\.' names the same sheet as 'x{60}\.\.\.'"),
        ("id,id\n1,2\n", "id", "r.csv: several columns are named 'id'; rename them"),
        ('name\n"Ada\nBob\n', "", "r.csv:3: cannot be read as CSV: unexpected end of data"),
        ('name,mail\n"Ada,a\nBob"\n', "", "r.csv:3: 'Ada,a...' goes on in another line; is a quotation mark missing?"),
        ("name\nA\u202edA\n", "", "r.csv:2: holds the character U.202E"),
        ("Group 2026,,\nname,mail,x\nAda,a,1\n", "", "r.csv:1: 'Group 2026' is a title, not the names of the columns"),
        ("Group 2026\nname,mail\nAda,a\n", "", "r.csv:2: has 2 cells, more than the 1 columns that the first line"),
        (
            ",Students,,Marks,\nid,first,last,1,2\n7,Ada,L,3,4\n",
            "",
            "r.csv:1: column 3 has no name; name it, or",
        ),
        ("name,mail\nLovelace, Ada,a\n", "", "r.csv:2: has 3 cells, .* is a quotation mark missing"),
        ("name\nA\0B\n", "", "r.csv:2: holds the character U.0000"),
    ],
)
def test_a_roster_that_cannot_be_used_is_one_line(tmp_path: Path, text: str, column: str, message: str) -> None:
    (tmp_path / "r.csv").write_text(text, encoding="utf-8")
    with pytest.raises(ReplicateError, match=message) as found:
        read_roster(tmp_path / "r.csv", column)
    assert "\n" not in str(found.value)


def test_long_names_that_differ_at_their_end_name_two_sheets(tmp_path: Path) -> None:
    students = ["x" * 300, "x" * 299 + "y", "山" * 300, "山" * 299 + "田"]
    (tmp_path / "r.csv").write_text("\n".join(["name", *students]), encoding="utf-8")
    assert read_roster(tmp_path / "r.csv") == students
    assert len({file_stem(student) for student in students}) == len(students)


@pytest.mark.parametrize(
    "content",
    [
        "name;Größe\r\nAda;1\r\nZoë;2\r\n".encode("utf-8-sig"),  # as spreadsheets save it: mark, semicolons, CRLF
        b"sep=;\r\nname;x\r\nAda;1\r\nZo\xc3\xab;2\r\n",
        "name\tx\r\nAda\t1\r\nZoë\t2\r\n".encode("utf-16"),  # "Unicode text"
        "\ufeffname;x;\r\n;;\r\nAda;1;\r\nZoë;2;;\r\n".encode("utf-16-be"),
        "name;Größe\nAda;1\nZoë;2".encode("utf-16-le"),  # without a mark
        "name\tx\r\nAda\t1\r\nZoë\t2\r\n".encode("utf-16-be"),
        "name\tx\r\nAda\t1\r\nZoë\t2\r\n".encode("utf-32"),
        "\ufeffname;x\nAda;1\nZoë;2\n".encode("utf-32-be"),
        "name;x\nAda;1\nZoë;2".encode("utf-32-le"),
        b"\r\nname\tx\r\n\r\nAda\t1\r\nZo\xc3\xab\t2",
        b'"name","x"\rAda,"1\r2"\rZo\xc3\xab',
        'name;"a, b, c"\nAda;1\nZoë;2\n'.encode(),
    ],
)
def test_a_roster_as_spreadsheets_save_it(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "r.csv").write_bytes(content)
    assert read_roster(tmp_path / "r.csv") == read_roster(tmp_path / "r.csv", "name") == ["Ada", "Zoë"]


@pytest.mark.parametrize(
    ("content", "column", "students"),
    [
        (  # a gradebook of Canvas, as its exporter writes it
            '\ufeffStudent,ID,Quiz\n,,Manual Posting\n    Points Possible,,10\n"Lovelace, Ada",7,\n"Müller, Zoë",8,9\n',
            "",
            ["Lovelace, Ada", "Müller, Zoë"],
        ),
        ("Student,ID,Section\n    Points Possible,,\nAda,7,A\nAda,8,A\n", "ID", ["7", "8"]),
        ("Student,ID\nAda,7\n    Points Possible,\nBob,8\n", "", ["Ada", "Bob"]),  # sorted by another program
        ("Student,ID,,\nAda,7,,\n", "", ["Ada"]),
        (  # its test student comes last; without the line of points, it may be a person of that name
            'Student,ID,SIS Login ID\n    Points Possible,,\n"L, Ada",7,al\n"Student, Test",9,0c1f\n',
            "SIS Login ID",
            ["al"],
        ),
        ('Student,ID\n"L, Ada",7\n"Student, Test",9\n', "", ["L, Ada", "Student, Test"]),
        # participants of a course of Moodle
        (
            "First name,Last name,Email address,Groups\nAda,L,a@x.org,\nAda,B,b@x.org,G\n",
            "Email address",
            ["a@x.org", "b@x.org"],
        ),
        # a grade centre of Blackboard: UTF-16 with tabs
        ("Last Name\tFirst Name\tUsername\nLovelace\tAda\tal1\nLovelace\tZoë\tzl2\n", "Username", ["al1", "zl2"]),
        # members of a course in ILIAS, participants in Stud.IP: semicolons, a status before the names
        (
            '"Status";"Nachname";"Benutzername"\n"Mitglied";"L";"al"\n"Mitglied";"B";"zb"\n',
            "Benutzername",
            ["al", "zb"],
        ),
    ],
)
def test_a_roster_as_learning_platforms_export_it(
    tmp_path: Path, content: str, column: str, students: list[str]
) -> None:
    (tmp_path / "r.csv").write_text(content, encoding="utf-16-le" if "\t" in content else "utf-8")
    assert read_roster(tmp_path / "r.csv", column) == students


def test_a_roster_in_an_old_encoding_says_how_to_save_it(tmp_path: Path) -> None:
    (tmp_path / "r.csv").write_bytes("name\nAda\nZoë\n".encode("latin-1"))
    with pytest.raises(
        ReplicateError, match=r"r\.csv:3: is not UTF-8 text; in a spreadsheet, save the roster as 'CSV U"
    ):
        read_roster(tmp_path / "r.csv")


@pytest.mark.parametrize(
    "student",
    ["../../etc/passwd", "C:\\Users", ". .", "CON", "a" * 400, "👩‍🔬" * 90, "山" * 200, "ليلى حداد", "a\u200bb", "*?"],
)
def test_a_name_of_any_kind_is_part_of_a_name_of_one_file(tmp_path: Path, student: str) -> None:
    name = f"panagopoulos-{file_stem(student)}-solutions.pdf"
    assert Path(name).name == name
    assert len(name.encode()) < 200
    (tmp_path / name).write_bytes(b"")
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_names_of_one_letter_in_utf_16_are_not_taken_for_utf_32(tmp_path: Path) -> None:
    for encoding in ("utf-16", "utf-16-le", "utf-16-be", "utf-32-le", "utf-32-be"):
        (tmp_path / "r.csv").write_bytes("n\na\nb\n".encode(encoding))
        assert read_roster(tmp_path / "r.csv") == ["a", "b"]
