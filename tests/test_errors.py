"""How sentences name what is at fault."""

from __future__ import annotations

import pytest
from halation.errors import ShaderError, describe_owner


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("glow", "node 'glow'"),
        ("look/glow", "node 'look/glow'"),
        ("inputs.beauty", "input 'beauty'"),
        ("look/inputs.beauty", "input 'look/beauty'"),
        ("outputs.image", "output 'image'"),
        ("halo, edge", "nodes 'halo' and 'edge'"),
        ("a, b/c, d", "nodes 'a', 'b/c' and 'd'"),
    ],
)
def test_an_owner_is_called_what_it_is(path: str, words: str) -> None:
    assert describe_owner(path) == words
    assert str(ShaderError(path, "a.glsl", 3, "error: no")) == f"{words}: a.glsl, line 3: error: no"


def test_a_file_that_no_node_asked_for_stands_alone() -> None:
    assert str(ShaderError("", "a.glsl", 0, "error: no")) == "a.glsl: error: no"
