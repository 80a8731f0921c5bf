"""The outcome of a run as a JUnit file, which CI systems show as a list of tests.

One test per printed value and claim: it fails where the value is unexplained and no ledger entry says what
was tried, is skipped where nothing can be computed, and passes otherwise, since a known and explained
difference is not news. One test per exhibit that raised, and one for each other problem.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Sequence

from replicate.exhibits.results import Results, errors_of
from replicate.plain_text import visible
from replicate.verdicts.rows import Judgement, VerdictRow


def junit(papers: Sequence[str], results: Results, judgement: Judgement) -> str:
    """Return the XML, one test suite per paper, without times.

    Parameters
    ----------
    papers
        Ids, in the order of the suites.
    """
    root = ET.Element("testsuites", name="replicate")
    for paper in papers:
        suite = ET.SubElement(root, "testsuite", name=paper)
        for verdict in judgement.verdicts:
            if verdict.paper == paper:
                _value(suite, verdict)
        for (owner, exhibit), result in results.items():
            if owner == paper:
                for part, why in errors_of(result).items():
                    add_case(suite, f"{paper}.{exhibit}", f"computing {part or exhibit}", "error", why)
        count_cases(suite)
    suite = ET.SubElement(root, "testsuite", name="check")
    for place, problem in enumerate(judgement.problems, start=1):
        add_case(suite, "check", f"problem {place}", "failure", problem)
    count_cases(suite)
    return xml_text(root)


def _value(suite: ET.Element, verdict: VerdictRow) -> None:
    said = f"printed {verdict.printed}, computed {verdict.computed or 'nothing'}: {verdict.verdict}"
    outcome = ""
    if verdict.verdict == "not-computable":
        outcome = "skipped"
    elif verdict.verdict == "unexplained" and not verdict.cause:
        outcome = "failure"
    add_case(suite, f"{verdict.paper}.{verdict.exhibit}", f"{verdict.row} {verdict.column}", outcome, said)


def xml_text(root: ET.Element) -> str:
    """Return an indented document."""
    ET.indent(root)
    return ET.tostring(root, encoding="unicode", xml_declaration=False) + "\n"


def add_case(suite: ET.Element, classname: str, name: str, outcome: str, message: str) -> None:
    """Add a test to a suite; `outcome` is the element that says how it ended, empty if it passed."""
    case = ET.SubElement(suite, "testcase", classname=classname, name=visible(name))
    if outcome:
        ET.SubElement(case, outcome, message=visible(message))


def count_cases(suite: ET.Element) -> None:
    """Write the numbers of tests into the finished suite."""
    suite.set("tests", str(len(suite)))
    for plural, outcome in (("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
        suite.set(plural, str(len(suite.findall(f"testcase/{outcome}"))))
