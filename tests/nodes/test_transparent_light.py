"""Light where alpha is 0 (flames, glows) goes through every node as light where alpha is 1 does.

Alpha says how much of the background a pixel hides, not how bright it is (Porter and Duff 1984). So a picture without
coverage must not become dark, whatever a node does to colors.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from halation.nodes import Kind, Node, built_in_nodes
from halation.regression.node_promises import can_be_tried, find_changing_values, make_pictures, render_node

CUBE = str(Path(__file__).parents[1] / "data/warm.cube")

COVERED = {
    "premultiply": "multiplies light by alpha: that is what it is for",
    "gradient_map": "replaces the color of surfaces, and where nothing is covered there is no surface",
    "edge_extend": "gives soft pixels the color of solid ones, and where nothing is covered there is none",
    "canny": "draws lines on surfaces",
    "difference_of_gaussians": "draws ink on surfaces",
    "emboss": "draws a relief of surfaces",
    "crosshatch": "draws ink on surfaces",
    "halftone": "draws ink on surfaces",
}
"""Nodes that draw on what is covered, and why."""


def _takes_images(node: type[Node]) -> bool:
    drawn = any(output.socket.kind is Kind.IMAGE for output in node.outputs.values())
    return drawn and can_be_tried(node) and any(socket.kind is Kind.IMAGE for socket in node.inputs.values())


NODES = [node for node in built_in_nodes().values() if _takes_images(node)]


@pytest.mark.parametrize("node", NODES, ids=lambda node: node.id)
def test_light_without_coverage_is_kept(renderer, node):
    pictures = make_pictures(node, (16, 12), np.random.default_rng(1))
    images = [name for name in pictures if node.inputs[name].kind is Kind.IMAGE and not node.inputs[name].single]
    for name in images:
        pictures[name] = pictures[name] + 0.2
    sums = []
    for alpha in (1.0, 0.0):
        for name in images:
            pictures[name][..., 3] = alpha
        out = render_node(renderer, node(**find_changing_values(node, CUBE)), pictures)
        drawn = [out[name] for name, output in node.outputs.items() if output.socket.kind is Kind.IMAGE]
        sums.append([float(np.abs(picture[..., :3]).sum()) for picture in drawn])
    kept = [clear > 0.5 * solid for solid, clear in zip(*sums, strict=True) if solid > 1e-3]
    assert all(kept) != (node.id in COVERED), sums


def test_nodes_that_draw_on_surfaces_exist():
    assert {node.id for node in NODES} >= set(COVERED)
