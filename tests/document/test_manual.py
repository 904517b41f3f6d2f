"""The page about the file says what is true."""

from __future__ import annotations

import re
from dataclasses import fields
from pathlib import Path

import msgspec
from halation import document
from halation.document import records
from halation.graph import Settings, problems
from halation.resources.sandbox import UNRESTRICTED

PAGE = (Path(__file__).parents[2] / "docs" / "format.md").read_text(encoding="utf-8")


def test_the_example_is_a_graph_in_the_canonical_layout() -> None:
    found = re.search(r"```json\n(.*?)```", PAGE, re.DOTALL)
    assert found
    graph = document.loads(found[1], sandbox=UNRESTRICTED)
    assert document.dumps(graph) == found[1] and not problems(graph)


def test_every_key_is_there() -> None:
    def chapter(title: str) -> set[str]:
        found = re.search(rf"^## {title}\n(.*?)(?=^## |\Z)", PAGE, re.MULTILINE | re.DOTALL)
        assert found, title
        return set(re.findall(r"`(\w+)`", found[1]))

    def keys(record: type[msgspec.Struct]) -> set[str]:
        return set(record.__struct_fields__)

    assert {field.name for field in fields(Settings)} <= chapter("Settings")
    assert keys(records.InputRecord) | keys(records.OutputRecord) <= chapter("Inputs and outputs")
    assert keys(records.NodeRecord) <= chapter("Nodes")
    assert keys(records.GraphRecord) <= set(re.findall(r"`(\w+)`", PAGE.partition("## Settings")[0]))
