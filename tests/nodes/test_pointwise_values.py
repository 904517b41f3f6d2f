"""Every value of a pointwise node can be linked: the same as setting it, and finite whatever arrives.

Each value is linked alone with the default choices, and all values together with every other choice.
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
    """The default choices, then every other choice of every value, one at a time."""
    choices = [(value.name, choice) for value in node.values.values() for choice in value.choices]
    return [{}, *({name: choice} for name, choice in choices if choice != node.values[name].default)]


def list_cases() -> Iterator[ParameterSet]:
    """A node, its choices, and the values that are linked."""
    for node in NODES:
        values = [value for value in node.values.values() if value.wireable]
        default, *others = choose(node)
        for value in values:
            yield pytest.param(node, default, [value], id=f"{node.id}.{value.name}")
        for choices in others if values else ():
            yield pytest.param(node, choices, values, id=f"{node.id}-{'-'.join(choices.values())}")


CASES = [*list_cases()]
HEIGHT, WIDTH = 9, 14


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


def linked(value: Value, setting: float | int | bool | tuple[float, ...]) -> np.ndarray:
    """The setting as a picture, in the units in which the node shows it."""
    return np.broadcast_to(np.float32(setting), (HEIGHT, WIDTH, value.length)).copy()


@pytest.mark.parametrize(("node", "choices", "values"), CASES)
def test_linked_values_are_the_set_values(run, node, choices, values):
    settings = {value.name: another(value) for value in values}
    pictures = {value.name: linked(value, settings[value.name]) for value in values}
    for output in node.outputs:
        expected = run(node(**choices, **settings), inputs_of(node), size=(WIDTH, HEIGHT), output=output)
        out = run(node(**choices), inputs_of(node) | pictures, size=(WIDTH, HEIGHT), output=output)
        assert np.abs(out - expected).max() <= 1e-5 * max(1.0, np.abs(expected).max())


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
