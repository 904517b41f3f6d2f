"""What a graph, its notes and its file are called is text in what is exported, never markup or code."""

from __future__ import annotations

import json
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

PAYLOAD = "*/ --></script></title><script>alert(1)</script><img src=x onerror=alert(1)>\n\"'`${alert(1)}\u2028\\"
NAME = "n<script>alert(1)-->\"' `id`"


class Outline(HTMLParser):
    """The elements of a page, and the attributes that run code."""

    def __init__(self) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.handlers: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.handlers += [f"{tag} {name}" for name, _ in attrs if name.startswith("on")]


def read_outline(path: Path) -> tuple[list[str], list[str]]:
    outline = Outline()
    outline.feed(path.read_text("utf-8"))
    return outline.tags, outline.handlers


@pytest.fixture
def exported(cli, graphs, tmp_path: Path):
    def run(label: str, doc: str, node: str, name: str, ending: str) -> Path:
        nodes = {node: {"type": "noise"}, "e": {"type": "exposure"}}
        parts = {
            "nodes": nodes,
            "links": {"e.image": f"{node}.out", "outputs.image": "e.out"},
            "controls": {node: {"target": "e.stops", "label": label, "doc": doc}},
            "ui": {"about": {"doc": doc, "tags": [label]}, "notes": {"a": {"text": doc}}},
            "inputs": {},
        }
        source = tmp_path / f"{name}.json"
        document = {"halation": 1, "settings": {"size": [16, 16]}, "outputs": {"image": {"type": "Image"}}, **parts}
        source.write_text(json.dumps(document), "utf-8")
        target = tmp_path / f"{node.isalpha()}{ending}"
        result = cli("export", source, "-o", target)
        assert result.code == 0, result.err
        return target

    return run


def test_a_page_has_the_elements_of_any_other_page(exported) -> None:
    plain = read_outline(exported("Stops", "About it.", "n", "plain", ".html"))
    assert read_outline(exported(PAYLOAD, PAYLOAD, NAME, "a<img src=x onerror=alert(1)>", ".html")) == plain


def test_a_description_is_no_template(exported) -> None:
    plain = exported("Stops", "About it.", "n", "plain", ".html").read_text("utf-8")
    page = exported("Stops", "/*SCRIPT*/ /*PACKAGE*/", NAME, "plain", ".html").read_text("utf-8")
    assert "/*SCRIPT*/ /*PACKAGE*/" in page and abs(len(page) - len(plain)) < 500


def test_the_head_of_a_shader_ends_where_it_should(exported) -> None:
    text = exported(PAYLOAD, PAYLOAD, NAME, "plain", ".fs").read_text("utf-8")
    head, _, code = text.partition("*/")
    (knob,) = json.loads(head.removeprefix("/*"))["INPUTS"]
    assert knob["LABEL"] == PAYLOAD and re.fullmatch(r"\w+", knob["NAME"])
    assert "alert" not in code.replace(knob["NAME"], "")
