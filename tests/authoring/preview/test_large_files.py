"""The scale for graphs that read large files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from halation.authoring.preview import large_files
from halation.authoring.preview.large_files import LargeFiles
from halation.graph import Graph, Input
from halation.inputs.provider import MediaProvider
from halation.nodes import Kind
from halation.resources.sandbox import UNRESTRICTED
from oiio_pictures import write_with_attributes

BUDGET = 512 * 2**20


@pytest.mark.parametrize(
    ("size", "zoom", "scale"),
    [
        ((12_000, 8_000), 0.0, 1 / 8),  # the view is not known yet
        ((12_000, 8_000), 0.1, 1 / 8),
        ((12_000, 8_000), 0.25, 1 / 4),
        ((12_000, 8_000), 0.26, 1 / 2),
        ((12_000, 8_000), 1.0, 1 / 2),  # the whole would take 732 MiB
        ((7680, 4320), 0.2, 1 / 4),
        ((7680, 4320), 1.0, 1.0),
        ((0, 0), 0.1, 1.0),
    ],
)
def test_no_more_pixels_than_are_seen_and_held(size: tuple[int, int], zoom: float, scale: float) -> None:
    assert LargeFiles(size).choose_scale(zoom, BUDGET) == scale


def test_the_largest_file_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(large_files, "LARGE_PICTURE", 1000)
    for name, width in (("small", 20), ("wide", 60), ("narrow", 50)):
        write_with_attributes(tmp_path / f"{name}.exr", np.zeros((20, width, 4), np.float32))
    ends = {name: Input(Kind.IMAGE, file=f"{name}.exr") for name in ("small", "wide", "missing")}
    files, provider = LargeFiles(), MediaProvider(sandbox=UNRESTRICTED)
    files.follow(Graph(inputs=ends, folder=str(tmp_path)), {}, provider)
    assert files.size == (60, 20)
    files.follow(Graph(inputs=ends, folder=str(tmp_path)), {"wide": str(tmp_path / "narrow.exr")}, provider)
    assert files.size == (50, 20)
    files.follow(Graph(inputs={"small": ends["small"]}, folder=str(tmp_path)), {}, provider)
    assert files.size == (0, 0)
