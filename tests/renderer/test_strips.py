"""Pictures that no memory holds go from file to file by rows: the same files, to the byte."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from halation.errors import HalationError, OutputError
from halation.graph import Graph, Input, Output, Port
from halation.media.pictures import row_writer
from halation.nodes import Kind, catalogue
from halation.renderer import Renderer, RenderRequest, open_device
from halation.renderer.jobs.job import OutputSettings, run_job
from halation.resources.sandbox import UNRESTRICTED
from oiio_pictures import write_with_attributes

NODES = catalogue()
WIDTH, HEIGHT = 700, 900
MEMORY = 5 * 2**20
"""The picture, and what is made of it, are 10 MB each."""


def blurred() -> Graph:
    """A file through a blur and grain."""
    graph = Graph().add_input("image", Input(Kind.IMAGE)).add("blur", NODES["gaussian_blur"](sigma=5.0))
    graph = graph.add("grain", NODES["film_grain"]()).connect(Port("inputs", "image"), Port("blur", "image"))
    graph = graph.connect(Port("blur", "out"), Port("grain", "image"))
    return graph.add_output("image", Output()).connect(Port("grain", "out"), Port("outputs", "image"))


@pytest.fixture
def picture(tmp_path) -> str:
    array = np.random.default_rng(5).gamma(0.6, 1.0, (HEIGHT, WIDTH, 4)).astype(np.float32)
    array[100:140, 50] = np.nan
    return write_with_attributes(tmp_path / "in.exr", array, format="float")


def written(folder: Path, picture: str, memory: int, **how) -> Path:
    """The file that a job makes of it, with so much memory."""
    renderer, file = (
        Renderer(open_device("compute", memory, sandbox=UNRESTRICTED), budget=0, sandbox=UNRESTRICTED),
        folder / "out.exr",
    )
    try:
        run_job(renderer, blurred(), RenderRequest({"image": picture}), OutputSettings([("image", file)], **how))
    finally:
        renderer.close()
    return file.rename(folder / f"{memory}.exr")


@pytest.mark.parametrize("how", [{}, {"precision": "float", "compression": "piz"}, {"space": "ACEScg"}])
def test_files_are_the_same_to_the_byte(tmp_path, picture, how):
    whole, parts = (written(tmp_path, picture, memory, **how) for memory in (0, MEMORY))
    assert whole.read_bytes() == parts.read_bytes()


def test_what_is_not_finished_leaves_nothing_behind(tmp_path, picture, monkeypatch):
    def full(*_: object) -> None:
        raise OutputError("no room")

    monkeypatch.setattr(row_writer.ScanlineWriter, "add", full)
    before = set(tmp_path.iterdir())
    with pytest.raises(HalationError, match="no room"):
        written(tmp_path, picture, MEMORY)
    assert set(tmp_path.iterdir()) == before


def test_a_disk_that_is_full_says_so(tmp_path, picture):
    """The encoder says only that it failed, and names a file that nobody knows."""
    resource = pytest.importorskip("resource", reason="this system has no resource limits")
    before, limits = set(tmp_path.iterdir()), resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, limits[1]))
    try:
        with pytest.raises(HalationError, match="would be larger than may be written here: make it smaller"):
            written(tmp_path, picture, MEMORY)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert set(tmp_path.iterdir()) == before
