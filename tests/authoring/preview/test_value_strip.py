"""The strip of a node's main value."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from halation import document
from halation.authoring.background.render_overviews import RenderOverviews
from halation.authoring.preview.value_strip import ValueStrip
from halation.graph import Graph
from halation.graph.graph import Group
from halation.nodes import Node, built_in_nodes
from halation.nodes.channel.combine import Combine
from halation.nodes.color.exposure import Exposure
from halation.nodes.light.ambient_occlusion import AmbientOcclusion
from halation.presets import paths
from halation.reference.node_page import describe_cost, find_main_value, find_users, list_names, list_steps
from halation.renderer import Display, Renderer
from halation.resources.sandbox import UNRESTRICTED


def test_a_strip_shows_the_value_from_low_to_high(renderer: Renderer) -> None:
    """With more exposure no pixel is darker; the ends of the slider are nearly black and nearly white."""
    display = Display(renderer.device)
    strip = ValueStrip(renderer, display)
    strip.want(Exposure)
    while strip.work():
        pass
    value = find_main_value(Exposure)
    assert value is not None and strip.numbers == tuple(list_steps(value))
    assert strip.numbers[0] == value.low and strip.numbers[-1] == value.high
    with renderer.device.make_current():
        pictures = [read(strip, index) for index in range(len(strip.numbers))]
    for darker, brighter in pairwise(pictures):
        assert np.all(brighter >= darker)
    low, middle, high = (pictures[at].mean() for at in (0, len(pictures) // 2, -1))
    assert low < middle < high
    strip.want(Combine)
    assert not strip.work() and not strip.numbers and strip.find(0) is None
    strip.close()
    display.close()


def test_a_strip_waits_for_the_layers_of_its_sample(renderer: Renderer, monkeypatch: pytest.MonkeyPatch) -> None:
    """In the editor another thread reads renders: the strip of a node that needs depth begins before it has."""
    display, overviews = Display(renderer.device), RenderOverviews(UNRESTRICTED)
    monkeypatch.setattr(renderer.pictures, "describer", overviews.describe_render)
    strip = ValueStrip(renderer, display)
    strip.want(AmbientOcclusion)
    while strip.work():
        pass
    assert all(strip.find(index) for index in range(len(strip.numbers))) and strip.numbers
    strip.close()
    display.close()
    overviews.close()


def read(strip: ValueStrip, index: int) -> np.ndarray:
    """The codes of a picture [h, w, 3]."""
    texture = strip.find(index)
    assert texture is not None
    width, height = texture.size
    codes = np.empty((height, width, 4), np.uint8)
    texture.read_into(codes)
    return codes[..., :3].astype(int)


def test_users_are_those_of_the_loaded_presets() -> None:
    users: dict[str, list[str]] = {}
    for path in paths():
        for id in sorted(list_types(document.load(path, sandbox=UNRESTRICTED))):
            users.setdefault(id, []).append(path.stem)
    assert {id: list(names) for id, names in find_users().items()} == users


def list_types(graph: Graph) -> set[str]:
    bodies = [item.graph for item in graph.nodes.values() if isinstance(item, Group)]
    types = {item.id for item in graph.nodes.values() if isinstance(item, Node)}
    return types.union(*map(list_types, bodies))


def test_names_and_costs() -> None:
    nodes = built_in_nodes()
    assert ("Nuke", "Glow") in list_names(nodes["bloom"])
    assert describe_cost(nodes["exposure"]).startswith("With these values 1 pass, and ")
    assert describe_cost(nodes["read_image"]).startswith("No pass: the processor decodes the file")
