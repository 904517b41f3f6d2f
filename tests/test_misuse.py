"""The Python interface with arguments of any kind: nothing but one clear sentence comes of it."""

from __future__ import annotations

import inspect
import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import halation as hal
import numpy as np
import pytest
from halation.graph import Control, Graph, Group, Input, Output, Port, Settings, Unknown
from halation.nodes import Kind
from halation.nodes.color.exposure import Exposure
from halation.nodes.input.shape import Shape
from hypothesis import given, settings
from hypothesis import strategies as st

SMALL = np.full((3, 4, 4), 0.5, np.float32)


def small_graph() -> Graph:
    graph = Graph(inputs={"beauty": Input(Kind.IMAGE)}, outputs={"image": Output()}).add("light", Exposure(stops=1.0))
    graph = graph.connect(Port("inputs", "beauty"), Port("light", "image"))
    return graph.connect(Port("light", "out"), Port("outputs", "image")).add_control(
        "glow", Control(Port("light", "stops"))
    )


class Odd:
    """An object of which every question raises."""

    def __array__(self, *args, **options):
        raise RuntimeError("no array")

    def __index__(self):
        raise RuntimeError("no number")


ODD = [
    None, True, 0, -1, 2**70, 1.5, float("nan"), float("inf"), 1j, "", "light", "light.stops", "a\0b", "\ud800",
    "x" * 5000, b"bytes", (), (1,), (4, 3), ("a", "b"), (0.5, 2.5), [], [[1, 2], [3]], {}, {"light.stops": 1}, {1: 2},
    {"beauty": "no.exr"}, set(), object(), Odd(), int, len, range(3), Path("no.exr"), Path("a\0b"),
    SMALL, SMALL[:0], SMALL[0], SMALL * 1j, SMALL.astype("U"), SMALL.astype(object), np.float32(0.5), np.int64(2),
    np.zeros((2, 2, 9)), np.zeros((1, 1, 1, 1)),
    Graph(), Exposure(), Port("light", "out"), Port("", ""), Input(), Output(), Control(Port("a", "b")), Unknown("x"),
    Group(Graph()), Graph(nodes={"a": 5}), Graph(links={1: 2}), replace(Graph(), settings=Settings(frames=(5, 1))),
]  # fmt: skip
LETTERS = st.characters(exclude_characters="\n\r\v\f\x1c\x1d\x1e\x85\u2028\u2029")
"""A file may have a line break in its name, and then a sentence about it has one too."""
ANYTHING = st.one_of(
    st.sampled_from(ODD),
    st.text(LETTERS, max_size=8),
    st.integers(),
    st.floats(),
    st.lists(st.sampled_from(ODD), max_size=3),
)
KEYWORDS = {
    "render": ("inputs", "values", "node", "size", "scale", "frame", "precision"),
    "render_frames": ("inputs", "frames", "values", "node", "size", "scale", "precision"),
    "write": ("view", "precision", "compression"),
}


def expect_one_sentence(call) -> None:
    try:
        call()
    except hal.HalationError as fault:
        assert str(fault) and "\n" not in str(fault) and len(str(fault)) < 12000


@settings(max_examples=400)
@given(st.sampled_from([*KEYWORDS, "load", "save"]), st.data())
def test_functions_refuse_with_one_sentence(tmp_path_factory, name: str, data) -> None:
    folder = tmp_path_factory.mktemp("misuse")
    draw = lambda usual: data.draw(st.one_of(st.just(usual), ANYTHING))  # noqa: E731
    options = {
        key: data.draw(ANYTHING) for key in data.draw(st.lists(st.sampled_from(KEYWORDS.get(name, ("x",))), max_size=2))
    }
    match name:
        case "load":
            expect_one_sentence(lambda: hal.load(draw("no.json")))
        case "save":
            path = folder / "a.json"
            graph = draw(small_graph())
            expect_one_sentence(lambda: hal.save(graph, path))
            wrong = data.draw(ANYTHING.filter(lambda item: not isinstance(item, str | Path)))
            expect_one_sentence(lambda: hal.save(small_graph(), wrong))
        case "write":
            picture, path = draw(SMALL), folder / data.draw(st.sampled_from(["a.exr", "a.png", "a\0.exr", "a.xyz"]))
            expect_one_sentence(lambda: hal.write(path, picture, **options))
        case _:
            options.setdefault("inputs", {"beauty": draw(SMALL)})
            graph = draw(small_graph())

            def call() -> None:
                rendered = getattr(hal, name)(graph, **options)
                for _ in zip(range(2), rendered, strict=False):  # frames may be endless
                    pass

            expect_one_sentence(call)


METHODS = [
    name
    for name, item in inspect.getmembers(Graph, inspect.isfunction)
    if not name.startswith("_") and len(inspect.signature(item).parameters) > 1
]


@settings(max_examples=600)
@given(st.sampled_from(METHODS), st.data())
def test_methods_of_graphs_refuse_with_one_sentence(name: str, data) -> None:
    graph = small_graph()
    method = getattr(graph, name)
    args = [data.draw(ANYTHING) for _ in inspect.signature(method).parameters]

    def call() -> None:
        after = method(*args)
        if isinstance(after, Graph):  # what an edit accepts can be looked at and saved, or is refused then
            hal.save(after, "/nothing/here.json")

    expect_one_sentence(call)


def test_keys_of_mappings_are_ports() -> None:
    with pytest.raises(hal.HalationError, match=r"Graph\.put_all: plains has the key 'light\.stops'; give a Port"):
        small_graph().put_all({"light.stops": 1.0})  # type: ignore[dict-item]


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"scale": "half"}, "scale: give a number above 0 and up to 1, not 'half'"),
        ({"size": (8.5, 4)}, "size: give whole numbers, not 8.5"),
        ({"frame": "1"}, "frame: give whole numbers, not '1'"),
        ({"frame": 10**30}, "more than 9 digits"),
        ({"inputs": {"beauty": "a\0b.exr"}}, "input 'beauty': 'a\\x00b.exr' is not a path"),
        ({"inputs": {"beauty": SMALL * 1j}}, "give an array of numbers"),
        ({"inputs": {"beauty": SMALL[:0]}}, "input 'beauty': the array is float32 [0, 4, 4]"),
        ({"inputs": {"beauty": [[1, 2], [3]]}}, "give an array of numbers"),
        ({"values": {5: 1}}, "values, 5: give a string, not 5"),
        ({"precision": "double"}, "precision: give 'half' or 'float', not 'double'"),
    ],
)
def test_the_sentence_says_which_argument(options, sentence) -> None:
    with pytest.raises(hal.HalationError) as caught:
        hal.render(small_graph(), **{"inputs": {"beauty": SMALL}, **options})
    assert sentence in str(caught.value)


def test_frames_that_run_backwards_are_a_fault_of_the_graph() -> None:
    graph = replace(small_graph(), settings=Settings(frames=(5, 1)))
    with pytest.raises(hal.HalationError, match="the frames 5 to 1 of the graph run backwards"):
        hal.render(graph, {"beauty": SMALL})


def test_outlines_that_memory_could_not_hold_are_refused() -> None:
    """Tables for 64 million tiles would take 16 GiB before the first pixel."""
    graph = Graph(outputs={"image": Output(Kind.FIELD)}).add("star", Shape(shape="spline"))
    graph = graph.connect(Port("star", "mask"), Port("outputs", "image"))
    with pytest.raises(hal.HalationError, match="node 'star': an outline in 131072x131072 pixels would take too much"):
        hal.render(graph, size=(131_072, 131_072))


def test_any_thread_renders() -> None:
    expected = hal.render(small_graph(), {"beauty": SMALL})["image"]
    with ThreadPoolExecutor(3) as threads:
        pictures = list(threads.map(lambda _: hal.render(small_graph(), {"beauty": SMALL})["image"], range(9)))
    assert all(np.array_equal(picture, expected) for picture in pictures)
    assert np.array_equal(hal.render(small_graph(), {"beauty": SMALL})["image"], expected)


def test_a_function_that_is_bound_may_render_too() -> None:
    def make(frame: int) -> np.ndarray:
        return hal.render(small_graph(), {"beauty": SMALL * frame})["image"]

    def render() -> float:
        frames = dict(hal.render_frames(small_graph(), {"beauty": make}, [1, 2]))
        return float(frames[2]["image"][0, 0, 0])

    with ThreadPoolExecutor(1) as threads:
        assert render() == threads.submit(render).result(60) == 4.0


def test_twenty_threads_render_pictures_of_their_own() -> None:
    """Each has another value and another size, so that nothing is shared but the renderer."""

    def render(number: int) -> tuple[float, tuple[int, ...]]:
        picture = np.full((4 + number, 6, 4), 1.0 + number, np.float32)
        image = hal.render(small_graph(), {"beauty": picture}, values={"light.stops": float(number % 3)})["image"]
        return float(image[1, 2, 0]), image.shape

    with ThreadPoolExecutor(20) as threads:
        pictures = list(threads.map(render, range(100)))
    assert pictures == [((1.0 + number) * 2.0 ** (number % 3), (4 + number, 6, 4)) for number in range(100)]


def test_frames_go_from_thread_to_thread() -> None:
    with ThreadPoolExecutor(1) as one, ThreadPoolExecutor(1) as another:
        rendered = hal.render_frames(small_graph(), {"beauty": SMALL}, range(1, 5))
        frames = [threads.submit(next, rendered).result(60)[0] for threads in (one, another)]
        frames.append(next(rendered)[0])
    assert frames == [1, 2, 3]
    rendered = hal.render_frames(small_graph(), {"beauty": SMALL}, range(1, 5))
    next(rendered)
    with ThreadPoolExecutor(1) as threads, pytest.raises(hal.HalationError, match="render the others there too"):
        threads.submit(next, rendered).result(60)


def test_threads_that_end_leave_nothing_behind() -> None:
    before = None
    for number in range(12):
        thread = threading.Thread(target=hal.render, args=(small_graph(), {"beauty": SMALL}))
        thread.start()
        thread.join()
        before = before or threading.active_count()
        assert threading.active_count() <= before, number
