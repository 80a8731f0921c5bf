"""What the papers offer for trying out: rows that exist, and loops that the page and the core both read."""

from __future__ import annotations

import csv
import re

import pytest

from replicate.exhibits import Paper, Table
from replicate.exhibits.trials import declared_trials
from replicate.loops import PID
from replicate.loops.notation import parse_controller, parse_plant
from replicate.run.library import Library

PAPERS = {paper.id: paper for paper in Library(bundled=True).papers()}
MOST_POLES = 15  # of a plant on the page


def tables(paper: Paper) -> list[Table]:
    return [one for one in paper.exhibits.values() if isinstance(one, Table) and one.trials is not None]


@pytest.mark.parametrize("id", PAPERS)
def test_each_paper_has_rows_to_try_out(id: str) -> None:
    found = tables(PAPERS[id])
    assert found
    for table in found:
        rows = {trial.row for trial in declared_trials(table.trials)}
        assert rows, table.id
        assert rows <= set(table.rows), table.id


@pytest.mark.parametrize("id", PAPERS)
def test_the_page_can_read_each_loop(id: str) -> None:
    for table in tables(PAPERS[id]):
        for trial in declared_trials(table.trials):
            where = f"{table.id}, {trial}"
            plant, controller = parse_plant(trial.plant), parse_controller(trial.controller)
            assert plant.is_rational, where
            assert len(plant.parts) == 1, where
            assert plant.num.size <= plant.den.size <= MOST_POLES + 1, where
            assert plant.num.size < plant.den.size or plant.dead_time > 0, where  # a pure dead time is drawn
            assert isinstance(controller.setpoint_filter, float | int), where
            plain = PID(
                *(controller.k, controller.ki, controller.kd), b=controller.b, c=controller.c,
                derivative_filter=controller.derivative_filter, setpoint_filter=controller.setpoint_filter,
            )  # fmt: skip
            assert controller.notation() in {plain.notation(), plain.notation().replace(",kd=0", "")}, where


@pytest.mark.parametrize("id", PAPERS)
def test_exercises_lead_to_loops_that_exist(id: str) -> None:
    text = (PAPERS[id].folder() / "handout.md").read_text(encoding="utf-8")
    exercises = text.partition("## Exercises")[2]
    calls = re.findall(r"try_it\('([^']+)', '([^']+)'(?:, '([^']+)')?\)", exercises)
    assert len(set(calls)) >= 2
    for table, row, case in calls:
        found = PAPERS[id].exhibits[table]
        assert isinstance(found, Table)
        assert (row, case) in {(trial.row, trial.case) for trial in declared_trials(found.trials)}


def printed(paper: str, table: str) -> dict[str, dict[str, str]]:
    text = (PAPERS[paper].folder() / "printed" / f"{table}.csv").read_text(encoding="utf-8")
    return {row["row"]: row for row in csv.DictReader(text.splitlines())}


def controllers(paper: str, table: str) -> dict[str, PID]:
    found = PAPERS[paper].exhibits[table]
    assert isinstance(found, Table)
    return {trial.row: parse_controller(trial.controller) for trial in declared_trials(found.trials)}


@pytest.mark.parametrize("table", ["I-table-1", "I-table-5", "II-table-1", "IIs-table-2"])
def test_gains_are_those_printed_in_the_row(table: str) -> None:
    texts = printed("panagopoulos", table)
    for row, controller in controllers("panagopoulos", table).items():
        cells = texts[row]
        assert controller.k == float(cells["k"])
        if cells.get("ki"):
            assert controller.ki == float(cells["ki"])
        else:
            assert controller.k / controller.ki == pytest.approx(float(cells["Ti"]), rel=1e-12)
        if cells.get("Td"):
            assert controller.kd / controller.k == pytest.approx(float(cells["Td"]), rel=1e-12)
        if cells.get("b"):
            assert controller.b == float(cells["b"])


@pytest.mark.parametrize("table", ["II-table-1", "IIs-table-2"])
def test_rows_with_a_setpoint_filter_are_tried_with_it(table: str) -> None:
    texts = printed("panagopoulos", table)
    found = controllers("panagopoulos", table)
    assert list(found) == list(texts)
    assert {row: one.setpoint_filter for row, one in found.items()} == {
        row: float(cells["Tsp"]) for row, cells in texts.items()
    }
    assert any(one.setpoint_filter for one in found.values())


def test_the_series_form_keeps_its_transfer_function() -> None:
    texts = printed("ali", "table-2")
    s = 0.3 + 2j
    for row, controller in controllers("ali", "table-2").items():
        gain, ti, td = float(texts[row]["KKp"]), float(texts[row]["Ti"]), float(row) / 2
        series = gain * (1 + 1 / (s * ti)) * (1 + s * td) / (1 + 0.1 * s * td)  # (2), alpha = 0.1
        assert controller.feedback(s) == pytest.approx(series, rel=1e-12)


def test_points_of_the_plane_are_gains() -> None:
    texts = printed("krajewski", "fig-9-values")
    for row, controller in controllers("krajewski", "fig-9-values").items():
        assert controller.ki == pytest.approx(float(texts[row]["a"]), abs=5e-5)
