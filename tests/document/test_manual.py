"""The page about the file says what is true."""

from __future__ import annotations

import re
from dataclasses import fields
from pathlib import Path

import msgspec
import pytest
from halation import document
from halation.document import limits, records
from halation.graph import Settings, problems
from halation.resources.sandbox import UNRESTRICTED

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "format.md").read_text(encoding="utf-8")


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


@pytest.mark.parametrize("name", [name for name, limit in vars(limits).items() if isinstance(limit, int)])
def test_limits_are_those_that_the_manual_states(name: str) -> None:
    page, limit = (DOCS / "security.md").read_text("utf-8"), vars(limits)[name]
    spelled = {f"{limit:,}", *([f"{limit // 2**20} MB"] if limit % 2**20 == 0 else [])}
    assert any(re.search(rf"(?<![\d,.]){text}(?![\d,.]\d)", page) for text in spelled), f"{name}: {limit:,}"
