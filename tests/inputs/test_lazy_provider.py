"""The provider of graphs that may read no file answers as the one that reads them."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from halation.errors import InputError
from halation.graph import Graph, Input, Keys, Port, Settings
from halation.graph.keys import Key
from halation.inputs.lazy_provider import LazyResourceProvider
from halation.inputs.provider import MediaProvider
from halation.nodes import catalogue
from halation.resources.sandbox import UNRESTRICTED

PROVIDERS = [LazyResourceProvider, MediaProvider]
MOVING = Graph(
    {"light": catalogue()["exposure"]()}, animation={Port("light", "stops"): Keys((Key(3.0, 0.0), Key(7.0, 1.0)))}
)


def sequence(folder: Path) -> Graph:
    """A graph that reads frames 2 to 4 of a sequence of which frame 5 is missing and frame 6 is there."""
    for frame in (2, 3, 4, 6):
        cv2.imwrite(str(folder / f"a.{frame:04}.png"), np.full((2, 3, 3), frame, np.uint8))
    return Graph(inputs={"a": Input(file=str(folder / "a.####.png"))})


@pytest.mark.parametrize("make", PROVIDERS)
def test_a_missing_file_of_a_sequence_is_found(tmp_path: Path, make: type) -> None:
    graph, provider = sequence(tmp_path), make(sandbox=UNRESTRICTED)
    provider.check_frames(graph, range(2, 5))
    with pytest.raises(InputError, match=r"a\.0005\.png"):
        provider.check_frames(graph, range(2, 7))
    provider.check_frames(MOVING, range(100))


@pytest.mark.parametrize("make", PROVIDERS)
def test_frames_are_those_of_settings_files_or_keys(tmp_path: Path, make: type) -> None:
    graph, provider = sequence(tmp_path), make(sandbox=UNRESTRICTED)
    assert provider.find_frames(graph, {}) == (2, 6)
    assert provider.find_frames(MOVING, {}) == (1, 7)
    assert provider.find_frames(Graph(settings=Settings(frames=(8, 9)), inputs=graph.inputs), {}) == (8, 9)


def test_no_file_is_read_where_none_is_named() -> None:
    provider = LazyResourceProvider(sandbox=UNRESTRICTED)
    assert provider.bind(MOVING, {}) == {} and provider.find_frames(MOVING, {}) == (1, 7)
    provider.check_frames(MOVING, range(9))
    assert "pictures" not in vars(provider)
