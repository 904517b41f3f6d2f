"""Functions of scripts without what nobody asks for: they do the same for what is asked for, and are shorter."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from typing import Any

import pytest
from halation.export.python.library import Definition, FunctionLibrary, find_uses
from halation.export.python.pruning import AskedChoices, prune

MODES = ("add", "screen", "over", "mix")

TABLE = """TABLE = {
    "add": 1.0,
    "screen": 2.0,
    "over": 3.0,
    "mix": 4.0,
}"""

WEIGH = '''def weigh(mode, x):
    """The weight of a mode."""
    if mode == "add":
        return x + 1.0  # one more
    if mode in ("screen", "over"):
        y = x * 2.0
        return y
    return -x'''

SHOW = """def show(x, mode, clip=False):
    total = TABLE[mode]
    if mode == "add":
        total += 1.0
    elif mode != "over":
        total += 10.0
    else:
        total += 100.0
    if clip:
        total = min(total, 5.0)
    if not clip:
        total -= 0.5
    return weigh(mode, x) + total"""

CHAIN = """def chain(x, mode):
    if mode in ["add", "screen"]:
        x += 1.0
    elif mode == "over":
        x += 2.0
    elif mode == "mix":
        if x > 0.0:
            x += 4.0
        else:
            x += 8.0
    else:
        x += 16.0
    return x"""

OPEN = """def open_ended(x, mode):
    if mode == "add" and x > 0.0:
        return 1.0
    if x > 1.0:
        return 2.0
    return weigh("over", x)"""

TEXTS = {"TABLE": TABLE, "weigh": WEIGH, "show": SHOW, "chain": CHAIN, "open_ended": OPEN}


@pytest.fixture
def library() -> FunctionLibrary:
    definitions = {
        name: Definition(name, text, find_uses(ast.parse(text).body[0]) & {*TEXTS}, (), text.startswith("def"))
        for name, text in TEXTS.items()
    }
    return FunctionLibrary(definitions, {})


def ask(function: str, *modes: str, clip: tuple[bool, ...] = ()) -> AskedChoices:
    switches = {(function, "clip"): frozenset(clip)} if clip else {}
    key = (function, "mode")
    return AskedChoices({key: frozenset(modes)}, {key: frozenset(MODES)}, switches)


def load(texts: Mapping[str, str]) -> dict[str, Any]:
    names: dict[str, Any] = {}
    exec("\n\n".join(texts.values()), names)
    return names


def read(library: FunctionLibrary) -> dict[str, str]:
    return {name: definition.text for name, definition in library.definitions.items()}


@pytest.mark.parametrize("function", ["show", "chain", "open_ended", "weigh"])
@pytest.mark.parametrize(
    "modes", [("add",), ("screen",), ("over",), ("mix",), ("add", "mix"), ("screen", "over"), MODES]
)
def test_what_is_asked_for_stays_the_same(library: FunctionLibrary, function: str, modes: tuple[str, ...]) -> None:
    before, after = load(TEXTS)[function], load(read(prune(library, [function], ask(function, *modes))))[function]
    for x in (-1.0, 0.5, 3.0):
        for mode in modes:
            given = (mode, x) if function == "weigh" else (x, mode)
            assert after(*given) == before(*given)


@pytest.mark.parametrize("clip", [(True,), (False,), (True, False)])
@pytest.mark.parametrize("mode", MODES)
def test_switches_decide_too_with_their_default(library: FunctionLibrary, mode: str, clip: tuple[bool, ...]) -> None:
    text = read(prune(library, ["show"], ask("show", mode, clip=clip)))
    before, after = load(TEXTS)["show"], load(text)["show"]
    for state in {*clip, False}:
        assert after(3.0, mode, state) == before(3.0, mode, state)
    assert ("if not clip" in text["show"]) is (True in clip), "the default may be asked for as well"
    assert ("min(" in text["show"]) is (True in clip)


def test_other_choices_are_gone_and_layout_stays(library: FunctionLibrary) -> None:
    text = read(prune(library, ["show"], ask("show", "add", clip=(False,))))
    assert text["weigh"] == 'def weigh(mode, x):\n    """The weight of a mode."""\n    return x + 1.0  # one more'
    assert text["TABLE"] == 'TABLE = {\n    "add": 1.0,\n}'
    assert text["show"].splitlines() == [
        "def show(x, mode, clip=False):", "    total = TABLE[mode]", "    total += 1.0", "    total -= 0.5",
        "    return weigh(mode, x) + total",
    ]  # fmt: skip
    assert text["chain"] == CHAIN, "nobody asks for it"


@pytest.mark.parametrize(
    ("modes", "lines"),
    [
        (("add",), ["    x += 1.0"]), (("over",), ["    x += 2.0"]),
        (("mix",), ["    if x > 0.0:", "        x += 4.0", "    else:", "        x += 8.0"]),
        (("add", "over"), ['    if mode in ["add", "screen"]:', "        x += 1.0", "    else:", "        x += 2.0"]),
        (("over", "mix"), ['    if mode == "over":', "        x += 2.0", "    else:", "        if x > 0.0:",
                           "            x += 4.0", "        else:", "            x += 8.0"]),
    ],
)  # fmt: skip
def test_chains_keep_the_tests_that_decide(library: FunctionLibrary, modes: tuple[str, ...], lines: list[str]) -> None:
    text = read(prune(library, ["chain"], ask("chain", *modes)))["chain"]
    assert text.splitlines() == ["def chain(x, mode):", *lines, "    return x"]


def test_texts_that_functions_hand_on_are_asked_for(library: FunctionLibrary) -> None:
    text = read(prune(library, ["open_ended"], ask("open_ended", "add")))
    assert text["open_ended"] == OPEN, "what depends on numbers stays"
    assert "y = x * 2.0" in text["weigh"] and "x + 1.0" in text["weigh"] and "-x" not in text["weigh"]


def test_where_all_is_asked_for_nothing_changes(library: FunctionLibrary) -> None:
    assert read(prune(library, ["show", "chain"], AskedChoices({}, {}, {}))) == TEXTS
    both = {("show", "clip"): frozenset({True, False})}
    everything = AskedChoices({("show", "mode"): frozenset(MODES)}, {("show", "mode"): frozenset(MODES)}, both)
    assert read(prune(library, ["show"], everything))["TABLE"] == TABLE
