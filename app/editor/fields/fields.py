"""The state of value fields between frames, and the edits that they return. Nothing here draws."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from halation.nodes import Plain, Value
from msgspec import Struct, field

from ...errors import UsageError
from ..theme.palette import Palette
from .numbers import Drag, parse_number

if TYPE_CHECKING:
    from ...authoring.preferences import PreferenceStore
    from ..toolkit.places import Rect


class Edit(Struct, frozen=True):
    """A new value. Edits of one gesture, such as a drag, have the same `merge`; `text` is the typed text."""

    value: Plain
    merge: str = ""
    text: str = ""
    expression: str = ""
    """The typed expression, with its `=`; then `value` is the old value."""


class Typing(Struct):
    """The field that has the text cursor. `number` says how its text is read; None takes it as it is."""

    id: str
    text: str
    before: str
    old: Plain
    number: Value | None = None
    merge: str = ""
    starting: bool = True
    """True until the text cursor is in it."""
    is_drawn: bool = True
    tab: int = 0
    """1 or -1 if Tab goes to the next or previous field."""
    has_stepped: bool = False
    """True in the frame in which an arrow key changed a digit."""

    def result(self) -> Edit | None:
        """The edit of the typed text, None if nothing changed. Raises UsageError."""
        if self.text == self.before and not self.merge:
            return None
        if self.number is None:
            return Edit(self.text, self.merge, self.text)
        assert isinstance(self.old, int | float)
        if self.text.lstrip().startswith("="):
            return Edit(self.old, self.merge, self.text, self.text)
        return Edit(parse_number(self.text, self.old, self.number), self.merge, self.text)

    @property
    def fault(self) -> str:
        """Why the text is invalid, "" if it is valid."""
        try:
            self.result()
        except UsageError as error:
            return str(error)
        return ""


class Fields(Struct):
    """The state of the fields of one panel: at most one is dragged and at most one is typed in."""

    palette: Palette
    store: PreferenceStore | None = None
    """The preferences, with the swatches of the user."""
    places: dict[str, Rect] = field(default_factory=dict[str, "Rect"])
    """The places of widgets, shared with the window."""
    typing: Typing | None = None
    drag: Drag | None = None
    drag_id: str = ""
    pressed: str = ""
    """The field in which the mouse button was pressed but not dragged yet."""
    next_field: str = ""
    """The field that gets the text cursor when it is drawn next."""
    eyedropper: str = ""
    """The color field whose eyedropper was pressed in this frame."""
    stops: float = 0.0
    """The intensity that the open color picker shows, in EV."""
    before: Plain = 0.0
    """The curve or ramp before the drag."""
    point: tuple[str, int] = ("", -1)
    """The curve or ramp field with a selected point, and the index of the point."""
    items: dict[str, str] = field(default_factory=dict[str, str])
    """The name of the selected item of each value with named items, shared with the window."""
    items_shown: dict[str, str] = field(default_factory=dict[str, str])
    """The item that each list has scrolled to."""
    filter: str = ""
    """The search text of the open choice list."""
    gesture: int = 0
    order: list[str] = field(default_factory=list[str])
    """Fields that can be typed in, as drawn so far in this frame."""
    parts: dict[str, Callable[[Edit], Edit | None]] = field(default_factory=dict[str, "Callable[[Edit], Edit | None]"])
    """How an edit of a field that is part of another (`gain#2` of `gain`) becomes one of that, by the part's name."""
    owners: dict[str, str] = field(default_factory=dict[str, str])
    """The field that a part belongs to."""
    previous_order: tuple[str, ...] = ()
    """The `order` of the frame before."""

    def begin(self, held: bool = True) -> None:
        """Call in every frame, before the panel's fields; `held` is True while a mouse button is down."""
        if not held:
            self.drag_id = ""
        self.previous_order = tuple(self.order)
        self.order.clear()
        self.eyedropper = ""
        if self.typing:
            self.typing.is_drawn = False
        else:
            self.parts.clear()
            self.owners.clear()

    def end(self) -> tuple[str, Edit] | None:
        """Call after the fields; returns the edit of a field that is no longer drawn because the selection changed."""
        abandoned = self.typing
        if abandoned is None or abandoned.is_drawn:
            return None
        self.typing = None
        try:
            edit = None if abandoned.starting else abandoned.result()
        except UsageError:
            edit = None
        id = abandoned.id
        while edit and id in self.owners:
            edit, id = self.parts[id](edit), self.owners[id]
        return (id, edit) if edit else None

    def part(self, id: str, owner: str, whole: Callable[[Edit], Edit | None]) -> None:
        """Say that field `id` is part of another one; `whole` makes an edit of that of an edit of the part."""
        self.parts[id], self.owners[id] = whole, owner

    @property
    def dragging(self) -> bool:
        """True while something is dragged."""
        return self.drag_id != ""

    def start_gesture(self) -> str:
        """A new merge token for a gesture."""
        self.gesture += 1
        return self.merge

    @property
    def merge(self) -> str:
        """The merge token of the current gesture."""
        return f"field {id(self)} {self.gesture}"

    def type_in(self, id: str, text: str, old: Plain, number: Value | None = None) -> None:
        """Put the text cursor into a field."""
        self.next_field = ""
        self.typing = Typing(id, text, text, old, number)

    def next_after(self, id: str, direction: int) -> str:
        """The field that Tab goes to."""
        if id not in self.previous_order or len(self.previous_order) < 2:
            return ""
        return self.previous_order[(self.previous_order.index(id) + direction) % len(self.previous_order)]
