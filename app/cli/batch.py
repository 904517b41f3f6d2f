"""What `demo`, `gallery`, `sweep` and `bench` share: a renderer, and a progress bar over many pictures."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from msgspec import Struct

from ..resources.sandbox import Sandbox
from .outcome import print_note

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

    from ..graph import Graph
    from ..renderer import Renderer


class Batch(Struct, frozen=True):
    """A renderer, and a progress bar on terminals."""

    renderer: Renderer
    _progress: Progress
    _task: TaskID

    @property
    def device(self) -> str:
        """The description of the device."""
        return self.renderer.device.description

    def step(self, name: str) -> None:
        """Show the name of what is rendered next, and advance the bar."""
        self._progress.update(self._task, description=name, advance=1)

    def say(self, line: str) -> None:
        """Print a line above the bar."""
        self._progress.console.print(line, soft_wrap=True, markup=False, highlight=False)


def find_middle_frame(renderer: Renderer, graph: Graph) -> int:
    """The frame in the middle of a graph, which shows an animation better than its first frame."""
    return sum(renderer.find_frames(graph)) // 2


@contextmanager
def open_batch(output: Path, total: int, budget: int = 0, *, sandbox: Sandbox) -> Iterator[Batch]:
    """Create the folder, open a device and show a progress bar; close both at the end.

    `budget` is how many bytes of results the device may keep from one picture to the next.

    Raises OutputError for a folder that cannot be created, DeviceError without usable OpenGL.
    """
    from ..errors import OutputError
    from ..renderer import Renderer, open_device

    if reason := sandbox.find_write_fault(output):
        raise OutputError(f"{output}: {reason}")
    try:
        output.mkdir(parents=True, exist_ok=True)
    except OSError as fault:
        raise OutputError(
            f"{output}: the folder cannot be created ({fault.strerror}); choose another with -o"
        ) from None
    renderer = Renderer(open_device(sandbox=sandbox), budget=budget, sandbox=sandbox)
    with closing(renderer), show_progress(renderer, total) as batch:
        yield batch


@contextmanager
def show_progress(renderer: Renderer, total: int) -> Iterator[Batch]:
    """Show a progress bar for a renderer that the caller has opened and closes."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    print_note(renderer.device.description)
    console = Console(stderr=True)
    columns = (TextColumn("{task.description:<24}", markup=False), BarColumn(), MofNCompleteColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as progress:
        yield Batch(renderer, progress, progress.add_task("", total=total))
