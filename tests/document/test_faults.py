"""Bad text: one sentence with file and JSON path, quickly, whatever it holds."""

from __future__ import annotations

import json
import time
import tracemalloc
from pathlib import Path
from random import Random

import pytest
from halation.document import FORMAT, dumps, load, loads
from halation.document.records import _plain  # pyright: ignore[reportPrivateUsage]
from halation.errors import DocumentError, GraphError
from halation.graph import Graph
from halation.resources.sandbox import UNRESTRICTED
from hypothesis import given, settings
from hypothesis import strategies as st
from toy_nodes import TOYS, random_graph, small


@pytest.mark.parametrize(
    ("types", "words"),
    [
        ("str", "a string"),
        ("int | null", "a whole number or null"),
        ("str | Color", "'str | Color'"),
        ("Color", "'Color'"),
    ],
)
def test_types_have_plain_words_where_all_are_known(types: str, words: str) -> None:
    assert _plain(types) == words


def fault(text: str) -> DocumentError:
    with pytest.raises(DocumentError) as caught:
        loads(text, "shot.json", catalogue=TOYS, sandbox=UNRESTRICTED)
    assert "\n" not in str(caught.value)
    assert str(caught.value).startswith("shot.json: ")
    assert caught.value.exit_code == 3
    return caught.value


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "the file is empty"),
        (" \n", "the file is empty"),
        ("{", r"not valid JSON: the text ends too early: .* \(line 1, column 1\)"),
        ('{"halation": 1,\n "x": [1 2]}', r"a comma or a closing bracket is missing after 1 \(line 2, column 8\)"),
        ('{"halation": 1\n "x": 3}', r"a comma or a closing bracket is missing after 1 \(line 1, column 14\)"),
        ('{"a": "soft bloom"\n\n "x": 3}', r'missing after "soft bloom" \(line 1, column 18\)'),
        ('{"a":\n"soft bloom"\n "x": 3}', r'missing after "soft bloom" \(line 2, column 12\)'),
        ('{"a": "' + 38 * "b" + '" "x": 3}', f'is missing after "{38 * "b"}" '),
        ('{"a": "' + 39 * "b" + '" "x": 3}', rf'is missing after \.\.\.{36 * "b"}" '),
        ('{"a": {"b": 1,\n }, "x": 3}', r"there is a comma too many before the '}' \(line 1, column 14\)"),
        ('{"a": [1, 2, ]}', r"there is a comma too many before the ']' \(line 1, column 12\)"),
        ('{"a" 1}', r'a colon is missing after the name "a" \(line 1, column 4\)'),
        ("{a: 1}", r"the name a needs double quotes \(line 1, column 2\)"),
        ("{'a': 1}", r"write names and strings in double quotes \(line 1, column 2\)"),
        ('{"a": True}', r"write true instead of True \(line 1, column 7\)"),
        ('{"a": blur}', r"blur is no value; a text needs double quotes \(line 1, column 7\)"),
        ('{"a": , "b": 1}', r"a value is missing here \(line 1, column 7\)"),
        ('{"a": 1, // the glow\n "b": 1}', r"JSON has no comments: remove this one.* \(line 1, column 10\)"),
        ('{"a": "no end}', r"the closing quote of a string is missing \(line 1, column 7\)"),
        ('{"a": "C:\\path"}', r"write a backslash in a string twice \(line 1, column 10\)"),
        ('{"a": [1, 2', r"the text ends too early: .* \(line 1, column 11\)"),
        ('{"halation": 1} {}', "more text follows the end of the graph"),
        ('{"halation": 1, "a": "\t"}', r"the closing quote of a string is missing \("),
        ("[]", "expected an object, got a list"),
        ("3", "expected an object, got the number 3"),
        ("null", "expected an object, got null"),
        ("{}", '"halation", its format number, is missing'),
        ("[" * 1000 + "]" * 1000, "nest deeper than 64"),
        ("[" * 1_000_000, "nest deeper than 64"),
        ('{"a":' * 100_000, "nest deeper than 64"),
        ('{"halation": 1, "ui": ' + "[" * 64 + "]" * 64 + "}", "nest deeper than 64"),
        ('{"halation": 1, "ui": {"a": ' + "9" * 5000 + "}}", "too many digits"),
    ],
)
def test_text_that_is_no_graph(text: str, says: str) -> None:
    assert fault(text).path == ""
    with pytest.raises(DocumentError, match=says):
        loads(text, sandbox=UNRESTRICTED)


def test_sixty_four_levels_are_fine() -> None:
    text = f'{{"halation": {FORMAT}, "ui": {{"a": ' + "[" * 62 + "]" * 62 + "}}"
    assert json.loads(dumps(loads(text, sandbox=UNRESTRICTED))) == json.loads(text)


@pytest.mark.parametrize(
    ("body", "path", "says"),
    [
        (
            f'"halation": {FORMAT + 1}',
            "halation",
            f"format {FORMAT + 1} is newer than {FORMAT}, the newest known here: update Halation",
        ),
        ('"halation": "1"', "halation", "expected a whole number, got a string"),
        ('"halation": null', "halation", "expected a whole number, got null"),
        ('"halation": 0', "halation", "expected a whole number >= 1"),
        ('"halation": 1.5', "halation", "expected a whole number, got a number"),
        ('"nodes": []', "nodes", "expected an object, got a list"),
        ('"nodes": {"a": 5}', "nodes.a", "expected an object, got a whole number"),
        ('"nodes": {"a": {}}', "nodes.a", "missing required field 'type'"),
        ('"nodes": {"a": {"type": 5}}', "nodes.a.type", "expected a string, got a whole number"),
        ('"nodes": {"a": {"type": "gain", "muted": 1}}', "nodes.a.muted", "expected true or false"),
        ('"nodes": {"a": {"type": "gain", "version": "1"}}', "nodes.a.version", "expected a whole number"),
        ('"nodes": {"a": {"type": "gain", "version": 2}}', "nodes.a.version", "newer than 1.*update Halation"),
        ('"nodes": {"a": {"type": "gain", "values": 1}}', "nodes.a.values", "expected an object"),
        (
            '"nodes": {"a": {"type": "gain", "values": {"gain": "2"}}}',
            "nodes.a.values.gain",
            "expected a number, got the string '2'",
        ),
        ('"nodes": {"a": {"type": "gain", "values": {"gain": true}}}', "nodes.a.values.gain", "got true"),
        ('"nodes": {"a": {"type": "gain", "values": {"gain": null}}}', "nodes.a.values.gain", "got null"),
        (
            '"nodes": {"a": {"type": "gain", "values": {"steps": 1.0}}}',
            "nodes.a.values.steps",
            "expected a whole number, got the number 1.0",
        ),
        (
            '"nodes": {"a": {"type": "gain", "values": {"tint": [1, 2, 3]}}}',
            "nodes.a.values.tint",
            "expected a list of 4 numbers, got a list",
        ),
        ('"nodes": {"a": {"type": "gain", "values": {"tint": [1, 2, 3, "4"]}}}', "nodes.a.values.tint", "4 numbers"),
        ('"nodes": {"a": {"type": "gain", "values": {"mode": 1}}}', "nodes.a.values.mode", "one of add, soft light"),
        ('"nodes": {"a": {"type": "gain", "values": {"gain": NaN}}}', "nodes.a.values.gain", "JSON has no NaN"),
        (
            '"nodes": {"a": {"type": "gain", "values": {"tint": [1, -Infinity, 0, 1]}}}',
            "nodes.a.values.tint[1]",
            "expected a finite number",
        ),
        ('"nodes": {"a": {"type": "gain", "values": {"gain": 1e999}}}', "nodes.a.values.gain", "finite"),
        ('"nodes": {"a": {"type": "gain", "values": {"steps": 1' + "0" * 400 + "}}}", "nodes.a.values.steps", "finite"),
        ('"nodes": {"a": {"type": "gain"}, "a": {"type": "gain"}}', "nodes.a", "this key is there twice"),
        ('"halation": 1', "halation", "this key is there twice"),
        ('"nodes": {"a.b": {"type": "gain"}}', "nodes", "leave out dots"),
        ('"nodes": {"": {"type": "gain"}}', "nodes", "cannot be empty"),
        ('"nodes": {"inputs": {"type": "gain"}}', "nodes", "stands for the ends of the graph"),
        ('"nodes": {"g": {"type": "group"}}', "nodes.g", 'needs either "graph", its body, or "path"'),
        ('"nodes": {"g": {"type": "group", "graph": {}, "path": "x"}}', "nodes.g", "needs either"),
        (
            '"nodes": {"g": {"type": "group", "graph": {"nodes": {"a": {"type": "gain", "values": {"gain": []}}}}}}',
            "nodes.g.graph.nodes.a.values.gain",
            "expected a number, got a list",
        ),
        ('"links": {"a.image": 5}', "links.a.image", "expected a string, got the number 5"),
        ('"links": {"image": "inputs.a"}', "links.image", "'image' is not a socket"),
        ('"links": {"a.b": "inputs"}', "links.a.b", "'inputs' is not a socket"),
        ('"inputs": {"a": {"type": "Mesh"}}', "inputs.a.type", "'Mesh' is no type: write Camera, Color, Field"),
        ('"inputs": {"a": {"type": "Image2"}}', "inputs.a.type", "'Image2' is no type"),
        ('"inputs": {"a": {"default": "red"}}', "inputs.a.default", "expected a number or a list or null"),
        ('"inputs": {"a": {"default": [1, "2"]}}', "inputs.a.default[1]", "expected a number"),
        ('"inputs": {"a/b": {}}', "inputs", "leave out dots, slashes"),
        ('"outputs": {"a": {"layer": 1}}', "outputs.a.layer", "expected a string"),
        ('"controls": {"a": {"target": "x"}}', "controls.a.target", "is not a socket"),
        ('"controls": {"a": {}}', "controls.a", "missing required field 'target'"),
        ('"settings": {"size": [1, 2, 3]}', "settings.size", "length 2"),
        ('"settings": {"size": [0, 2]}', "settings.size[0]", "expected a whole number >= 1"),
        ('"ui": {"a": "\\ud800"}', "ui.a", "not valid Unicode"),
        ('"ui": {"\\ud800": 1}', "ui", "not valid Unicode"),
    ],
)
def test_json_paths(body: str, path: str, says: str) -> None:
    has_format = body.startswith('"halation"') and body != '"halation": 1'
    text = f"{{{body}}}" if has_format else f'{{"halation": {FORMAT}, {body}}}'
    found = fault(text)
    assert found.path == path
    with pytest.raises(DocumentError, match=says):
        loads(text, catalogue=TOYS, sandbox=UNRESTRICTED)


@settings(max_examples=150)
@given(
    st.recursive(
        st.none()
        | st.booleans()
        | st.integers()
        | st.floats(allow_nan=False, allow_infinity=False)
        | st.text(max_size=5),
        lambda inner: (
            st.lists(inner, max_size=3)
            | st.dictionaries(
                st.sampled_from(
                    ["halation", "nodes", "links", "inputs", "a", "type", "values", "graph", "path", "size"]
                ),
                inner | st.sampled_from(["gain", "group", 1]),
                max_size=4,
            )
        ),
        max_leaves=20,
    )
)
def test_no_tree_is_a_traceback(tree: object) -> None:
    document = {**tree, "halation": FORMAT} if isinstance(tree, dict) else tree
    try:
        assert isinstance(loads(json.dumps(document), catalogue=TOYS, sandbox=UNRESTRICTED), Graph)
    except DocumentError as error:
        assert "\n" not in str(error)


@settings(max_examples=150)
@given(st.integers(0, 2**32))
def test_damaged_text_is_a_graph_or_one_sentence(seed: int) -> None:
    """Cut, drop or swap a few characters of a real file."""
    rng = Random(seed)
    text = list(dumps(random_graph(Random(seed % 50), 20)))
    for _ in range(rng.randint(1, 4)):
        place = rng.randrange(len(text) + 1)
        length = rng.choice([0, 1, 1, 5, 500])
        text[place : place + length] = rng.choice(["", "", '"', "}", "{", "[", ",", "0", "e", "NaN", "\x00"])
    try:
        graph = loads("".join(text), catalogue=TOYS, sandbox=UNRESTRICTED)
    except DocumentError as error:
        assert "\n" not in str(error)
        return
    try:
        assert loads(dumps(graph), catalogue=TOYS, sandbox=UNRESTRICTED) == graph
    except GraphError as error:
        pytest.fail(f"loads but does not save: {error}")


def test_a_missing_file(tmp_path: Path) -> None:
    for path, says in (
        (tmp_path / "no.json", "there is no such file"),
        (tmp_path, "this is a folder"),
        (tmp_path / "a\0b", "cannot be read"),
    ):
        with pytest.raises(DocumentError, match=says) as caught:
            load(path, sandbox=UNRESTRICTED)
        assert caught.value.file == str(path)


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (b"", "the file is empty"),
        (b"\xff\xfe{\x00", r"not UTF-8 \(byte 0\)"),
        (b'{"halation": 1, "\xe9": 1}', "not UTF-8"),
        (b"\x89PNG\r\n", "this is a picture, not a graph"),
    ],
)
def test_bytes(tmp_path: Path, data: bytes, says: str) -> None:
    (tmp_path / "x.json").write_bytes(data)
    with pytest.raises(DocumentError, match=f"x.json: .*{says}"):
        load(tmp_path / "x.json", sandbox=UNRESTRICTED)


def test_a_byte_order_mark_is_fine(tmp_path: Path) -> None:
    (tmp_path / "x.json").write_bytes(b"\xef\xbb\xbf" + dumps(small()).replace("\n", "\r\n").encode())
    assert load(tmp_path / "x.json", TOYS, sandbox=UNRESTRICTED) == small()


def test_a_hundred_megabytes_are_refused_unread(tmp_path: Path) -> None:
    path = tmp_path / "huge.json"
    with path.open("wb") as file:
        file.truncate(100 * 2**20)
    tracemalloc.start()
    start = time.thread_time()
    with pytest.raises(DocumentError, match=r"huge\.json: the file has more than 32 MB; that is no graph"):
        load(path, sandbox=UNRESTRICTED)
    assert time.thread_time() - start < 0.1
    assert tracemalloc.get_traced_memory()[1] < 2**20
    tracemalloc.stop()


def test_an_endless_file_is_refused() -> None:
    zero = Path("/dev/zero")
    if not zero.exists():
        pytest.skip("no such device here")
    with pytest.raises(DocumentError, match="is a device"):
        load(zero, sandbox=UNRESTRICTED)


@pytest.mark.parametrize("length", [1, 38, 39, 40, 41, 42, 200])
@pytest.mark.parametrize("head", ['{"x": [', '{"halation": 1,\n"x": ['])
def test_the_word_before_a_missing_comma_is_quoted(head: str, length: int) -> None:
    """As it stands in its own line; of more than 40 letters the last 37."""
    word = "".join(str(at % 10) for at in range(1, length + 1))
    shown = word if length <= 40 else "..." + word[-37:]
    column = len(head.rpartition("\n")[2]) + length
    place = f"(line {1 + head.count(chr(10))}, column {column})"
    assert f"closing bracket is missing after {shown} {place}" in str(fault(f"{head}{word} true]}}"))
