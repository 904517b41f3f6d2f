"""Protocols: the few attributes that one panel uses of another, so that neither imports the other."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from ...authoring.edits.element_id import ElementId
    from ...authoring.edits.elements import Sizes
    from ...authoring.session import Session
    from ...color.transforms import Array


class SystemText(Protocol):
    """The clipboard of the system."""

    def get(self) -> str:
        """The text on the clipboard."""
        ...

    def put(self, text: str) -> None:
        """Replace the text on the clipboard."""
        ...


class ElementView(Protocol):
    """The canvas, for panels that lead the user to an element or add one."""

    @property
    def pointer(self) -> tuple[float, float]:
        """The canvas position where new elements go."""
        ...

    @property
    def sizes(self) -> Sizes | None:
        """Width and height of elements as drawn last, in canvas units."""
        ...

    def fit(self, elements: Collection[ElementId] = (), least_zoom: float = 0.0) -> None:
        """Bring elements into view, at a zoom or a larger one; none means all."""
        ...

    def reveal(self, elements: Collection[ElementId]) -> None:
        """Move the view until elements can be seen."""
        ...


class PixelPicker(Protocol):
    """The viewer, for fields whose value the user takes from the picture."""

    picking: str
    """`node.value` that the next click on the picture sets; "" for none."""
    picture: tuple[int, int]
    """Size of the shown picture at full size."""


class SnapshotSource(Protocol):
    """The viewer, for dialogs that need a small picture of what it shows."""

    snapshot: Callable[[Array], object] | None
    """Takes the next picture of the viewer, [h, w, 3] of uint8; the viewer calls it once."""


class Player(Protocol):
    """The timeline, for panels that must stop it."""

    def stop(self) -> None:
        """Stop playing at the current frame."""
        ...


class PlayedSpan(Protocol):
    """The timeline, for panels that ask which frames are played."""

    def span(self, session: Session) -> tuple[int, int]:
        """The first and the last frame that are played."""
        ...


class PlayState(Protocol):
    """The timeline, for panels that show frames while they are played."""

    @property
    def playing(self) -> bool:
        """True while frames are played."""
        ...

    @property
    def scrubbing(self) -> bool:
        """True while the user drags the current frame."""
        ...


class ReportedFault(Protocol):
    """The Code panel, for panels that would repeat its message."""

    @property
    def fault_path(self) -> str:
        """The path of the node whose fault the Code panel shows."""
        ...
