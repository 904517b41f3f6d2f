"""What commands share that render many pictures into a folder."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from .outcome import note

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

    from ..graph import Graph
    from ..renderer import Renderer


@dataclass(frozen=True)
class Batch:
    """A renderer, and a bar on terminals that shows how far it is."""

    renderer: Renderer
    _progress: Progress
    _task: TaskID

    @property
    def device(self) -> str:
        """What it renders on."""
        return self.renderer.device.description

    def step(self, name: str) -> None:
        """Say what comes next."""
        self._progress.update(self._task, description=name, advance=1)

    def say(self, line: str) -> None:
        """A line above the bar."""
        self._progress.console.print(line, soft_wrap=True, markup=False, highlight=False)


def middle_frame(renderer: Renderer, graph: Graph) -> int:
    """The frame that stands for all of a graph: by then something has happened."""
    return sum(renderer.frames(graph)) // 2


@contextmanager
def open_batch(output: Path, total: int, budget: int = 0) -> Iterator[Batch]:
    """Make the folder, open a device and show the bar; at the end both are closed.

    `budget` is how many bytes of results may stay on the device from one picture to the next.

    Raises OutputError for a folder that cannot be made, DeviceError without usable OpenGL.
    """
    from ..errors import OutputError
    from ..renderer import Renderer, open_device

    try:
        output.mkdir(parents=True, exist_ok=True)
    except OSError as fault:
        raise OutputError(f"{output}: the folder cannot be made ({fault.strerror}); choose another with -o") from None
    renderer = Renderer(open_device(), budget=budget)
    with show_progress(renderer, total) as work:
        yield work
    renderer.close()


@contextmanager
def show_progress(renderer: Renderer, total: int) -> Iterator[Batch]:
    """Show the bar of what somebody else's device does."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    note(renderer.device.description)
    console = Console(stderr=True)
    columns = (TextColumn("{task.description:<24}", markup=False), BarColumn(), MofNCompleteColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as progress:
        yield Batch(renderer, progress, progress.add_task("", total=total))
