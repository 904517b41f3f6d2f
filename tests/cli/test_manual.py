"""`halation nodes --markdown`: one page that says all, whatever characters it takes."""

from __future__ import annotations

import inspect
import re

import pytest
from halation.cli import manual
from halation.nodes import built_in_nodes
from markdown_it import MarkdownIt
from markdown_it.token import Token

NODES = built_in_nodes()


@pytest.fixture(scope="module")
def page() -> str:
    return manual.catalogue_page(list(NODES.values()))


@pytest.fixture(scope="module")
def tokens(page: str) -> list[Token]:
    """As an independent reader of Markdown understands it, without its leave to see HTML."""
    return MarkdownIt("commonmark").enable("table").parse(page)


def text_of(token: Token) -> str:
    """What a person reads."""
    return "".join(" " if child.type == "softbreak" else child.content for child in token.children or ())


def tables(tokens: list[Token]) -> list[list[list[str]]]:
    found: list[list[list[str]]] = []
    for index, token in enumerate(tokens):
        if token.type == "table_open":
            found.append([])
        elif token.type == "tr_open":
            found[-1].append([])
        elif token.type in ("th_open", "td_open"):
            found[-1][-1].append(text_of(tokens[index + 1]))
    return found


def section(page: str, id: str) -> str:
    return re.split(r"^##", page.split(f"\n### {id}\n")[1], maxsplit=1, flags=re.M)[0]


def test_the_command_prints_it(cli, page):
    result = cli("nodes", "--markdown")
    assert (result.code, result.out, result.err) == (0, page, "")
    for words in (("bloom", "--markdown"), ("--markdown", "--json")):
        assert cli("nodes", *words).code == 2


def test_every_menu_has_a_heading_and_every_node_a_section(tokens):
    heads = [at for at, token in enumerate(tokens) if token.type == "heading_open"]
    headings = [(tokens[at].tag, text_of(tokens[at + 1])) for at in heads]
    expected: list[tuple[str, str]] = [("h1", "Nodes")]
    for category in dict.fromkeys(node.category for node in NODES.values()):
        menu = [id for id, node in NODES.items() if node.category == category]
        expected += [("h2", f"{category.capitalize()} ({len(menu)})"), *(("h3", id) for id in menu)]
    assert headings == expected


def test_links_lead_to_headings(page, tokens):
    anchors = [re.sub(r"[^\w-]", "", line.lower().replace(" ", "-")) for line in re.findall(r"^#+ (.*)$", page, re.M)]
    links = [str(child.attrs["href"]) for one in tokens for child in one.children or () if child.type == "link_open"]
    assert len(anchors) == len(set(anchors)) and {*links} == {f"#{anchor}" for anchor in anchors[1:]}


def test_tables_are_whole(tokens):
    """A stray bar would add a cell, which readers of Markdown drop."""
    made = tables(tokens)
    assert {tuple(one[0]) for one in made} == {
        ("node", "what it does", "inputs", "outputs"),
        ("input", "type", ""),
        ("output", "type", ""),
        ("value", "type", "default", "range", "limits", "unit", ""),
    }
    menus = [row for one in made if one[0][0] == "node" for row in one[1:]]
    assert [row[0] for row in menus] == [*NODES]
    for id, does, inputs, outputs in menus:
        assert does == inspect.getdoc(NODES[id]).splitlines()[0].replace("`", "")
        for text, names in ((inputs, NODES[id].inputs), (outputs, NODES[id].outputs)):
            assert [part.split()[0] for part in text.split(", ") if part] == [*names]


def test_only_tables_paragraphs_and_headings(tokens):
    """No word of a docstring is taken for a list, a quotation, code, emphasis or HTML."""
    blocks = {token.type.removesuffix("_open").removesuffix("_close") for token in tokens}
    assert blocks == {"heading", "paragraph", "inline", "table", "thead", "tbody", "tr", "th", "td"}
    inside = {child.type for token in tokens for child in token.children or ()}
    assert inside <= {"text", "text_special", "code_inline", "link_open", "link_close", "softbreak"}


@pytest.mark.parametrize("id", NODES)
def test_a_section_says_everything_as_it_was_written(page, id):
    node, tokens = NODES[id], MarkdownIt("commonmark").enable("table").parse(section(page, id))
    said = [text_of(tokens[at + 1]) for at, one in enumerate(tokens) if one.type == "paragraph_open"]
    wanted = [" ".join(part.split()).replace("`", "") for part in inspect.getdoc(node).split("\n\n")]
    assert said[: len(wanted)] == wanted
    rows = {row[0]: row for one in tables(tokens) if one[0][0] == "value" for row in one[1:]}
    values = {name: value for name, value in node.values.items() if not value.folded}
    assert [*rows] == [*values]
    for name, value in values.items():
        _, kind, _, soft, hard, unit, note = rows[name]
        assert (kind, unit) == (value.type, value.unit or "")
        assert note.endswith(" ".join(value.doc.replace("`", "").split()))
        assert all(choice in note for choice in value.choices)
        if value.unit:
            assert soft == f"{value.low:g} .. {value.high:g}"
            assert [float(part) for part in re.findall(r"at (?:least|most) (\S+?)(?:,|$)", hard)] == [
                pytest.approx(limit) for limit in (value.minimum, value.maximum) if abs(limit) != float("inf")
            ]
