"""Writes outcomes as JUnit XML, in the form that GitLab, Jenkins and GitHub's reporters read."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree as ET

from ..resources.atomic_write import write_text_atomically
from ..resources.sandbox import Sandbox
from .results import Outcome, RegressionRun

_INVALID_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def write_junit(session: RegressionRun, path: Path, sandbox: Sandbox) -> None:
    """One testsuite for every suite file, whole or not at all. Raises OutputError."""
    root = ET.Element("testsuites", name="halation", time=f"{session.seconds:.3f}")
    _write_counts(root, session.outcomes)
    for suite in dict.fromkeys(item.case.suite for item in session.outcomes):
        suite_outcomes = [item for item in session.outcomes if item.case.suite == suite]
        element = ET.SubElement(root, "testsuite", name=_clean_text(suite.as_posix()))
        _write_counts(element, suite_outcomes)
        element.set("time", f"{sum(item.seconds for item in suite_outcomes):.3f}")
        properties = ET.SubElement(element, "properties")
        properties_by_name = {"device": session.device, "halation": session.version, "remark": session.remark}
        for name, text in properties_by_name.items():
            if text:
                ET.SubElement(properties, "property", name=name, value=_clean_text(text))
        for item in suite_outcomes:
            _write_case(element, item)
    ET.indent(root)
    write_text_atomically(
        path, f'<?xml version="1.0" encoding="UTF-8"?>\n{ET.tostring(root, encoding="unicode")}\n', sandbox=sandbox
    )


def _write_case(suite: ET.Element, outcome: Outcome) -> None:
    case = outcome.case
    group = _clean_text(case.suite.as_posix().removesuffix(".suite.toml").replace("/", "."))
    element = ET.SubElement(
        suite,
        "testcase",
        classname=group,
        name=_clean_text(case.name),
        file=_clean_text(case.suite.as_posix()),
        time=f"{outcome.seconds:.3f}",
    )
    if outcome.status == "failed":
        failure = ET.SubElement(element, "failure", type="failed", message=_clean_text(outcome.sentence))
        lines = [outcome.sentence, *(check.sentence for check in outcome.checks if check.sentence)]
        failure.text = _clean_text("\n".join(dict.fromkeys(lines)))
    elif outcome.status == "skipped":
        ET.SubElement(element, "skipped", message=_clean_text(outcome.sentence))
    files = [path for check in outcome.checks for path in check.files]
    output_lines = [f"[[ATTACHMENT|{path.absolute()}]]" for path in files]
    if outcome.status == "blessed":
        output_lines.insert(0, f"blessed: {outcome.sentence}")
    if output_lines:
        ET.SubElement(element, "system-out").text = _clean_text("\n".join(output_lines))


def _write_counts(element: ET.Element, outcomes: Sequence[Outcome]) -> None:
    statuses = [item.status for item in outcomes]
    element.set("tests", str(len(statuses)))
    element.set("failures", str(statuses.count("failed")))
    element.set("errors", "0")
    element.set("skipped", str(statuses.count("skipped")))


def _clean_text(text: str) -> str:
    """The text without characters that XML cannot hold."""
    return _INVALID_XML.sub("?", text)
