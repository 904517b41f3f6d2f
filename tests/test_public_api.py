"""The public face: names that stay, and what they do to arrays and files."""

from __future__ import annotations

import inspect
from dataclasses import replace
from importlib.metadata import version

import halation as hal
import numpy as np
import pytest
from exr_files import header, read
from halation import errors
from halation.graph import Graph, Input, Output, Port, Settings
from halation.nodes import Kind
from halation.nodes.color.exposure import Exposure
from halation.nodes.time.frame_blend import FrameBlend

PICTURE = np.random.default_rng(7).random((12, 20, 4), np.float32)
PICTURE[..., 3] = 1.0


@pytest.fixture
def graph() -> Graph:
    """beauty -> light -> image, with the control `glow`, and a field that passes through."""
    made = Graph(
        inputs={"beauty": Input(Kind.IMAGE), "depth": Input(Kind.FIELD, default=0.5)}, outputs={"image": Output()}
    ).add("light", Exposure(stops=1.0))
    made = made.connect(Port("inputs", "beauty"), Port("light", "image"))
    return made.connect(Port("light", "out"), Port("outputs", "image"))


def test_names_are_frozen():
    """A name here is a promise: add to the list, never take away."""
    assert hal.__all__ == [
        "Graph", "HalationError", "__version__", "connect", "load", "render", "render_frames", "save", "write",
    ]  # fmt: skip
    assert hal.Graph is Graph and hal.__version__ == version("halation")
    assert {name: str(inspect.signature(getattr(hal, name))).split(" -> ")[0] for name in hal.__all__[3:]} == {
        "connect": "(socket: 'str | Path | None' = None)",
        "load": "(path: 'str | Path')",
        "render": "(graph: 'Graph', inputs: 'Mapping[str, Binding] | None' = None, *, "
        "values: 'Mapping[str, Any] | None' = None, node: 'str' = '', size: 'tuple[int, int] | None' = None, "
        "scale: 'float' = 1.0, frame: 'int | None' = None, precision: 'Precision | None' = None)",
        "render_frames": "(graph: 'Graph', "
        "inputs: 'Mapping[str, Binding | Callable[[int], Binding]] | None' = None, "
        "frames: 'Iterable[int] | None' = None, *, values: 'Mapping[str, Any] | None' = None, "
        "node: 'str' = '', size: 'tuple[int, int] | None' = None, scale: 'float' = 1.0, "
        "precision: 'Precision | None' = None)",
        "save": "(graph: 'Graph', path: 'str | Path')",
        "write": "(path: 'str | Path', picture: 'np.ndarray', *, view: 'str' = '', precision: 'Precision' = 'half', "
        "compression: 'str' = 'zip', dither: 'Dither' = 'blue', frame: 'int' = 1)",
    }
    for name in hal.__all__:
        assert inspect.getdoc(getattr(hal, name)), name


def test_every_error_is_a_halation_error_with_its_exit_code():
    classes = {name: item for name, item in vars(errors).items() if isinstance(item, type)}
    assert {name: item.exit_code for name, item in classes.items()} == {
        "HalationError": 1,
        "UsageError": 2,
        "GraphError": 3,
        "DocumentError": 3,
        "InputError": 4,
        "NoFileError": 4,
        "DeviceError": 5,
        "ShaderError": 5,
        "RenderError": 1,
        "OutputError": 1,
    }
    assert all(issubclass(item, hal.HalationError) for item in classes.values())


def test_arrays_in_arrays_out(graph):
    for _ in range(2):
        pictures = hal.render(graph, {"beauty": PICTURE}, precision="float")
        assert list(pictures) == ["image"] and pictures["image"].dtype == np.float32
        np.testing.assert_allclose(pictures["image"], PICTURE * (2, 2, 2, 1), rtol=1e-6)


def test_arrays_of_other_shapes_and_types(graph):
    grey = np.float64(PICTURE[..., 0])
    found = hal.render(graph, {"beauty": grey}, precision="float")["image"]
    np.testing.assert_allclose(found[..., 2], 2.0 * grey, rtol=1e-6)
    assert (found[..., 3] == 1.0).all()
    flipped = PICTURE[::-1, ::2, :3].astype(np.float16)
    found = hal.render(graph, {"beauty": flipped}, precision="float")["image"]
    np.testing.assert_allclose(found[..., :3], 2.0 * flipped.astype(np.float32), rtol=1e-3)


def test_values_node_size_scale_precision(graph):
    found = hal.render(graph, {"beauty": PICTURE}, values={"light.stops": 3.0}, precision="float")["image"]
    np.testing.assert_allclose(found[..., 0], 8.0 * PICTURE[..., 0], rtol=1e-6)
    assert hal.render(graph, {"beauty": PICTURE}, node="light")["light"].shape == (12, 20, 4)
    assert hal.render(graph, {"beauty": PICTURE}, size=(9, 7))["image"].shape == (7, 9, 4)
    assert hal.render(graph, {"beauty": PICTURE}, scale=0.5)["image"].shape == (6, 10, 4)
    assert hal.render(graph, {"beauty": PICTURE}, precision="half")["image"].dtype == np.float16
    assert graph.nodes["light"].stops == 1.0


def test_load_render_write_save(graph, tmp_path):
    shot, out, mine = tmp_path / "shot.exr", tmp_path / "out.exr", tmp_path / "mine.json"
    hal.write(shot, PICTURE, precision="float", compression="piz")
    np.testing.assert_array_equal(read(shot), PICTURE)
    assert header(shot).get_string_attribute("compression") == "piz"
    hal.save(graph, mine)
    again = hal.load(mine)
    assert again == graph
    for bound in (shot, str(shot), f"{shot}:rgba"):
        pictures = hal.render(again, {"beauty": bound})
        np.testing.assert_allclose(pictures["image"], PICTURE * (2, 2, 2, 1), rtol=2e-3)
    hal.write(out, pictures["image"])
    assert str(header(out).format) == "half"


def test_write_shows_through_a_view(tmp_path):
    picture = np.full((4, 4, 3), 0.5)
    hal.write(tmp_path / "a.png", picture, view="none", dither="none")
    assert round(float(read(tmp_path / "a.png")[0, 0, 0]) * 255) == round((1.055 * 0.5 ** (1 / 2.4) - 0.055) * 255)
    hal.write(tmp_path / "b.exr", picture[..., :2])
    hal.write(tmp_path / "c.exr", picture[..., 0])
    assert (header(tmp_path / "b.exr").channelnames, header(tmp_path / "c.exr").channelnames) == (("X", "Y"), ("Y",))


@pytest.mark.parametrize(
    ("call", "error", "sentence"),
    [
        (lambda graph: hal.load("no.json"), errors.DocumentError, "no.json: there is no such file"),
        (lambda graph: hal.save(graph, "/no/such/folder/a.json"), errors.OutputError, "/no/such/folder/a.json: "),
        (lambda graph: hal.render(graph), errors.GraphError, "'beauty'"),
        (lambda graph: hal.render(graph, {"beuaty": PICTURE}), errors.UsageError, "no input 'beuaty'"),
        (lambda graph: hal.render(graph, {"beauty": "no.exr"}), errors.InputError, "no.exr: there is no such file"),
        (lambda graph: hal.render(graph, {"beauty": PICTURE[0, 0]}), errors.UsageError, r"float32 \[4\]"),
        (lambda graph: hal.render(graph, {"beauty": PICTURE[:0]}), errors.UsageError, r"float32 \[0, 20, 4\]"),
        (lambda graph: hal.render(graph, values={"light.stosp": 1}), errors.GraphError, "did you mean 'stops'?"),
        (lambda graph: hal.render(graph, values={"light.stops": "much"}), errors.GraphError, "light.stops: 'much'"),
        (lambda graph: hal.render(graph, node="lihgt"), errors.GraphError, "did you mean 'light'?"),
        (lambda graph: hal.render(graph, scale=2.0), errors.UsageError, "scale 2"),
        (lambda graph: hal.render(graph, size=(0, 4)), errors.UsageError, "size 0x4"),
        (lambda graph: hal.write("a.xyz", PICTURE), errors.UsageError, "cannot write '.xyz' files"),
        (lambda graph: hal.write("a.exr", PICTURE[0, 0]), errors.UsageError, r"a.exr: the array is \[4\]"),
        (lambda graph: hal.write("a.png", PICTURE, view="filmc"), errors.UsageError, "there is no view 'filmc'"),
    ],
)
def test_every_fault_is_one_sentence(graph, tmp_path, monkeypatch, call, error, sentence):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(error, match=sentence) as caught:
        call(graph)
    assert type(caught.value) is error and "\n" not in str(caught.value) and not list(tmp_path.iterdir())


def test_frames_are_made_of_functions_and_remembered(graph):
    """Exponential blending of what a function makes for a frame, against its closed form."""
    graph = graph.set(Port("light", "stops"), 0.0).add("trail", FrameBlend(mode="persistence", persistence=0.5))
    graph = replace(graph, settings=Settings(frames=(1, 4)))
    graph = graph.connect(Port("light", "out"), Port("trail", "image"))
    graph = graph.connect(Port("trail", "out"), Port("outputs", "image"))
    found = dict(hal.render_frames(graph, {"beauty": lambda frame: np.full((2, 3, 4), float(frame), np.float32)}))
    assert [float(found[frame]["image"][0, 0, 0]) for frame in found] == [1.0, 1.5, 2.25, 3.125]
    last = hal.render(graph, {"beauty": np.full((2, 3, 4), 4.0, np.float32)}, frame=4)
    assert last["image"][0, 0, 0] == 4.0
