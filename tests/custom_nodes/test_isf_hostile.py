"""Files that are no shaders, or that mean harm: one sentence each, with a line where there is one."""

from __future__ import annotations

import json
from typing import Any

import pytest
from halation import document
from halation.custom_nodes import CodeFault
from halation.graph import Unknown, problems
from halation.resources.sandbox import UNRESTRICTED
from hypothesis import given
from hypothesis import strategies as some
from isf_files import isf, shader

BODY = "gl_FragColor = vec4(1.0);"
FLOAT = {"NAME": "k", "TYPE": "float"}


def head(text: str) -> str:
    return f"/*{text}*/\nvoid main() {{ {BODY} }}"


@pytest.mark.parametrize(
    ("text", "line", "said"),
    [
        ("", 1, "begins with"),
        ("void main() {}", 1, "begins with"),
        ("/* {", 1, "begins with"),
        (head("not json"), 1, "no JSON"),
        (head('{\n\n"INPUTS": [,]}'), 3, "no JSON"),
        (head("[]"), 1, "object, in braces"),
        (head('{"a": NaN}'), 1, "NaN is not a number"),
        (head("[" * 100_000), 1, "nested too deep"),
        (head('{"a": ' + "9" * 5000 + "}"), 1, "too long"),
        ("/*{}*/", 0, "no GLSL"),
        ("/*{}*/ void other() {}", 0, "void main"),
        ("/*{}*/ // void main() {}", 0, "no GLSL"),
        (isf(BODY, INPUTS={}), 1, "INPUTS must be a list"),
        (isf(BODY, INPUTS=[3]), 1, "not a JSON object"),
        (isf(BODY, {"NAME": "a b", "TYPE": "float"}), 1, "letters, digits"),
        (isf(BODY, {"TYPE": "float"}), 1, "an input"),
        (isf(BODY, {"NAME": "TIME", "TYPE": "float"}), 1, "something else"),
        (isf(BODY, FLOAT, FLOAT), 1, "used twice"),
        (isf(BODY, {"NAME": "k", "TYPE": "matrix"}), 1, "known are"),
        (isf(BODY, {**FLOAT, "DEFAULT": "x"}), 1, "is a number"),
        (isf(BODY, {**FLOAT, "MAX": 1e300}), 1, "is a number"),
        (isf(BODY, {**FLOAT, "MIN": [1, 2]}), 1, "is a number"),
        (isf(BODY, {"NAME": "k", "TYPE": "color", "DEFAULT": [1]}), 1, "list of 4"),
        (isf(BODY, {"NAME": "k", "TYPE": "long", "VALUES": [0.5]}), 1, "whole numbers"),
        (isf(BODY, *[{"NAME": f"k{n}", "TYPE": "float"} for n in range(300)]), 1, "256 are the most"),
        (isf(BODY, PASSES=[{}] * 10_000), 1, "64 are the most"),
        (isf(BODY, PASSES=[{"TARGET": "gl_a"}]), 1, "something else"),
        (isf(BODY, PASSES=[{"TARGET": "a", "WIDTH": "$nothing"}]), 1, "reads 'nothing'"),
        (isf(BODY, PASSES=[{"TARGET": "a", "WIDTH": "1 +"}]), 1, "cannot be read"),
        (isf(BODY, PASSES=[{"TARGET": "a", "WIDTH": [1]}]), 1, "must be a formula"),
        (isf(BODY, FLOAT, PASSES=[{"TARGET": "k"}]), 1, "used twice"),
    ],
)
def test_what_is_no_shader(text: str, line: int, said: str) -> None:
    with pytest.raises(CodeFault, match=said) as found:
        shader(text)
    assert found.value.line == line and "\n" not in found.value.sentence and len(found.value.sentence) < 200


def test_a_fault_of_the_head_is_told_at_its_line() -> None:
    inputs = '[\n  {"NAME": "good", "TYPE": "float"},\n  {"NAME": "bad", "TYPE": "none"}]'
    text = f'/*{{\n "INPUTS": {inputs}}}*/ void main() {{}}'
    with pytest.raises(CodeFault, match="'bad'") as found:
        shader(text)
    assert found.value.line == 4


@pytest.mark.parametrize(
    "path",
    [
        "../a.png",
        "/etc/passwd",
        "a/../../b.png",
        "C:\\a.png",
        "..\\a.png",
        "",
        "\0",
        "file:///a.png",
        ".",
    ],
)
def test_pictures_from_elsewhere_are_refused(path: str) -> None:
    with pytest.raises(CodeFault, match="folder of the shader"):
        shader(isf(BODY, IMPORTED={"a": {"PATH": path}}))


def test_a_bad_file_is_a_problem_of_its_node() -> None:
    graph = document.loads(
        json.dumps({"halation": 1, "nodes": {"a": {"type": "isf", "code": ["/*{", "]*/"]}}}), sandbox=UNRESTRICTED
    )
    assert isinstance(graph.nodes["a"], Unknown)
    assert any("its code, line 2: the head is no JSON" in one.sentence for one in problems(graph))


INNER = ["NAME", "TYPE", "DEFAULT", "MIN", "MAX", "VALUES", "LABELS", "TARGET", "WIDTH", "PATH", "a"]
KEYS = ["INPUTS", "PASSES", "IMPORTED", "PERSISTENT_BUFFERS", "DESCRIPTION", "CREDIT", "CATEGORIES"]
JSON = some.recursive(
    some.one_of(some.none(), some.booleans(), some.integers(), some.floats(), some.text(max_size=8)),
    lambda inner: some.one_of(
        some.lists(inner, max_size=3),
        some.dictionaries(some.sampled_from(INNER), inner),
    ),
    max_leaves=8,
)


@given(some.dictionaries(some.sampled_from(KEYS), JSON))
def test_any_head_makes_a_node_or_a_sentence(raw: dict[str, Any]) -> None:
    text = json.dumps(raw).replace("*/", "")
    try:
        kind = shader(f"/*{text}*/ void main() {{ {BODY} }}")
    except CodeFault as fault:
        assert fault.sentence and fault.line == 1
    else:
        assert kind().setting("light") == "display"
