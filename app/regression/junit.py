"""Outcomes as JUnit XML, in the form that GitLab, Jenkins and GitHub's reporters read."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree as ET

from ..resources.atomic_write import write_text_atomically
from ..resources.sandbox import Sandbox
from .results import Outcome, RegressionRun

_NO_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def write_junit(session: RegressionRun, path: Path, sandbox: Sandbox) -> None:
    """One testsuite for every suite file, whole or not at all. Raises OutputError."""
    root = ET.Element("testsuites", name="halation", time=f"{session.seconds:.3f}")
    _count(root, session.outcomes)
    for suite in dict.fromkeys(item.case.suite for item in session.outcomes):
        mine = [item for item in session.outcomes if item.case.suite == suite]
        element = ET.SubElement(root, "testsuite", name=_text(suite.as_posix()))
        _count(element, mine)
        element.set("time", f"{sum(item.seconds for item in mine):.3f}")
        properties = ET.SubElement(element, "properties")
        said = {"device": session.device, "halation": session.version, "remark": session.remark}
        for name, text in said.items():
            if text:
                ET.SubElement(properties, "property", name=name, value=_text(text))
        for item in mine:
            _case(element, item)
    ET.indent(root)
    write_text_atomically(
        path, f'<?xml version="1.0" encoding="UTF-8"?>\n{ET.tostring(root, encoding="unicode")}\n', sandbox=sandbox
    )


def _case(suite: ET.Element, outcome: Outcome) -> None:
    case = outcome.case
    group = _text(case.suite.as_posix().removesuffix(".suite.toml").replace("/", "."))
    element = ET.SubElement(
        suite,
        "testcase",
        classname=group,
        name=_text(case.name),
        file=_text(case.suite.as_posix()),
        time=f"{outcome.seconds:.3f}",
    )
    if outcome.status == "failed":
        failure = ET.SubElement(element, "failure", type="failed", message=_text(outcome.sentence))
        lines = [outcome.sentence, *(check.sentence for check in outcome.checks if check.sentence)]
        failure.text = _text("\n".join(dict.fromkeys(lines)))
    elif outcome.status == "skipped":
        ET.SubElement(element, "skipped", message=_text(outcome.sentence))
    files = [path for check in outcome.checks for path in check.files]
    said = [f"[[ATTACHMENT|{path.absolute()}]]" for path in files]
    if outcome.status == "blessed":
        said.insert(0, f"blessed: {outcome.sentence}")
    if said:
        ET.SubElement(element, "system-out").text = _text("\n".join(said))


def _count(element: ET.Element, outcomes: Sequence[Outcome]) -> None:
    statuses = [item.status for item in outcomes]
    element.set("tests", str(len(statuses)))
    element.set("failures", str(statuses.count("failed")))
    element.set("errors", "0")
    element.set("skipped", str(statuses.count("skipped")))


def _text(text: str) -> str:
    """Without the characters that XML cannot hold."""
    return _NO_XML.sub("?", text)
