"""A picture that was rendered here is dropped on the window: its graph, or the picture, as the person says."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
from exr_files import read
from halation import document
from halation.authoring.commands import SetValue
from halation.color.display import to_display
from halation.editor.window.dropped_files import take_files
from halation.graph import Port
from halation.presets import paths, sample
from halation.renderer import Renderer, RenderRequest
from halation.renderer.jobs.job import OutputSettings, run_job
from halation.resources.sandbox import UNRESTRICTED

BLOOM = next(path for path in paths() if path.stem == "soft_bloom")


def rendered(folder: Path) -> Path:
    """A picture of a preset with a value of its own, beside the plate that it was made of."""
    shutil.copy(str(sample()), folder / "plate.exr")
    graph = document.load(BLOOM, sandbox=UNRESTRICTED).set(Port("bloom", "intensity"), 0.625)
    renderer = Renderer(sandbox=UNRESTRICTED)
    inputs = {"beauty": f"{folder / 'plate.exr'}:Combined"}
    run_job(
        renderer,
        graph,
        RenderRequest(inputs, scale=0.5),
        OutputSettings((("", folder / "night shot.png"),), view="none"),
    )
    renderer.close()
    return folder / "night shot.png"


def answer(ui, picture: Path, word: str) -> None:
    ui.ask(lambda: take_files(ui.editor, ui.window._contexts.documents, [picture]))
    ui.wait(3)
    assert ui.editor.dialogs.question.sentence == "night shot.png holds the graph that made it."
    ui.shot("rendered.png")
    ui.click(f"answer {[text for text, _ in ui.editor.dialogs.question.answers].index(word)}")
    ui.wait(3)


def test_its_graph_is_opened_as_a_new_document(gui, tmp_path: Path) -> None:
    picture = rendered(tmp_path)

    def body(ui) -> None:
        ui.session.apply(SetValue(Port("bloom", "intensity"), 0.1))
        answer(ui, picture, "Open its graph")
        assert "unsaved changes" in ui.editor.dialogs.question.sentence
        ui.click("answer 1")
        ui.settled()
        session = ui.session
        assert (session.name, session.path) == ("night shot", None) and not session.history.steps
        assert session.graph.value(Port("bloom", "intensity")) == 0.625
        assert not ui.editor.preview.faults and not ui.editor.faults
        ui.session.views.show(Port("outputs", "image"))
        ui.settled()
        shown = ui.editor.preview.find_whole_image("A")
        size = shown.texture.size
        seen = ui.ask(lambda: ui.editor.probe.read_region(shown.texture, (0, 0, *size)))[..., :3]
        expected = to_display(seen, "none")
        small = read(picture)[..., :3]
        assert abs(float(np.mean(expected) / 255.0) - float(small.mean())) < 0.02, "it is the picture again"
        ui.shot("opened.png")
        ui.keys("Ctrl+S")
        ui.until(lambda: ui.editor.dialogs.browse is not None)
        assert ui.editor.dialogs.browse.name == "night shot.json"

    gui(body, BLOOM)


def test_it_is_read_as_a_picture(gui, tmp_path: Path) -> None:
    picture = rendered(tmp_path)

    def body(ui) -> None:
        answer(ui, picture, "Read it as a picture")
        node = ui.session.active
        assert ui.session.graph.nodes[node].id == "read_image" and ui.session.name == "soft_bloom"
        ui.session.undo()
        assert node not in ui.session.graph.nodes

    gui(body, BLOOM)
