"""Echo against numpy in 64 bits, over noise that is new in every frame."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.time.echo import Echo
from selection import list_cases
from sequences import node_at, noise_at, noise_graph


def over(front: np.ndarray, back: np.ndarray) -> np.ndarray:
    """Porter and Duff 1984."""
    return front + (1 - front[..., 3:]) * back


def expected(mode: str, frames: list[np.ndarray], decay: float) -> np.ndarray:
    fainter = [decay**back * frame for back, frame in enumerate(frames)]
    if mode == "brightest":
        return np.max(fainter, axis=0)
    if mode == "screen":
        return 1 - np.prod([1 - item for item in fainter], axis=0)
    if mode == "average":
        return sum(fainter) / sum(decay**back for back in range(len(frames)))
    if mode == "add":
        total = sum(fainter)
        return np.concatenate([total[..., :3], np.minimum(total[..., 3:], 1)], -1)
    found = fainter[0]
    for item in fainter[1:]:
        found = over(found, item) if mode == "behind" else over(item, found)
    return found


FEW, MANY = ((3, 2, 0.6), (2, -1, 0.5), (1, 3, 1.0)), (20, 1, 0.9)
MODES = ("brightest", "add", "screen", "average", "behind", "in front")
CASES = [(mode, *values) for values in FEW for mode in MODES]


@pytest.mark.parametrize(
    ("mode", "echoes", "spacing", "decay"),
    list_cases([*CASES, ("average", *MANY)], [(mode, *MANY) for mode in MODES if mode != "average"]),
)
def test_echoes_are_earlier_frames(renderer, mode, echoes, spacing, decay):
    graph = noise_graph(Echo(mode=mode, echoes=echoes, spacing=spacing, decay=decay))
    frames = [noise_at(renderer, graph, 4 - back * spacing) for back in range(echoes + 1)]
    assert np.abs(node_at(renderer, graph, 4) - expected(mode, frames, decay)).max() < 1e-5


@pytest.mark.parametrize("values", [{"echoes": 0}, {"spacing": 0}, {"decay": 0.0}])
def test_no_echo_is_the_picture(renderer, values):
    graph = noise_graph(Echo(**values))
    assert np.array_equal(node_at(renderer, graph, 4), noise_at(renderer, graph, 4))


def test_behind_lets_no_echo_shine_through_what_covers(renderer):
    """The noise is opaque: all that is seen is this frame, and in front of it the last whole echo."""
    graph = noise_graph(Echo(mode="behind", decay=1.0))
    assert np.array_equal(node_at(renderer, graph, 4), noise_at(renderer, graph, 4))
    graph = noise_graph(Echo(mode="in front", decay=1.0, echoes=2, spacing=1))
    assert np.array_equal(node_at(renderer, graph, 4), noise_at(renderer, graph, 2))
