"""Files that a run leaves behind: layout, determinism, and nothing half written."""

from __future__ import annotations

import csv
import io
import xml.etree.ElementTree as ET
from pathlib import Path

import pandas as pd
import synthetic

from replicate.display.csv_text import table_text
from replicate.report.data import EXHIBIT_COLUMNS, RANGE_COLUMNS, RESULT_COLUMNS, VERDICT_COLUMNS, write_outputs
from replicate.staging import staged
from replicate.verdicts.inputs import Inputs
from replicate.verdicts.judge import judge
from replicate.verdicts.rows import Judgement


def written(folder: Path, **changes: object) -> Path:
    data = folder / "data"
    data.mkdir(parents=True)
    toy = synthetic.paper(data)
    results = synthetic.results(**changes)  # type: ignore[arg-type]
    judgement = judge(toy, results, Inputs(synthetic.printed(by="4.6")))
    out = folder / "out"
    with staged(out) as fresh:
        write_outputs([toy], results, judgement, fresh)
    return out


def rows(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(path.read_text(encoding="utf-8"))))


def contents(folder: Path) -> dict[Path, bytes]:
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_the_three_lists(tmp_path: Path) -> None:
    out = written(tmp_path)
    results, verdicts, exhibits = (rows(out / f"{name}.csv") for name in ("results", "verdicts", "exhibits"))
    assert tuple(results[0]) == RESULT_COLUMNS
    assert tuple(verdicts[0]) == (*VERDICT_COLUMNS, "address")
    assert tuple(exhibits[0]) == EXHIBIT_COLUMNS
    # the toy paper computes nothing from printed inputs
    assert (out / "ranges.csv").read_text(encoding="utf-8") == ",".join(RANGE_COLUMNS) + "\n"
    assert results[0] == {
        "paper": "toy",
        "exhibit": "table-1",
        "row": "A",
        "column": "x",
        "printed": "1.0",
        "reading": "as-written",
        "computed": "1",
        "match": "equal",
    }
    assert [row["status"] for row in exhibits] == ["done", "done", "done", "not-computable"] or len(exhibits) == 4
    assert {row["row"]: row["verdict"] for row in verdicts if row["column"] == "claim"} == {
        "big": "holds",
        "smooth": "fails",
    }


def test_verdicts_and_errata_end_with_the_place_in_the_report(tmp_path: Path) -> None:
    out = written(tmp_path)
    assert {"toy.html#table-1.A.x", "toy.html#claims.big.claim"} <= {
        row["address"] for row in rows(out / "verdicts.csv")
    }
    assert [row["address"] for row in rows(out / "errata.csv")] == ["toy.html#claims.smooth.claim"]


def test_tables_and_figures(tmp_path: Path) -> None:
    out = written(tmp_path, as_written=synthetic.frame(ax=2.0 / 3.0, ay=float("nan")))
    assert (out / "tables/toy/table-1.as-written.csv").read_text() == "row,x,y\nA,0.666666666667,\nB,3,4\n"
    assert (out / "tables/toy/table-1.authors.csv").is_file()
    assert (out / "figures/toy/fig-1.svg").read_text() == "<svg/>"
    assert (out / "figures/toy/fig-1.png").read_bytes() == b"png"
    assert (out / "figures/toy/fig-1.csv").read_text() == "panel,curve,x,y\n"


def test_a_reading_that_raised_has_no_table(tmp_path: Path) -> None:
    out = written(tmp_path, errors={"authors": "ValueError: no"})
    assert [path.name for path in (out / "tables/toy").iterdir()] == ["table-1.as-written.csv"]
    suite = ET.parse(out / "junit.xml").getroot()  # noqa: S314  -- written by us
    (error,) = suite.iter("error")
    assert error.get("message") == "ValueError: no"


def test_junit_counts(tmp_path: Path) -> None:
    root = ET.parse(written(tmp_path) / "junit.xml").getroot()  # noqa: S314  -- written by us
    toy, check = root.findall("testsuite")
    assert (toy.get("name"), toy.get("tests"), toy.get("errors")) == ("toy", "6", "0")
    # 4.6 is printed, 4.0 computed: more than two units off, and no ledger says why
    (failure,) = toy.iter("failure")
    assert "printed 4.6, computed 4" in str(failure.get("message"))
    assert check.get("failures") == "1"


def test_tables_keep_text_and_blanks() -> None:
    frame = pd.DataFrame({"rule": ["ki = 1/Ti", None], "n": [3, 4], "x": [-0.0, 1e-20]}, index=["a", "b"])
    assert table_text(frame) == "row,rule,n,x\na,ki = 1/Ti,3,0\nb,,4,1e-20\n"


def test_same_results_same_bytes(tmp_path: Path) -> None:
    one, other = written(tmp_path / "1"), written(tmp_path / "2")
    files = {path.relative_to(one): path.read_bytes() for path in one.rglob("*") if path.is_file()}
    assert files == {path.relative_to(other): path.read_bytes() for path in other.rglob("*") if path.is_file()}
    assert len(files) == 24  # with the manifest; eleven of them twice, once inside the report
    assert not any(str(tmp_path).encode() in content for content in files.values())


def test_an_empty_judgement_is_still_well_formed(tmp_path: Path) -> None:
    with staged(tmp_path) as fresh:
        write_outputs([], {}, Judgement(), fresh)
    assert rows(tmp_path / "results.csv") == []
