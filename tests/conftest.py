"""What all tests share: one renderer, and the shortest way from a node to its pixels."""

from __future__ import annotations

import gc
import os
from collections.abc import Callable, Iterator, Mapping

import numpy as np
import pytest
from devices import RendererKeeper, return_memory
from halation.compiler import Precision
from halation.graph import Graph, Input, Output, Port
from halation.nodes import CameraModel, Kind, Node
from halation.renderer import Renderer, RenderRequest
from hypothesis import HealthCheck, settings

pytest_plugins = ["selection", "children", "costs", "failures", "recycling", "skips", "time_limits"]

os.environ["LANGUAGE"] = "en"  # tests name what they see in English, whatever the language of the machine
os.environ["HALATION_PLUGINS"] = "none"  # they are of Halation alone, whatever is installed beside it

# A busy machine is no fault of what is tested: examples may take as long as they take.
UNHURRIED = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("daily", UNHURRIED, max_examples=50)
settings.register_profile("nightly", UNHURRIED, max_examples=500)
settings.load_profile("daily")

BUDGET = 16 * 2**20
"""Bytes of results that the renderer keeps: few pictures of tests are asked for again. With the 512 MiB of the product
a worker takes half a gigabyte more."""

Array = np.ndarray
Run = Callable[..., Array]

_KINDS = {1: Kind.FIELD, 2: Kind.VECTOR, 3: Kind.VECTOR, 4: Kind.IMAGE}


def pytest_configure(config: pytest.Config) -> None:
    """At night more examples are tried, and Mesa's software rasterizer optimizes programs.

    Tests draw small pictures with many programs, and most of their time is the compiler's: without a cache of shaders,
    files of tests of nodes take two thirds of the time. The optimizer keeps to what a program computes, to the bit.
    """
    if config.getoption("--nightly"):
        settings.load_profile("nightly")
    else:
        os.environ.setdefault("GALLIVM_PERF", "nopt")


@pytest.fixture
def compiles_as_for_users(monkeypatch: pytest.MonkeyPatch) -> None:
    """Mesa optimizes programs, as it does for users: for tests of the time and the memory that compiling takes."""
    monkeypatch.delenv("GALLIVM_PERF", raising=False)


def pytest_collection_finish() -> None:
    """What has been collected stays to the end: half a million objects, which each search for garbage would visit.

    A search takes 0.4 s with them, and every file of tests ends with one.
    """
    gc.collect()
    gc.freeze()


def pytest_unconfigure() -> None:
    """Now it may go: nanobind, with which libraries are bound, complains of what is left when Python ends."""
    gc.unfreeze()


@pytest.fixture(scope="module", autouse=True)
def memory() -> Iterator[None]:
    """What the tests of a file have closed is freed at its end."""
    yield
    return_memory()


@pytest.fixture(scope="session")
def renderer_keeper() -> Iterator[RendererKeeper]:
    """Who keeps the renderer of all tests."""
    keeper = RendererKeeper(BUDGET)
    yield keeper
    keeper.close()


@pytest.fixture(scope="module")
def renderer(renderer_keeper: RendererKeeper) -> Renderer:
    """One renderer for the tests of many files, so that they share its programs."""
    return renderer_keeper.find_renderer()


def graph_of(node: Node, inputs: Mapping[str, Array | CameraModel]) -> Graph:
    """A graph of one node with an input for every array or camera; arrays may feed values too."""
    graph = Graph().add("node", node)
    for name, array in inputs.items():
        if isinstance(array, CameraModel):
            graph = graph.add_input(name, Input(Kind.CAMERA, default=array.rows))
            graph = graph.connect(Port("inputs", name), Port("node", name))
            continue
        socket = type(node).inputs.get(name)
        channels = 1 if array.ndim == 2 else array.shape[2]
        if socket is not None:
            kind, width = socket.kind, socket.channels
        else:
            kind, width = _KINDS[channels], channels
        graph = graph.add_input(name, Input(kind, width)).connect(Port("inputs", name), Port("node", name))
    for name, output in type(node).outputs.items():
        kind, width = output.socket.kind, output.socket.channels
        graph = graph.add_output(name, Output(kind, width)).connect(Port("node", name), Port("outputs", name))
    return graph


@pytest.fixture
def run(renderer: Renderer) -> Run:
    """`run(Exposure(stops=1.0), {"image": rgba})` renders a node, or a graph; [h, w, channels] of float32.

    Inputs that take cameras are given one.
    """

    def render(
        subject: Node | Graph,
        inputs: Mapping[str, Array | CameraModel] | None = None,
        *,
        size: tuple[int, int] | None = None,
        output: str = "out",
        scale: float = 1.0,
        precision: Precision = "float",
        engine: Renderer | None = None,
    ) -> Array:
        given = inputs or {}
        cameras = {name: item for name, item in given.items() if isinstance(item, CameraModel)}
        arrays = {name: np.asarray(item, np.float32) for name, item in given.items() if name not in cameras}
        graph = graph_of(subject, arrays | cameras) if isinstance(subject, Node) else subject
        if output not in graph.outputs:
            output = next(iter(graph.outputs))
        engine = engine or renderer
        targets = {output: Port("outputs", output)}
        found = engine.render(graph, RenderRequest(arrays, targets, size, scale, precision=precision))
        return found[output].astype(np.float32)

    return render
