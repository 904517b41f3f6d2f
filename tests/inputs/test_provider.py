"""Pictures bound to inputs: arrays, files, and the layers that follow their file."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import OpenImageIO as oiio
import pytest
from halation import media
from halation.errors import InputError, UsageError
from halation.graph import Graph, Input
from halation.inputs.provider import MediaProvider
from halation.nodes import Kind
from halation.resources.sandbox import UNRESTRICTED
from house_config import write_house

GRAPH = Graph(
    inputs={
        "beauty": Input(Kind.IMAGE, file="sample.exr", layer="Combined"),
        "depth": Input(Kind.FIELD, file="sample.exr", layer="Depth"),
        "dirt": Input(Kind.IMAGE, file="dirt.png"),
    }
)


def written(folder, **layers):
    path = folder / "shot.exr"
    kinds = {name: Kind.IMAGE if array.ndim == 3 else Kind.FIELD for name, array in layers.items()}
    media.write_picture(path, layers, kinds=kinds, sandbox=UNRESTRICTED)
    return path


def test_a_layer_follows_its_file(tmp_path):
    path = written(tmp_path, Combined=np.ones((4, 6, 4), np.float32), Depth=np.full((4, 6), 7.0, np.float32))
    pictures = MediaProvider(sandbox=UNRESTRICTED)
    bound = pictures.bind(GRAPH, {"beauty": path})
    assert set(bound) == {"beauty", "depth"}
    np.testing.assert_array_equal(pictures.load_pixels(bound["depth"]), np.full((4, 6, 1), 7.0, np.float32))


def test_a_missing_layer_is_an_error_instead_of_the_sample(tmp_path):
    pictures = MediaProvider(sandbox=UNRESTRICTED)
    bound = pictures.bind(GRAPH, {"beauty": written(tmp_path, Combined=np.ones((4, 6, 4), np.float32))})
    with pytest.raises(InputError, match="Depth"):
        pictures.probe_picture(bound["depth"])


def test_an_array_has_no_layers_to_follow():
    with pytest.raises(UsageError, match="bind 'depth' too"):
        MediaProvider(sandbox=UNRESTRICTED).bind(GRAPH, {"beauty": np.ones((4, 6, 4), np.float32)})


def test_what_is_bound_by_name_stays(tmp_path):
    path = written(tmp_path, Combined=np.ones((4, 6, 4), np.float32), Depth=np.full((4, 6), 7.0, np.float32))
    bound = MediaProvider(sandbox=UNRESTRICTED).bind(GRAPH, {"beauty": path, "depth": "other.exr:Z"})
    assert (bound["depth"].path, bound["depth"].layer) == ("other.exr", "Z")


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_encoded_pixels_are_not_taken_for_light(dtype):
    with pytest.raises(UsageError, match=r"'dirt': uint\d+ pixels .* scene-linear floats"):
        MediaProvider(sandbox=UNRESTRICTED).bind(GRAPH, {"dirt": np.zeros((4, 6, 3), dtype)})


ROLES = Graph(
    inputs={
        "beauty": Input(Kind.IMAGE, file="sample.exr", layer="Combined"),
        "albedo": Input(Kind.IMAGE, file="sample.exr", layer="Diffuse Color"),
        "emission": Input(Kind.IMAGE, file="sample.exr", layer="Emission"),
        "depth": Input(Kind.FIELD, file="sample.exr", layer="Depth"),
        "normal": Input(Kind.VECTOR, file="sample.exr", layer="Normal"),
    }
)


def render(folder, name, **layers):
    """A multi-part EXR of one color for each layer, which is its number."""
    shapes = {4: "RGBA", 3: "RGB", 1: "Z"}
    arrays = {
        layer: np.full((4, 6, width), index, np.float32) for index, (layer, width) in enumerate(layers.items(), 1)
    }
    path = folder / name
    import OpenImageIO as oiio

    specs = []
    for layer, array in arrays.items():
        spec = oiio.ImageSpec(6, 4, array.shape[2], "float")
        spec.channelnames = tuple(f"{layer}.{letter}" for letter in shapes[array.shape[2]])
        spec.attribute("oiio:subimagename", layer)
        spec.attribute("BlenderMultiChannel", "Blender V2.55.1 and newer")
        specs.append(spec)
    file = oiio.ImageOutput.create(str(path))
    assert file.open(str(path), tuple(specs))
    for index, (spec, array) in enumerate(zip(specs, arrays.values(), strict=True)):
        assert index == 0 or file.open(str(path), spec, "AppendSubimage")
        assert file.write_image(array)
    assert file.close()
    return path


def test_layers_are_found_by_role(tmp_path):
    """Blender 4.5 has other names than 5.0; an input that only follows another one is found as well."""
    path = render(tmp_path, "a.exr", Combined=4, DiffCol=3, Emit=3, Depth=1, Normal=3)
    pictures = MediaProvider(sandbox=UNRESTRICTED)
    bound = pictures.bind(ROLES, {"beauty": path})
    assert {name: picture.layer for name, picture in bound.items()} == {
        "beauty": "Combined", "albedo": "DiffCol", "emission": "Emit", "depth": "Depth", "normal": "Normal"
    }  # fmt: skip
    assert pictures.load_pixels(pictures.bind(ROLES, {"albedo": path})["albedo"])[0, 0, 0] == 2.0


def test_an_absent_layer_is_refused_and_its_role_suggested(tmp_path):
    path = render(tmp_path, "a.exr", Combined=4, Emit=3, Position=3, Depth=1)
    pictures = MediaProvider(sandbox=UNRESTRICTED)
    bound = pictures.bind(ROLES, {"albedo": path})
    with pytest.raises(InputError, match="has no layer 'Diffuse Color'"):
        pictures.probe_picture(bound["albedo"])
    named = pictures.bind(ROLES, {"beauty": f"{path}:Emission"})["beauty"]
    with pytest.raises(InputError, match="has no layer 'Emission': did you mean 'Emit'"):
        pictures.probe_picture(named)
    bare = pictures.bind(ROLES, {"beauty": f"{render(tmp_path, 'b.exr', Combined=4, Position=3)}:Emission"})["beauty"]
    with pytest.raises(InputError, match="has no layer 'Emission': it holds"):
        pictures.probe_picture(bare)


def test_a_plain_picture_is_what_the_user_binds_it_to(tmp_path):
    path = tmp_path / "plain.exr"
    media.write_picture(path, {"": np.full((4, 6, 4), 0.5, np.float32)}, kinds={"": Kind.IMAGE}, sandbox=UNRESTRICTED)
    pictures = MediaProvider(sandbox=UNRESTRICTED)
    assert pictures.load_pixels(pictures.bind(ROLES, {"albedo": path})["albedo"])[0, 0, 0] == 0.5
    follower = pictures.bind(ROLES, {"beauty": path})["albedo"]
    with pytest.raises(InputError, match="has no layer 'Diffuse Color'"):
        pictures.probe_picture(follower)


# --- a graph that is edited -----------------------------------------------------------------------------------------


def look_at(pictures: MediaProvider, graph: Graph, path: str) -> tuple[tuple[int, int], str | None]:
    """The size of a file and the view that encodes it, as a plan asks for them."""
    picture = pictures.bind(graph, {"image": path})["image"]
    return pictures.probe_picture(picture).size, pictures.find_plain_view(picture)


def test_an_edit_opens_no_file_again(tmp_path, monkeypatch):
    path = str(tmp_path / "a.png")
    cv2.imwrite(path, np.zeros((4, 6, 3), np.uint8))
    graph, pictures = Graph(inputs={"image": Input()}), MediaProvider(sandbox=UNRESTRICTED)
    assert look_at(pictures, graph, path) == ((6, 4), "none")
    opened: list[str] = []
    open_file = oiio.ImageInput.open
    monkeypatch.setattr(oiio.ImageInput, "open", lambda *names: opened.append(str(names[0])) or open_file(*names))
    for _ in range(3):
        assert look_at(pictures, graph, path) == ((6, 4), "none")
    assert opened == []


def test_a_file_that_is_written_again_is_read_again(tmp_path):
    path = str(tmp_path / "a.png")
    cv2.imwrite(path, np.zeros((4, 6, 3), np.uint8))
    graph, pictures = Graph(inputs={"image": Input()}), MediaProvider(sandbox=UNRESTRICTED)
    assert look_at(pictures, graph, path) == ((6, 4), "none")
    cv2.imwrite(path, np.zeros((5, 9, 3), np.uint8))
    assert look_at(pictures, graph, path) == ((9, 5), "none")
    Path(path).unlink()
    with pytest.raises(InputError, match="there is no such file"):
        look_at(pictures, graph, path)


def test_another_config_encodes_a_file_in_another_way(tmp_path, monkeypatch):
    """Its rule for plates says that such files hold a logarithm of the light of a scene."""
    path = str(tmp_path / "plates.png")
    cv2.imwrite(path, np.zeros((4, 6, 3), np.uint8))
    graph, pictures = Graph(inputs={"image": Input()}), MediaProvider(sandbox=UNRESTRICTED)
    assert look_at(pictures, graph, path)[1] == "none"
    monkeypatch.setenv("OCIO", str(write_house(tmp_path)))
    assert look_at(pictures, graph, path)[1] == ""


@pytest.mark.parametrize("dtype", np.typecodes["AllInteger"] + np.typecodes["Float"] + "?")
def test_numbers_are_data_unless_they_are_those_of_files(dtype):
    """Unsigned numbers of 8 and 16 bits are how files hold what a display shows; all others are what they say."""
    graph, array = Graph(inputs={"beauty": Input(Kind.IMAGE)}), np.ones((2, 3, 4), dtype)
    if np.dtype(dtype) in (np.uint8, np.uint16):
        with pytest.raises(UsageError, match="encoded for a display"):
            MediaProvider(sandbox=UNRESTRICTED).bind(graph, {"beauty": array})
    else:
        bound = MediaProvider(sandbox=UNRESTRICTED).bind(graph, {"beauty": array})["beauty"]
        assert bound.in_memory and bound.pixels is array
