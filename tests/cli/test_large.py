"""Pictures that no device holds as a whole, through the command line."""

from __future__ import annotations

import json

import numpy as np
import pytest
from exr_files import read, write_exr

BLUR = {"blur": {"type": "gaussian_blur", "version": 1, "values": {"sigma": 2.0}}}
LINKS = {"blur.image": "inputs.beauty", "outputs.image": "blur.out"}


@pytest.fixture
def wide(tmp_path):
    """20,000 x 100 pixels of noise, which repeats every 500."""
    tile = np.random.default_rng(5).random((100, 500, 4), np.float32)
    tile[..., 3] = 1.0
    path = write_exr(tmp_path / "wide.exr", {"Combined": np.tile(tile, (1, 40, 1))}, {"Combined": "half"})
    return f"beauty={path}:Combined"


def test_a_picture_wider_than_any_device_is_rendered(cli, graphs, wide, tmp_path):
    graph = graphs(nodes=BLUR, links=LINKS)
    files = [tmp_path / "free.exr", tmp_path / "tight.exr"]
    assert cli("render", graph, "-i", wide, "-o", files[0]).code == 0
    assert cli("render", graph, "-i", wide, "-o", files[1], "--memory", "54M").code == 0
    pixels = read(files[0])
    assert pixels.shape == (100, 20000, 4)
    # Away from the ends it repeats as what was read does, wherever tiles met.
    np.testing.assert_array_equal(pixels[:, 500:19500], np.tile(pixels[:, 500:1000], (1, 38, 1)))
    assert files[0].read_bytes() == files[1].read_bytes()


def test_explain_says_how_it_is_tiled(cli, graphs, wide):
    graph = graphs(nodes=BLUR, links=LINKS)
    said = cli("explain", graph, "-i", wide).out
    assert "input 'beauty': 20000x100 pixels is more than the 16384 that a device can hold on a side" in said
    assert "20000x100 of blur in 2 tiles of 10000x100" in said
    tiles = json.loads(cli("explain", graph, "-i", wide, "--memory", "54M", "--json").out)["tiles"]
    assert tiles["stages"][0]["tiles"] > 2 and tiles["peak_bytes"] <= 54 * 2**20
    assert json.loads(cli("explain", graph, "--json").out)["tiles"] is None


@pytest.mark.parametrize("size", ["much", "-1G", "0", "M", "1e9T"])
def test_a_size_that_is_none_is_refused(cli, graphs, tmp_path, size):
    result = cli("render", graphs(), "-o", tmp_path / "out.exr", "--memory", size)
    assert (result.code, result.err) == (2, f"halation: --memory {size}: give a size as 512M or 2G\n")


def test_too_little_memory_is_an_error_of_the_device(cli, graphs, tmp_path):
    result = cli("render", graphs(nodes=BLUR, links=LINKS), "-o", tmp_path / "out.exr", "--memory", "10K")
    assert result.code == 5 and "give more with --memory" in result.err
