"""Findings as SARIF 2.1.0, the format in which code hosts read results of checkers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from hashlib import blake2b
from pathlib import Path
from typing import Any
from urllib.parse import quote

from ..graph.rules import Rule
from .allowing import place_name
from .checking import CheckReport, Finding

SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"


def sarif(reports: Iterable[CheckReport], rules: Mapping[str, Rule], root: Path, version: str) -> dict[str, Any]:
    """The log of one run. Paths are relative to `root`; files outside of it have full paths."""
    places = {name: place for place, name in enumerate(rules)}
    results = [
        _result(finding, _uri(report.file, root), places[finding.problem.rule.name])
        for report in reports
        for finding in report.findings
    ]
    driver = {"name": "Halation", "version": version, "rules": [_rule(rule) for rule in rules.values()]}
    return {"$schema": SCHEMA, "version": "2.1.0", "runs": [{"tool": {"driver": driver}, "results": results}]}


def _rule(rule: Rule) -> dict[str, Any]:
    help = f"{rule.doc} {rule.way_out}"
    return {
        "id": rule.name,
        "shortDescription": {"text": rule.name.replace("-", " ").capitalize()},
        "fullDescription": {"text": rule.doc},
        "help": {"text": help, "markdown": help},
        "defaultConfiguration": {"level": rule.severity},
    }


def _result(finding: Finding, uri: str, index: int) -> dict[str, Any]:
    problem = finding.problem
    file = {"artifactLocation": {"uri": uri}, "region": {"startLine": finding.line}}
    location: dict[str, Any] = {"physicalLocation": file}
    if place := place_name(problem):
        location["logicalLocations"] = [{"fullyQualifiedName": place}]
    return {
        "ruleId": problem.rule.name,
        "ruleIndex": index,
        "level": problem.severity,
        "message": {"text": problem.sentence},
        "locations": [location],
        # No line is part of the fingerprint, so a finding keeps its identity after an edit above it.
        "partialFingerprints": {"halation/v1": _hash(problem.rule.name, uri, place, problem.socket, problem.sentence)},
    }


def _uri(file: str, root: Path) -> str:
    """A path as a URI reference: relative to the root where it is below it."""
    path = Path(file).absolute()
    try:
        # A folder that is reached by a link counts by the name that was given.
        return quote(path.relative_to(root.absolute()).as_posix())
    except ValueError:
        return path.as_uri()


def _hash(*parts: str) -> str:
    return blake2b("\0".join(parts).encode("utf-8", "surrogateescape"), digest_size=16).hexdigest()
