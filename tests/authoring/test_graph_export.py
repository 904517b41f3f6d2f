"""Exports of a document by a process of its own."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import PyOpenColorIO as ocio
from halation import document, presets
from halation.authoring.background.graph_export import ExportChoices, GraphExport
from halation.graph import Graph, Input, Port
from halation.nodes import Kind
from halation.nodes.color.exposure import Exposure
from halation.resources.sandbox import UNRESTRICTED


def run(graph: Graph, choices: ExportChoices, output: Path) -> GraphExport:
    folder = output.parent / "work"
    folder.mkdir(exist_ok=True)
    export = GraphExport(graph, choices, output, folder, {}, UNRESTRICTED)
    assert export.wait(120.0) and export.outcome is not None
    return export


def test_an_unsaved_graph_becomes_a_table_that_opencolorio_reads(tmp_path: Path) -> None:
    graph = Graph(inputs={"image": Input(Kind.IMAGE)}).add("light", Exposure(stops=1.0))
    graph = graph.connect(Port("inputs", "image"), Port("light", "image"))
    output = tmp_path / "brighter.cube"
    choices = ExportChoices("cube", node="light.out", lut_size=17, color_range="0,4")
    outcome = run(graph, choices, output).outcome
    assert outcome is not None and not outcome.fault and outcome.figures
    assert "LUT_3D_SIZE 17" in output.read_text()
    config = ocio.Config.CreateRaw()
    processor = config.getProcessor(ocio.FileTransform(str(output), interpolation=ocio.INTERP_TETRAHEDRAL))
    color = np.array([0.18, 0.5, 1.0], np.float32)
    table = processor.getDefaultCPUProcessor().applyRGB(color.tolist())
    np.testing.assert_allclose(table, 2.0 * color, rtol=0.02)


def test_a_refusal_is_the_sentence_of_the_command_and_writes_no_file(tmp_path: Path) -> None:
    graph = document.load(next(path for path in presets.paths() if path.stem == "soft_bloom"), sandbox=UNRESTRICTED)
    output = tmp_path / "glow.cube"
    outcome = run(graph, ExportChoices("cube"), output).outcome
    assert outcome is not None and "bloom" in outcome.fault and not output.exists()


def test_what_is_stopped_ends(tmp_path: Path) -> None:
    graph = document.load(next(path for path in presets.paths() if path.stem == "soft_bloom"), sandbox=UNRESTRICTED)
    export = GraphExport(graph, ExportChoices("web"), tmp_path / "page.html", tmp_path, {}, UNRESTRICTED)
    export.stop()
    assert export.wait(20.0) and not (tmp_path / "page.html").exists()
    assert ExportChoices("isf", node="a.out", selection="a,b").words == ["--to=isf", "--select=a,b"]
    assert ExportChoices("web", frame=0, size="64x36").words == ["--to=web", "--size=64x36", "--frame=0"]
