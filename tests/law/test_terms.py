"""One term for one thing: pages and texts of the editor use the word of the house, and none of its twins.

Other programs have other words, which stand where their menus are named: on the pages about them, and among the words
by which the search finds a node. Code is left out.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import MappingProxyType

import pytest
from message_catalogue import list_messages

ROOT = Path(__file__).parents[2]
TWINS: Mapping[str, str] = MappingProxyType(
    {
        "antialiasing": r"anti-aliasing",
        "color": r"colours?",
        "dialog": r"pop-?ups?|modal windows?|dialogue (?:box|window)(?:es|s)?",
        "file name": r"filenames?",
        "folder": r"director(?:y|ies)",
        "graph": r"node ?trees?|node networks?",
        "gray": r"grey(?:s|ish)?",
        "group": r"sub-?graphs?|node groups?",
        "inspector": r"properties panels?|parameter panels?",
        "key": r"key-?frames?",
        "link": r"noodles?|wir(?:e|es|ed|ing) (?:a|the|up|nodes?|sockets?)|connectors?",
        "menu": r"drop-?downs?|pull-?downs?",
        "picture": (
            r"(?:an|any|one|two|both|each|every|these|some|all) images?(?! loads?| intensifiers?)"
            r"|images(?! loads?)|image files?"
        ),
        "plug-in": r"plugins?|add-?ons?",
        "pointer": r"mouse cursors?|mouse pointers?|cursors?",
        "preset": r"graph templates?|template graphs?",
        "proxy": r"(?:low|half|quarter)-?(?: res| resolution) (?:render|picture|preview)s?",
        "socket": r"node (?:pins?|plugs?|jacks?)",
        "switch": r"check ?box(?:es)?|toggle (?:button|switch)(?:es|s)?",
        "tooltip": r"tool tips?|hover texts?",
        "value": r"knobs?|params?|node (?:parameters?|settings?|propert(?:y|ies))",
    }
)
"""The word of the house -> other words for the same thing, as an expression."""

ELSEWHERE = frozenset({"coming-from.md", "node-names.md"})
"""Pages about the words of other programs."""

_NO_PROSE = re.compile(
    r"^Also known as.*?$|```.*?```|<!--.*?-->|`[^`]*`|\]\([^)]*\)|<[^>\n]+>|\{\w+\}|\bdocs/[\w./]+|\b\w+\.md\b",
    re.S | re.M,
)
"""Words for the search, and code, remarks, links, HTML, places in texts and paths."""


def find_twins(text: str) -> Iterator[str]:
    """Each wrong word in a text, with its line and the word to use."""
    prose = _NO_PROSE.sub(lambda part: re.sub(r"[^\n]", " ", part[0]), text)
    for word, twins in TWINS.items():
        for match in re.finditer(rf"\b(?:{twins})\b", prose, re.I):
            if "Image" not in match[0]:  # an Image is a kind of sockets
                line = prose.count("\n", 0, match.start()) + 1
                yield f"line {line}: '{match[0]}' is called '{word}' here"


def list_pages() -> list[Path]:
    """Every page with words of our own."""
    return [ROOT / "README.md", *(path for path in sorted((ROOT / "docs").glob("*.md")) if path.name not in ELSEWHERE)]


def test_pages_use_one_term_for_one_thing() -> None:
    wrong = [f"{path.name} {fault}" for path in list_pages() for fault in find_twins(path.read_text(encoding="utf-8"))]
    assert len(list_pages()) > 20 and not wrong


def test_texts_of_the_editor_use_one_term_for_one_thing() -> None:
    """Titles of nodes are their ids, which stay."""
    texts = {text for message in list_messages() if message.context != "node" for text in message.forms}
    wrong = [f"{text[:80]}: {fault}" for text in sorted(texts) for fault in find_twins(text)]
    assert len(texts) > 1000 and not wrong


@pytest.mark.parametrize("word", TWINS)
def test_the_word_of_the_house_is_used_and_is_no_twin_itself(word: str) -> None:
    assert not list(find_twins(f"{word} {word}s"))
    assert any(re.search(rf"\b{word}", path.read_text(encoding="utf-8")) for path in list_pages())


@pytest.mark.parametrize(
    ("text", "count"),
    [
        ("Drag a wire.\nWire the nodes, and set keyframes.", 2),
        ("Two images, as `images` and [images](images.md).", 2),
        ("An Image, the image, and a wire of copper.", 0),
        ("Also known as colour, grey.", 0),
        ("```\na directory\n```\nA directory.", 1),
    ],
)
def test_twins_are_found_in_prose_only(text: str, count: int) -> None:
    assert len(list(find_twins(text))) == count
