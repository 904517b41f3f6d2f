"""`examine` refuses what `compile_graph` refuses, in the same words."""

from __future__ import annotations

import pytest
from halation.compiler import Request, compile_graph, examine
from halation.errors import HalationError, InputError
from halation.graph import Graph
from halation.inputs.provider import MediaProvider
from halation.resources.picture import Picture
from halation.resources.provider import PictureProbe
from halation.resources.sandbox import Sandbox
from hypothesis import given, settings
from hypothesis import strategies as st
from random_graphs import SIZE, random_graph


class Outside(MediaProvider):
    """Pictures of one size, or none."""

    def __init__(self, lost: bool) -> None:
        super().__init__(sandbox=Sandbox(""))
        self.lost = lost

    def probe_picture(self, picture: Picture) -> PictureProbe:
        if self.lost:
            raise InputError(f"{picture.path}: there is no such file")
        return PictureProbe(SIZE, False, picture.path)


def said(work, graph: Graph, request: Request, lost: bool) -> tuple[str, str]:
    try:
        work(graph, request, Outside(lost))
    except HalationError as fault:
        return type(fault).__name__, str(fault)
    return "", ""


@settings(max_examples=60)
@given(st.integers(0, 2**32), st.randoms(use_true_random=False), st.booleans())
def test_both_refuse_the_same(seed, rng, lost) -> None:
    graph = random_graph(seed, 5)
    if graph.links and rng.random() < 0.6:
        graph = graph.disconnect(rng.choice(sorted(graph.links)))
    bound = {
        name: Picture(name, "", end.kind, end.socket().channels, in_memory=True)
        for name, end in graph.inputs.items()
        if end.default is None and rng.random() < 0.9
    }
    size = rng.choice((None, (64, 48), (40000, 9)))
    request = Request(bindings=bound, size=size)
    assert said(examine, graph, request, lost) == said(compile_graph, graph, request, lost)


def test_there_is_something_to_refuse() -> None:
    graph = random_graph(1, 5)
    with pytest.raises(HalationError):
        examine(graph, Request(), Outside(False))
