"""Every value of a pointwise node can be linked: the same as setting it, and finite whatever arrives.

All values are linked together with every choice, in one program; every night each also alone, with the default choices.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator

import numpy as np
import pytest
from _pytest.mark import ParameterSet
from halation.nodes import Kind, Node, Pointwise, Value, catalogue

NODES = [node for node in catalogue().values() if issubclass(node, Pointwise)]


def choose(node: type[Node]) -> list[dict[str, str]]:
    """The default choices, then every other one, one at a time, with which it is drawn pixel by pixel."""
    choices = [(value.name, choice) for value in node.values.values() for choice in value.choices]
    changed = [{name: choice} for name, choice in choices if choice != node.values[name].default]
    return [{}, *(values for values in changed if not node(**values).takes_passes())]


def list_cases() -> Iterator[ParameterSet]:
    """A node, its choices, and the values that are linked."""
    for node in NODES:
        values = [value for value in node.values.values() if value.wireable]
        for choices in choose(node) if values else ():
            yield pytest.param(node, choices, values, id="-".join([node.id, *choices.values()]))
        for value in values if len(values) > 1 else ():
            yield pytest.param(node, {}, [value], id=f"{node.id}.{value.name}", marks=pytest.mark.nightly)


CASES = [*list_cases()]
HEIGHT, WIDTH = 15, 26


def inputs_of(node: type[Node]) -> dict[str, np.ndarray]:
    """Random pixels for every socket, the same at each call."""
    random = np.random.default_rng(zlib.crc32(node.id.encode()))
    found: dict[str, np.ndarray] = {}
    for name, socket in node.inputs.items():
        shape = (1, 1) if socket.single else (HEIGHT, WIDTH)
        found[name] = random.uniform(0.05, 1.5, (*shape, socket.channels)).astype(np.float32)
        if socket.kind is Kind.IMAGE:
            found[name][..., 3] = found[name][..., 3] / 1.5
    return found


def another(value: Value) -> float | int | bool | tuple[float, ...]:
    """A value that is not the default, within its slider, in whole numbers where it counts."""
    if value.type == "bool":
        return not value.default
    if value.type in ("float", "int"):
        low, high = max(value.low, -100.0), min(value.high, 100.0)
        found = low + max(high - low, 0.0) * 0.75
        return round(found) if value.type == "int" else found
    return tuple(0.3 + 0.2 * index for index in range(value.length))


def list_changes(choices: dict[str, str], values: list[Value]) -> list[list[Value]]:
    """Which values are changed at a time: all of them, and with the default choices each one too."""
    return [values, *([value] for value in values if not choices and len(values) > 1)]


def linked(value: Value, changes: list[list[Value]]) -> np.ndarray:
    """A value as a picture, in the units in which the node shows it: by pixel the next of `changes`."""
    number = np.arange(HEIGHT * WIDTH).reshape(HEIGHT, WIDTH, 1) % len(changes)
    is_changed = np.isin(number, [index for index, changed in enumerate(changes) if value in changed])
    return np.where(is_changed, np.float32(another(value)), np.float32(value.default)) * np.ones(
        value.length, np.float32
    )


@pytest.mark.parametrize(("node", "choices", "values"), CASES)
def test_linked_values_are_the_set_values(run, node, choices, values):
    changes = list_changes(choices, values)
    pictures = {value.name: linked(value, changes) for value in values}
    for output in node.outputs:
        out = run(node(**choices), inputs_of(node) | pictures, size=(WIDTH, HEIGHT), output=output)
        for number, changed in enumerate(changes):
            specimen = node(**choices, **{value.name: another(value) for value in changed})
            expected = run(specimen, inputs_of(node), size=(WIDTH, HEIGHT), output=output)
            difference = np.abs(out - expected).reshape(HEIGHT * WIDTH, -1)[number :: len(changes)]
            assert difference.max() <= 1e-5 * max(1.0, np.abs(expected).max()), [value.name for value in changed]


@pytest.mark.parametrize(("node", "choices", "values"), CASES)
def test_whatever_is_linked_the_picture_is_finite(run, node, choices, values):
    rough = np.array([np.nan, np.inf, -np.inf, 0.0, -0.0, -1.0, 1e30, -1e30, 1e-30, 0.5, 2.0], np.float32)
    pictures = {
        value.name: np.resize(np.roll(rough, 3 * number), (HEIGHT, WIDTH, value.length)).copy()
        for number, value in enumerate(values)
    }
    for output in node.outputs:
        out = run(node(**choices), inputs_of(node) | pictures, size=(WIDTH, HEIGHT), output=output)
        assert np.isfinite(out).all()


@pytest.mark.parametrize("node", NODES, ids=lambda node: node.id)
def test_whatever_the_picture_holds_the_result_is_finite(run, node):
    rough = np.array([np.nan, np.inf, -np.inf, 0.0, -0.0, -3.0, 1e30, -1e30, 1e-30, 65504.0, 0.5], np.float32)
    inputs = inputs_of(node)
    for number, (name, socket) in enumerate(node.inputs.items()):
        inputs[name] = np.resize(np.roll(rough, number), (*inputs[name].shape[:2], socket.channels)).copy()
    changed = {value.name: another(value) for value in node.values.values() if value.wireable}
    for choices in choose(node):
        specimen = node(**changed, **choices)
        for output in node.outputs if specimen.identity() is None else ():  # a neutral node is not there at all
            assert np.isfinite(run(specimen, inputs, size=(WIDTH, HEIGHT), output=output)).all(), choices
