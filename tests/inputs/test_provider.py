"""Pictures bound to inputs: arrays, files, and the layers that follow their file."""

from __future__ import annotations

import numpy as np
import pytest
from halation import media
from halation.errors import InputError, UsageError
from halation.graph import Graph, Input
from halation.inputs.provider import MediaProvider
from halation.nodes import Kind

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
    media.write_picture(path, layers, kinds=kinds)
    return path


def test_a_layer_follows_its_file(tmp_path):
    path = written(tmp_path, Combined=np.ones((4, 6, 4), np.float32), Depth=np.full((4, 6), 7.0, np.float32))
    pictures = MediaProvider()
    bound = pictures.bind(GRAPH, {"beauty": path})
    assert set(bound) == {"beauty", "depth"}
    np.testing.assert_array_equal(pictures.load_pixels(bound["depth"]), np.full((4, 6, 1), 7.0, np.float32))


def test_a_missing_layer_is_an_error_instead_of_the_sample(tmp_path):
    pictures = MediaProvider()
    bound = pictures.bind(GRAPH, {"beauty": written(tmp_path, Combined=np.ones((4, 6, 4), np.float32))})
    with pytest.raises(InputError, match="Depth"):
        pictures.probe_picture(bound["depth"])


def test_an_array_has_no_layers_to_follow():
    with pytest.raises(UsageError, match="bind 'depth' too"):
        MediaProvider().bind(GRAPH, {"beauty": np.ones((4, 6, 4), np.float32)})


def test_what_is_bound_by_name_stays(tmp_path):
    path = written(tmp_path, Combined=np.ones((4, 6, 4), np.float32), Depth=np.full((4, 6), 7.0, np.float32))
    bound = MediaProvider().bind(GRAPH, {"beauty": path, "depth": "other.exr:Z"})
    assert (bound["depth"].path, bound["depth"].layer) == ("other.exr", "Z")


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_encoded_pixels_are_not_taken_for_light(dtype):
    with pytest.raises(UsageError, match=r"'dirt': uint\d+ pixels .* scene-linear floats"):
        MediaProvider().bind(GRAPH, {"dirt": np.zeros((4, 6, 3), dtype)})
