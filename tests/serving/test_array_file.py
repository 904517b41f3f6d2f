"""The file in which a render server and its client leave each other arrays."""

from __future__ import annotations

import json
import os
import stat
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from halation.errors import OutputError
from halation.resources.sandbox import UNRESTRICTED, Sandbox
from halation.scripting.array_file import ArrayFile, make_array_file, open_array_file
from halation.scripting.packed_arrays import read_pictures, unpack_array
from halation.serving.request_queue import ServiceClient
from halation.serving.service import RenderService, ServiceLimits
from halation.serving.service_requests import parse_request

BRIGHTER = {
    "halation": 1,
    "inputs": {"beauty": {"type": "Image"}},
    "outputs": {"image": {"type": "Image"}},
    "nodes": {"light": {"type": "exposure", "values": {"stops": 1.0}}},
    "links": {"light.image": "inputs.beauty", "outputs.image": "light.out"},
}


@pytest.fixture
def shared() -> Iterator[ArrayFile]:
    with make_array_file() as array_file:
        assert array_file is not None
        yield array_file


@pytest.fixture
def ask(renderer):
    """Answers a request, without a process of its own."""
    replies: list[Any] = []
    client = ServiceClient(replies.append)

    def answer(sandbox: Sandbox = UNRESTRICTED, **request: Any) -> Any:
        service = RenderService(renderer, sandbox, ServiceLimits())
        service.answer(client, parse_request(json.dumps({"do": "render", "graph": BRIGHTER, **request}).encode()))
        return replies.pop()

    return answer


def test_arrays_are_read_as_they_were_written(shared):
    generator = np.random.default_rng(3)
    arrays = [generator.normal(size=(3, 5, 4)), generator.normal(size=(7, 2, 1))[::-1], np.zeros((0, 4, 4))]
    for _ in range(2):  # the second time over those of the first
        shared.rewind()
        for dtype in (np.float16, np.float32):
            places = [shared.pack_array(array.astype(dtype)) for array in arrays]
            with open_array_file(str(shared.path), UNRESTRICTED) as opened:
                for array, place in zip(arrays, places, strict=True):
                    received = unpack_array("a", place, opened)
                    assert received.dtype == dtype and received.flags.writeable
                    np.testing.assert_array_equal(received, array.astype(dtype))


@pytest.mark.parametrize(
    ("shape", "offset"),
    [((2, 2, 1), 4), ((2, 2, 1), -4), ((-2, -2, 1), 0), ((2**31, 2**31, 4), 0), ((1, 1, 1), 2**70)],
)
def test_what_is_not_in_the_file_is_refused(shared, shape, offset):
    shared.pack_array(np.zeros((2, 2, 1), np.float32))
    with pytest.raises(ValueError, match="has 16 bytes"):
        shared.read_array("float32", shape, offset)


@pytest.mark.skipif(os.name == "nt", reason="POSIX permissions")
def test_the_file_is_private_and_removed():
    with make_array_file() as array_file:
        assert array_file is not None
        folder = array_file.path.parent
        assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert not folder.exists()


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no FIFOs")
def test_only_regular_files_inside_the_root_are_overwritten(tmp_path, ask):
    inside, outside = tmp_path / "inside", tmp_path / "outside"
    inside.mkdir()
    outside.write_bytes(b"precious")
    os.mkfifo(tmp_path / "pipe")
    for path, sandbox, reason in (
        (tmp_path / "gone", UNRESTRICTED, "there is no such file"),
        (tmp_path / "pipe", UNRESTRICTED, "is a FIFO"),
        (tmp_path, UNRESTRICTED, "Is a directory"),
        (Path("/dev/null"), UNRESTRICTED, "is a device"),
        (outside, Sandbox(str(inside)), "lies outside of"),
    ):
        error = ask(sandbox, array_file=str(path), input={"beauty": {"shape": [1, 1, 4], "type": "float32"}})["error"]
        assert error["kind"] == "OutputError" and reason in error["message"]
    assert outside.read_bytes() == b"precious"
    with pytest.raises(OutputError), open_array_file("\0", UNRESTRICTED):
        pass


def test_pictures_are_taken_from_it_and_left_in_it(shared, ask):
    picture = np.random.default_rng(5).random((4, 6, 4), np.float32)
    shared.pack_array(np.zeros((3, 3, 4), np.float32))
    reply = ask(array_file=str(shared.path), input={"beauty": shared.pack_array(picture)}, precision="float")
    assert "pixels" not in reply["pictures"]["image"]
    received = read_pictures(json.dumps(reply).encode(), shared)
    assert received is not None
    np.testing.assert_allclose(received["image"][..., :3], 2.0 * picture[..., :3], rtol=1e-6)


def test_an_array_in_a_file_that_is_not_named_is_refused(ask):
    error = ask(input={"beauty": {"shape": [1, 1, 4], "type": "float32", "offset": 0}})["error"]
    assert "the request names no file with pixels" in error["message"]
