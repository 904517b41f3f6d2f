"""Whatever a file holds, it is a graph or a DocumentError."""

from __future__ import annotations

import json
import random
from pathlib import Path

import pytest
from halation import document, presets
from halation.document import FORMAT
from halation.errors import DocumentError
from halation.resources.sandbox import UNRESTRICTED
from hypothesis import given, settings
from hypothesis import strategies as st

KEYS = (
    "halation",
    "nodes",
    "links",
    "inputs",
    "outputs",
    "controls",
    "settings",
    "animation",
    "type",
    "version",
    "values",
    "path",
    "graph",
    "file",
    "code",
    "keys",
    "frame",
    "value",
    "expression",
    "target",
    "bloom",
    "bloom.image",
    "group",
    "inputs.beauty",
    "outputs.image",
    "size",
    "frames",
    "rate",
    "layer",
    "__class__",
    "",
    "..",
    "a/b",
    "\u0000",
    "\ud83d",
)
WORDS = (*KEYS, "Image", "Field", "glsl", "isf", "../../etc/passwd", "=1+", "x" * 2000, "\u202e", "🎬")
NUMBERS = st.one_of(
    st.integers(), st.integers(10**300, 10**301), st.floats(), st.sampled_from([0, -1, 1, 2**63, 1e308, 5e-324])
)
PLAIN = st.one_of(st.none(), st.booleans(), NUMBERS, st.sampled_from(WORDS), st.text(max_size=8))
TREES = st.recursive(
    PLAIN,
    lambda inner: st.one_of(
        st.lists(inner, max_size=4),
        st.dictionaries(st.one_of(st.sampled_from(KEYS), st.text(max_size=4)), inner, max_size=5),
    ),
    max_leaves=25,
)
SAMPLES = tuple(path.read_text() for path in presets.paths())


def survives(text: str) -> None:
    """A graph comes back, which can be written and read again, or a DocumentError that is one line."""
    try:
        graph = document.loads(text, "graph.json", sandbox=UNRESTRICTED)
    except DocumentError as fault:
        assert "\n" not in str(fault) and str(fault).startswith("graph.json")
        return
    assert document.loads(document.dumps(graph), "graph.json", sandbox=UNRESTRICTED) == graph


@given(TREES)
def test_any_json(tree: object) -> None:
    survives(json.dumps(tree))


@given(st.dictionaries(st.sampled_from(KEYS[1:8]), TREES, max_size=6))
def test_anything_in_the_place_of_a_section(sections: dict[str, object]) -> None:
    survives(json.dumps({"halation": FORMAT, **sections}))


@given(st.text())
def test_any_text(text: str) -> None:
    survives(text)


@settings(max_examples=60)
@given(st.sampled_from(SAMPLES), st.randoms(use_true_random=False))
def test_presets_with_parts_exchanged(text: str, draw: random.Random) -> None:
    tree = json.loads(text)
    places: list[tuple[object, object]] = []

    def collect(item: object) -> None:
        pairs = item.items() if isinstance(item, dict) else enumerate(item) if isinstance(item, list) else ()
        for key, inner in pairs:
            places.append((item, key))
            collect(inner)

    collect(tree)
    for holder, key in draw.sample(places, min(3, len(places))):
        other, place = draw.choice(places)
        holder[key] = draw.choice([None, [], {}, -1, 1e30, "", "x", True, other[place]])  # type: ignore[index]
        if draw.random() < 0.3:
            return
    try:
        survives(json.dumps(tree))
    except (ValueError, RecursionError):  # a part was put into itself
        return


@given(st.binary(max_size=200))
def test_any_bytes_in_a_file(tmp_path_factory: pytest.TempPathFactory, data: bytes) -> None:
    path = tmp_path_factory.getbasetemp() / "graph.json"
    path.write_bytes(data)
    with pytest.raises(DocumentError):
        document.load(path, sandbox=UNRESTRICTED)


@pytest.mark.parametrize(
    "text", ["[" * 100_000, '{"a":' * 100_000, "1" * 1_000_000, '"' + "\\u0000" * 10_000, "{" + '"a":1,' * 9]
)
def test_deep_and_long(text: str) -> None:
    with pytest.raises(DocumentError):
        document.loads(text, "graph.json", sandbox=UNRESTRICTED)


@pytest.mark.parametrize("name", ["/dev/null", "/dev/zero", ".", "", "\u0000", "x" * 5000, "\ud800"])
def test_files_that_are_none(tmp_path: Path, name: str) -> None:
    with pytest.raises(DocumentError):
        document.load(tmp_path / name if name not in ("/dev/null", "/dev/zero") else name, sandbox=UNRESTRICTED)
