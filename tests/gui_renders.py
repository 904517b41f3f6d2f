"""The screens of the panel Renders."""

from collections.abc import Iterator
from pathlib import Path

from gui_driver import Ui
from halation.authoring.render_queue.queued_render import QueuedJob, QueuedRender, RenderState
from halation.editor.shared.declared_words import name_choice
from halation.graph import Graph
from halation.renderer.jobs.render_job import RenderJob
from halation.resources.sandbox import UNRESTRICTED


def make_render(place: Path, state: RenderState, done: int = 0, total: int = 24, **facts: object) -> QueuedRender:
    """A render to files as the panel sees it, without a process."""
    frames, files = tuple(range(1, total + 1)), (("image", str(place)),)
    made = QueuedRender(QueuedJob(RenderJob(sandbox=UNRESTRICTED, destinations=files, frames=frames), Graph()))
    made.state, made.done = state, done
    made.started_at, made.ended_at = 1.0, 0.0 if state in ("running", "waiting") else 43.0
    made.written_files = tuple(place.with_name(f"{place.stem}.{frame:04d}.exr") for frame in range(1, done + 1))
    for name, fact in facts.items():
        setattr(made, name, fact)
    return made


def list_renders() -> tuple[QueuedRender, ...]:
    """Renders in every state."""
    folder = Path("/pictures/shots/0120")
    return (
        make_render(folder / "comp_v012.####.exr", "done", 24, notes=("image: clipped to 16 bit",)),
        make_render(folder / "comp_v013.png", "failed", total=1, sentence="/pictures/shots/0120: no such folder"),
        make_render(folder / "a_very_long_name_of_a_picture_that_does_not_end_v014.####.exr", "cancelled", 5),
        make_render(folder / "comp_v015.####.exr", "running", 9, frame=10, node="bloom", passes=(3, 8)),
        make_render(folder / "comp_v016.####.exr", "waiting"),
        make_render(folder / "comp_v017.####.exr", "waiting"),
    )


def renders(ui: Ui) -> Iterator[str]:
    """The form, and renders in every state."""
    ui.show_panel("Renders")
    yield "renders_form"
    ui.editor.exports.all = list_renders()
    ui.wait(3)
    yield "renders"
    ui.editor.exports.all = ()
    ui.click("Frames")
    ui.click(f"Frames {name_choice('many files')}")
    assert "Fill" not in ui.editor.places, "the other input is a number, which no file fills"
    yield "renders_many_files"
    ui.click("render cluster")
    ui.type("tcp://farm:8786")
    yield "renders_cluster"
    ui.show_panel("Graph")


def exporting(ui: Ui) -> Iterator[str]:
    """The dialog that writes graphs for other programs."""
    ui.editor.actions.run("file.export")
    ui.wait(4)
    yield "export"
    ui.click("export kind")
    yield "export_kinds"
    ui.keys("Escape")
    ui.click("export close")
