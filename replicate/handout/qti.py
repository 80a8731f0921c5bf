"""The exercises of a handout as a package of QTI 2.1, for learning platforms that read it.

The package has a manifest, one item per exercise and form, and a test with one section per exercise that selects one of
its forms. Formulas are MathML with their words, figures are files. A numerical answer is right from the lower to the
upper end of what the key accepts.
Source: IMS Question & Test Interoperability 2.1, Assessment Test, Section and Item Information Model (2012).
"""

from __future__ import annotations

import io
import xml.etree.ElementTree as ET
import zipfile
from collections.abc import Iterable, Mapping, Sequence
from itertools import groupby

from replicate.exhibits.variants import Answer
from replicate.handout.marking_key import accepted_ends, plain_decimals
from replicate.handout.question_texts import Texts, picture_name, texts_of
from replicate.handout.questions import Question, different, drawings_in
from replicate.handout.spoken_math import spoken

QTI = "http://www.imsglobal.org/xsd/imsqti_v2p1"
PACKAGE = "http://www.imsglobal.org/xsd/imscp_v1p1"
MATHML = "http://www.w3.org/1998/Math/MathML"
_LANGUAGE = "{http://www.w3.org/XML/1998/namespace}lang"
_DATE = (1980, 1, 1, 0, 0, 0)  # the first that a zip file can tell; it is to tell none

# What the standard takes from HTML, and in place of what it does not.
_ELEMENTS = frozenset(
    {
        "a",
        "blockquote",
        "br",
        "caption",
        "code",
        "dd",
        "div",
        "dl",
        "dt",
        "em",
        "h1",
        "h2",
        "h3",
        "h4",
        "h5",
        "h6",
        "hr",
    }
    | {"img", "li", "ol", "p", "pre", "q", "small", "span", "strong", "sub", "sup", "table", "tbody", "td", "tfoot"}
    | {"th", "thead", "tr", "ul"}
)
_ATTRIBUTES = {"alt", "class", "colspan", "href", "id", "rowspan", "scope", "src"}


def qti_package(questions: Iterable[Question]) -> bytes:
    """Return the package.

    Parameters
    ----------
    questions
        Of any number of forms; equal ones, of exercises that do not vary, are written once.
    """
    chosen = different(questions)
    files: dict[str, bytes] = {}
    resources: list[tuple[str, str, list[str]]] = []
    for question, texts in zip(chosen, texts_of(chosen, _place, "--mathml"), strict=True):
        item = f"items/{question.id}.xml"
        files[item] = _xml(_item(question, texts), QTI)
        shown = drawings_in([*question.text, *question.solution], question.document)
        beside = {f"images/{picture_name(one)}": one.png for one in shown}
        beside |= {f"data/{question.id}-{name}": text.encode() for name, text in question.files.items()}
        files |= beside
        resources.append((question.id, item, sorted(beside)))
    files["test.xml"] = _xml(_test(chosen), QTI)
    files["imsmanifest.xml"] = _xml(_manifest(resources), PACKAGE)
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as package:
        for name, content in sorted(files.items(), key=lambda file: (file[0] != "imsmanifest.xml", file[0])):
            about = zipfile.ZipInfo(name, _DATE)
            about.compress_type, about.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            package.writestr(about, content)
    return out.getvalue()


def _place(question: Question, name: str) -> str:
    """Return where an item finds a file, from its own folder."""
    return f"../data/{question.id}-{name}" if name in question.files else f"../images/{name}"


def _manifest(resources: Sequence[tuple[str, str, list[str]]]) -> ET.Element:
    root = ET.Element("manifest", identifier="manifest")
    about = ET.SubElement(root, "metadata")
    ET.SubElement(about, "schema").text = "QTIv2.1 Package"
    ET.SubElement(about, "schemaversion").text = "1.0.0"
    ET.SubElement(root, "organizations")
    found = ET.SubElement(root, "resources")
    test = ET.SubElement(found, "resource", identifier="test", type="imsqti_test_xmlv2p1", href="test.xml")
    ET.SubElement(test, "file", href="test.xml")
    for id, item, images in resources:
        ET.SubElement(test, "dependency", identifierref=id)
        resource = ET.SubElement(found, "resource", identifier=id, type="imsqti_item_xmlv2p1", href=item)
        for file in (item, *images):
            ET.SubElement(resource, "file", href=file)
    return root


def _test(questions: Sequence[Question]) -> ET.Element:
    document = questions[0].document
    root = ET.Element("assessmentTest", identifier=document.paper.id, title=document.title)
    part = ET.SubElement(root, "testPart", identifier="part", navigationMode="nonlinear", submissionMode="simultaneous")
    for number, forms in groupby(questions, key=lambda question: question.number):
        of_one = list(forms)
        section = ET.SubElement(
            part, "assessmentSection", identifier=f"exercise-{number}", title=of_one[0].title, visible="true"
        )
        ET.SubElement(section, "selection", select="1")
        for question in of_one:
            ET.SubElement(section, "assessmentItemRef", identifier=question.id, href=f"items/{question.id}.xml")
    return root


def _item(question: Question, texts: Texts) -> ET.Element:
    root = ET.Element(
        "assessmentItem",
        {
            "identifier": question.id,
            "title": question.title,
            "adaptive": "false",
            "timeDependent": "false",
            _LANGUAGE: question.document.language.code,
        },
    )
    names = {name: f"RESPONSE_{number}" for number, name in enumerate(question.answers, start=1)}
    for name, response in (names or {"": "RESPONSE"}).items():
        kind = "float" if names else "string"
        declared = ET.SubElement(root, "responseDeclaration", identifier=response, cardinality="single", baseType=kind)
        if names:
            correct = ET.SubElement(declared, "correctResponse")
            ET.SubElement(correct, "value").text = plain_decimals(question.answers[name].value)
    worth = question.points or max(1, len(names))
    score = ET.SubElement(
        root,
        "outcomeDeclaration",
        identifier="SCORE",
        cardinality="single",
        baseType="float",
        normalMaximum=f"{worth:g}",
    )
    ET.SubElement(ET.SubElement(score, "defaultValue"), "value").text = "0"
    body = ET.SubElement(root, "itemBody")
    body.append(_content("div", texts.text))
    for name, response in names.items():
        label = _content("p", texts.labels[name])
        _last_text(label, " = ")
        entry = ET.SubElement(label, "textEntryInteraction", responseIdentifier=response, expectedLength="12")
        entry.tail = f" {question.answers[name].unit}" if question.answers[name].unit else None
        body.append(label)
    if not names:
        ET.SubElement(body, "extendedTextInteraction", responseIdentifier="RESPONSE", expectedLines="15")
    if question.solution:
        solution = ET.SubElement(body, "rubricBlock", view="scorer tutor")
        solution.append(_content("div", texts.solution))
    if names:
        root.append(_processing(question.answers, names, worth / len(names)))
    return root


def _processing(answers: Mapping[str, Answer], names: Mapping[str, str], worth: float) -> ET.Element:
    """Return the rules that give each accepted answer its share of the points."""
    root = ET.Element("responseProcessing")
    for name, response in names.items():
        condition = ET.SubElement(ET.SubElement(root, "responseCondition"), "responseIf")
        both = ET.SubElement(condition, "and")
        for relation, end in zip(("gte", "lte"), accepted_ends(answers[name]), strict=True):
            compared = ET.SubElement(both, relation)
            ET.SubElement(compared, "variable", identifier=response)
            ET.SubElement(compared, "baseValue", baseType="float").text = end
        total = ET.SubElement(ET.SubElement(condition, "setOutcomeValue", identifier="SCORE"), "sum")
        ET.SubElement(total, "variable", identifier="SCORE")
        ET.SubElement(total, "baseValue", baseType="float").text = f"{worth:.10g}"
    return root


def _content(tag: str, fragment: str) -> ET.Element:
    """Return HTML as an element with only what the standard knows."""
    root = ET.fromstring(f"<{tag}>{fragment}</{tag}>")  # noqa: S314  -- pandoc's own output
    parents = {child: parent for parent in root.iter() for child in parent}
    for node in list(root.iter()):
        if node.tag == f"{{{MATHML}}}math":
            node.set("alttext", spoken(node))
        if node.tag.startswith("{"):
            continue
        if node.tag == "colgroup":
            parents[node].remove(node)
        elif node.tag not in _ELEMENTS:
            node.tag = "div" if node.tag in {"figure", "figcaption", "section"} else "span"
        for key in [key for key in node.attrib if key not in _ATTRIBUTES]:
            del node.attrib[key]
    return root


def _last_text(node: ET.Element, text: str) -> None:
    """Put text behind all that a node holds."""
    if len(node):
        node[-1].tail = (node[-1].tail or "") + text
    else:
        node.text = (node.text or "") + text


def _xml(root: ET.Element, namespace: str) -> bytes:
    """Return a document; the names of formulas have their own namespace, all others this one."""
    for node in root.iter():
        if not node.tag.startswith("{"):
            node.tag = f"{{{namespace}}}{node.tag}"
    ET.register_namespace("m", MATHML)
    ET.register_namespace("", namespace)
    return b'<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding="unicode").encode() + b"\n"
