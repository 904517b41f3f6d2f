"""Draws the window, on a software rasterizer only where it differs from the frame before (see `damage`).

The frame is ended by us, a moment before the window library does it, and its triangles are drawn once for each
changed rectangle, clipped to that. The library then finds a picture without size, and draws nothing more.

It needs a window whose pixels stay when they are shown: a driver may swap two buffers instead of copying one. So the
first frames are drawn whole, each with a pixel of its own color in a corner, which must still be there afterwards.
The library draws the windows of panels that were torn off. While the test engine runs, it draws everything: the thread
of a test would wait for ours, which ends the frame.
"""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import Any

import numpy as np
from imgui_bundle import ImVec2, imgui
from msgspec import Struct

from ...renderer import Device
from .damage import (
    COMMAND,
    COVER_ROWS,
    VERTEX,
    Array,
    Box,
    Covers,
    are_mostly_new,
    find_boxes,
    find_changed_boxes,
    find_covers,
    find_extent,
    find_last_cover,
    find_picture_boxes,
    make_rows,
    merge_boxes,
    surround,
)

TRIALS = 3
"""Frames with a pixel that must stay: two buffers would show the one of the frame before the last."""

RESIZED = 3
"""Frames that are drawn whole after a change of the window's size. Mesa learns of it only when a frame has been shown,
and begins the next one with empty pixels; one more frame is for a size that changes while a frame is drawn."""


class _DrawnList(Struct):
    """What one panel drew in a frame."""

    name: str
    vertices: bytes
    indices: bytes
    commands: bytes
    _rows: Array | None = None
    _boxes: Array | None = None
    _covers: Covers | None = None
    _extent: Array | None = None

    @property
    def memory(self) -> tuple[bytes, bytes, bytes]:
        """The bytes of everything that was drawn, to compare two frames."""
        return self.vertices, self.indices, self.commands

    @property
    def command_table(self) -> Array:
        """Its draw commands."""
        return np.frombuffer(self.commands, COMMAND)

    @property
    def index_array(self) -> Array:
        """The vertices of its triangles, three by three."""
        return np.frombuffer(self.indices, np.uint32)

    @property
    def vertex_array(self) -> Array:
        """Its vertices, uint32 [n, 5]."""
        return np.frombuffer(self.vertices, np.uint32).reshape(-1, VERTEX)

    @property
    def rows(self) -> Array:
        """Its triangles."""
        if self._rows is None:
            self._rows = make_rows(self.vertex_array, self.index_array, self.command_table)
        return self._rows

    @property
    def boxes(self) -> Array:
        """The boxes of its triangles; the next frame compares with them too."""
        if self._boxes is None:
            self._boxes = find_boxes(self.rows)
        return self._boxes

    @property
    def covers(self) -> Covers:
        """Its opaque rectangles."""
        if self._covers is None:
            self._covers = find_covers(self._make_first_rows(COVER_ROWS))
        return self._covers

    def _make_first_rows(self, count: int) -> Array:
        """The first rows, without making all of them."""
        if self._rows is not None:
            return self._rows[:count]
        table = self.command_table.copy()
        before = np.cumsum(table["count"]) - table["count"]
        table["count"] = np.clip(3 * count - before.astype(np.int64), 0, table["count"])
        return make_rows(self.vertex_array, self.index_array, table)

    @property
    def extent(self) -> Array:
        """A box that holds all of it."""
        if self._extent is None:
            self._extent = find_extent(self.vertex_array, self.command_table)
        return self._extent

    def take_from(self, equal: _DrawnList) -> None:
        """Take what was found out about a list that draws the same."""
        self._rows, self._boxes, self._covers = equal._rows, equal._boxes, equal._covers
        self._extent = equal._extent


class WindowPainter:
    """Draws the interface of each frame, where that is needed."""

    def __init__(self, device: Device, is_able: bool) -> None:
        self._device = device
        self._lists: tuple[_DrawnList, ...] = ()
        self._window: Box = (0, 0, 0, 0)
        self._whole_frames = 0
        self._trial = self._lost_marks = 0
        self._is_able = is_able and device.target.software
        self.drawn_boxes: tuple[Box, ...] = ()
        """What was drawn in the last frame."""

    def paint(self, is_empty: bool = False) -> None:
        """Draw the frame whose panels are complete; leave it to the window library where only that can draw it.

        Of an empty frame, whose panels are not there yet, only the ground is drawn.
        """
        written = self._device.take_written()
        if not self._is_able:
            self._device.clear_window((0, 0, *measure_window()))
            return
        imgui.render()
        picture = imgui.get_draw_data()
        scale, corner, (width, height) = picture.framebuffer_scale, picture.display_pos, measure_window()
        if (scale.x, scale.y) != (1.0, 1.0) or not self._has_known_memory(picture):
            self.redraw_all()
            self._device.clear_window((0, 0, width, height))
            return
        if is_empty:
            self._device.clear_window((0, 0, width, height))
        else:
            x, y = round(corner.x), round(corner.y)
            self._paint_changes(picture, (x, y, x + width, y + height), written)
        picture.display_size = ImVec2(0.0, 0.0)  # nothing is left to draw for the library

    def _paint_changes(self, picture: imgui.ImDrawData, window: Box, written: frozenset[int]) -> None:
        before, self._lists = self._lists, tuple(map(_copy_list, picture.cmd_lists))
        boxes = [window]
        if window != self._window:
            self._window = window
            self.redraw_all(RESIZED)
        if self._whole_frames > 0:
            self._whole_frames -= 1
        elif self._trial > TRIALS and not _is_reordered(before, self._lists):
            boxes = merge_boxes(_find_changes(before, self._lists, written), window)
        for box in boxes:
            self._paint_box(picture, box)
        self.drawn_boxes = tuple(boxes)

    def redraw_all(self, frames: int = 1) -> None:
        """Draw the next frames whole."""
        self._whole_frames = max(self._whole_frames, frames)

    def leave_mark(self) -> None:
        """Draw the pixel of a trial; to be called before a frame is shown."""
        if self._is_able and self._trial < TRIALS:
            self._device.clear_window((0, 0, 1, 1), _make_mark(self._trial))

    def check_mark(self) -> None:
        """Leave all frames to the library if the pixel of a trial is gone; to be called after a frame is shown."""
        if not self._is_able or self._trial > TRIALS:
            return
        if self._trial == TRIALS or self._device.read_window_pixel()[0] == round(255 * _make_mark(self._trial)[0]):
            self._trial += 1
        else:  # perhaps only because the size of the window has changed
            self._lost_marks += 1
            self._is_able = self._lost_marks < TRIALS

    def _paint_box(self, picture: imgui.ImDrawData, box: Box) -> None:
        """Draw what lies in a box. Commands that are clipped to nothing cost nothing."""
        tables = [view_commands(lines) for lines in picture.cmd_lists]
        originals = [table.copy() for table in tables]
        if not self._skip_covered(tables, box):
            left, top, right, bottom = box
            self._device.clear_window((left - self._window[0], self._window[3] - bottom, right - left, bottom - top))
        for table in tables:
            clips = table["clip"]
            np.maximum(clips[:, :2], box[:2], out=clips[:, :2])
            np.minimum(clips[:, 2:], box[2:], out=clips[:, 2:])
        imgui.backends.opengl3_render_draw_data(picture)
        for table, original in zip(tables, originals, strict=True):
            table[:] = original

    def _skip_covered(self, tables: Sequence[Array], box: Box) -> bool:
        """Take out of the commands what something opaque covers in a box; False if nothing covers all of it."""
        for number in reversed(range(len(tables))):
            row = find_last_cover(self._lists[number].covers, box)
            if row is None:
                continue
            for table in tables[:number]:
                table["count"] = 0
            left = 3 * row
            for command in tables[number]:
                skipped = min(left, int(command["count"]))
                command["first_index"] += skipped
                command["count"] -= skipped
                left -= skipped
            return True
        return False

    def _has_known_memory(self, picture: imgui.ImDrawData) -> bool:
        """True if lists lie in memory as we read them, which is looked at once: it belongs to the library's version."""
        if self._trial == 0:
            self._is_able = all(map(_has_known_layout, picture.cmd_lists))
        return self._is_able


def measure_window() -> tuple[int, int]:
    """Width and height of the window in pixels."""
    size, scale = imgui.get_io().display_size, imgui.get_io().display_framebuffer_scale
    return round(size.x * scale.x), round(size.y * scale.y)


def view_commands(lines: imgui.ImDrawList) -> Array:
    """The commands of a list in place: what is changed here is drawn so."""
    commands = lines.cmd_buffer
    count = commands.size()
    if not count:
        return np.empty(0, COMMAND)
    memory = (ctypes.c_uint8 * (count * COMMAND.itemsize)).from_address(commands.data_address())
    return np.ctypeslib.as_array(memory).view(COMMAND)


def _find_changes(before: Sequence[_DrawnList], after: Sequence[_DrawnList], written: frozenset[int]) -> list[Box]:
    """Where two frames differ, and where pictures have other pixels."""
    earlier, boxes = {drawn.name: drawn for drawn in before}, list[Box]()
    for drawn in after:
        past = earlier.pop(drawn.name, None)
        if past is None:
            boxes += surround(drawn.boxes)
            continue
        if past.memory != drawn.memory and are_mostly_new(past.vertex_array, drawn.vertex_array):
            boxes += [*surround(past.extent), *surround(drawn.extent)]
        elif past.memory != drawn.memory:
            boxes += find_changed_boxes(past.rows, drawn.rows, past.boxes, drawn.boxes)
        else:
            drawn.take_from(past)
        if written and np.isin(drawn.command_table["texture"], list(written)).any():
            boxes += find_picture_boxes(drawn.command_table, drawn.boxes, written)
    return boxes + [box for gone in earlier.values() for box in surround(gone.boxes)]


def _is_reordered(before: Sequence[_DrawnList], after: Sequence[_DrawnList]) -> bool:
    """True if lists that both frames have lie above each other in another order."""
    names, earlier = {drawn.name for drawn in after}, {drawn.name for drawn in before}
    return [drawn.name for drawn in before if drawn.name in names] != [
        drawn.name for drawn in after if drawn.name in earlier
    ]


def _copy_list(lines: imgui.ImDrawList) -> _DrawnList:
    vertices, indices, commands = lines.vtx_buffer, lines.idx_buffer, lines.cmd_buffer
    return _DrawnList(
        str(lines._owner_name),
        _copy_bytes(vertices, 4 * VERTEX),
        _copy_bytes(indices, 4),
        _copy_bytes(commands, COMMAND.itemsize),
    )


def _copy_bytes(vector: Any, width: int) -> bytes:
    count = vector.size()
    return ctypes.string_at(vector.data_address(), count * width) if count else b""


def _has_known_layout(lines: imgui.ImDrawList) -> bool:
    """True if what the library says of a list is where we look for it in memory."""
    drawn = _copy_list(lines)
    if not drawn.indices:
        return True
    table, vertex = drawn.command_table, np.frombuffer(drawn.vertices, np.float32).reshape(-1, VERTEX)[-1]
    place = lines.vtx_buffer[lines.vtx_buffer.size() - 1].pos
    last_index = lines.idx_buffer[lines.idx_buffer.size() - 1]
    are_ends_known = (place.x, place.y) == (vertex[0], vertex[1]) and last_index == drawn.index_array[-1]
    return are_ends_known and all(
        (tuple(row["clip"]), row["first_vertex"], row["first_index"], row["count"])
        == (tuple(command.clip_rect), command.vtx_offset, command.idx_offset, command.elem_count)
        for row, command in zip(table, lines.cmd_buffer, strict=True)
    )


def _make_mark(trial: int) -> tuple[float, float, float]:
    """The color of a trial's pixel."""
    return (1.0 + trial) / (1.0 + TRIALS), 0.0, 0.0
