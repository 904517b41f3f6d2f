"""Two parsers read JSON, a fast one and one that explains faults. Python's own module is the reference."""

from __future__ import annotations

import json
from typing import Any

import pytest
from halation.document import syntax
from halation.document.limits import MAX_KEY, MAX_NESTING
from halation.errors import DocumentError
from hypothesis import given, settings
from hypothesis import strategies as st

TEXTS = st.one_of(st.text(max_size=6), st.sampled_from(['":', '\\":', "\\", '"', "k" * (MAX_KEY + 1), "\ud83d", "é"]))
SCALARS = st.one_of(st.none(), st.booleans(), st.integers(), st.integers(10**307, 10**310), st.floats(), TEXTS)


class Pairs(list[tuple[str, Any]]):
    """An object as text may hold it: a key may be there twice."""


OBJECTS = st.recursive(
    SCALARS,
    lambda inner: st.one_of(
        st.lists(inner, max_size=4), st.lists(st.tuples(TEXTS, inner), max_size=4).map(lambda pairs: Pairs(pairs))
    ),
    max_leaves=15,
)


def write(part: Any, spaces: str, is_ascii: bool) -> str:
    """JSON text, which may be no valid JSON: NaN, keys that are there twice, halves of surrogate pairs."""
    if isinstance(part, Pairs):
        entries = (
            f"{json.dumps(key, ensure_ascii=is_ascii)}{spaces}:{write(inner, spaces, is_ascii)}" for key, inner in part
        )
        return f"{{{spaces}{','.join(entries)}}}"
    if isinstance(part, list):
        return f"[{','.join(spaces + write(inner, spaces, is_ascii) for inner in part)}]"
    return json.dumps(part, ensure_ascii=is_ascii)


def find_fault(tree: Any) -> bool:
    """True if a tree of pairs has a key twice, one that is too long, half a surrogate pair, or an infinite number."""
    if isinstance(tree, Pairs):
        keys = [key for key, _ in tree]
        return (
            len({*keys}) < len(keys)
            or any(map(find_fault, (part for pair in tree for part in pair)))
            or any(len(key) > MAX_KEY for key in keys)
        )
    if isinstance(tree, list):
        return any(map(find_fault, tree))
    if isinstance(tree, str):
        return any("\ud800" <= letter <= "\udfff" for letter in tree)
    return isinstance(tree, int | float) and not abs(tree) <= 1.7976931348623157e308


@settings(max_examples=400)
@given(st.lists(st.tuples(TEXTS, OBJECTS), max_size=4), st.sampled_from(["", " ", "\n\t"]), st.booleans())
def test_what_is_read_is_what_json_says(pairs: Any, spaces: str, is_ascii: bool) -> None:
    text = write(Pairs(pairs), spaces, is_ascii)
    try:
        tree = syntax.parse(text, "")
    except DocumentError:
        assert find_fault(Pairs(pairs))
        return
    assert not find_fault(Pairs(pairs))
    assert repr(tree) == repr(json.loads(text))  # by `repr`, since 1 == 1.0 == True


@pytest.mark.parametrize(
    "text",
    [
        '{"a": 1, "a": 1}',
        '{"b": {"a": 1, "a": 2}, "c": ":"}',
        '{"b\\\\": 1, "\\":": 1, "\\":": 1}',
        '{"a": NaN}',
        '{"a": 1e999}',
        '{"a": "\\ud800"}',
        '{"a": 1,}',
        '{"a": "x\ny"}',
        "[1]",
        '{"' + "k" * (MAX_KEY + 1) + '": 1}',
        '{"a":' * (MAX_NESTING + 1) + "1" + "}" * (MAX_NESTING + 1),
    ],
)
def test_faults_are_refused(text: str) -> None:
    with pytest.raises(DocumentError):
        syntax.parse(text, "")
