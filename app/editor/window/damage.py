"""Which parts of the window differ from the frame before, found in the triangles of both frames.

The interface library draws each frame anew, as lists of triangles, one list for each panel. A software rasterizer
spends most of a frame on filling them: a window of 1920x1080 takes 75 ms of processor time (llvmpipe), though often
only a button or one panel differs. So triangles are compared with those of the frame before, and only the rectangles
are drawn in which a triangle has come, gone or changed, or whose picture has other pixels.

A row holds all that decides the pixels of a triangle: its three vertices, the rectangle that it is clipped to, and its
texture. Triangles are drawn in the order of rows. Rows that are equal at the start and at the end of both lists have
the same pixels, but for what the rows between them draw; so the boxes of those are all that can differ.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

Array = np.ndarray
Box = tuple[int, int, int, int]
"""Left, top, right and bottom in pixels of the screen, row 0 on top: the window does not begin at 0,0."""

VERTEX = 5
"""Numbers of a vertex: x, y, u, v, color."""

COMMAND = np.dtype(
    {
        "names": ["clip", "shared_texture", "texture", "first_vertex", "first_index", "count", "callback"],
        "formats": [("<f4", 4), "<u8", "<u8", "<u4", "<u4", "<u4", "<u8"],
        "offsets": [0, 16, 24, 32, 36, 40, 48],
        "itemsize": 72,
    }
)
"""A draw command in memory (`ImDrawCmd`): `texture` is its name in OpenGL, unless `shared_texture` is set."""

_CLIP, _TEXTURE = 3 * VERTEX, 3 * VERTEX + 4
_ROW = _TEXTURE + 4

GAP = 24
"""Equal triangles between two changes that make two boxes of them: a word of a label has about as many."""

MOST_BOXES = 16
"""The most boxes of a list before they count as one: beyond, merging them takes longer than drawing."""

PASS_COST = 40_000
"""What one more rectangle costs, in pixels: all lists are uploaded again for it (0.4 ms, 10 ns for a pixel)."""

MANY = 4_000
"""Vertices of a list from which on it is first looked whether most of them differ: 300 nodes have 20,000."""


def are_mostly_new(before: Array, after: Array) -> bool:
    """True if most vertices, uint32 [n, 5], of a large list differ, as while a graph is panned.

    Counted from the start and from the end: something may have come or gone between vertices that stay.
    """
    shorter = min(len(before), len(after))
    if shorter < MANY:
        return False
    spans = (slice(None, shorter), slice(-shorter, None))
    return all(2 * np.count_nonzero((before[span] != after[span]).any(1)) > shorter for span in spans)


def find_extent(vertices: Array, commands: Array) -> Array:
    """A box that holds all that a list draws, float [1, 4]; left is beyond right where nothing is drawn."""
    places, clips = np.ascontiguousarray(vertices[:, :2].T).view(np.float32), commands["clip"]
    low = np.maximum(np.fmin.reduce(places, 1, initial=np.inf), clips[:, :2].min(0, initial=np.inf))
    high = np.minimum(np.fmax.reduce(places, 1, initial=-np.inf), clips[:, 2:].max(0, initial=-np.inf))
    return np.concatenate([low, high])[None]


def make_rows(vertices: Array, indices: Array, commands: Array) -> Array:
    """The triangles of a list as rows of integers: equal rows draw equal pixels.

    `vertices` are uint32 [n, 5], `indices` whole numbers, `commands` of the type `COMMAND`.
    """
    if not len(commands):
        return np.empty((0, _ROW), np.uint32)
    spans = zip(*(commands[name].tolist() for name in ("first_index", "count", "first_vertex")), strict=True)
    corners = np.concatenate([indices[first : first + count].astype(np.int64) + start for first, count, start in spans])
    rows = np.empty((len(corners) // 3, _ROW), np.uint32)
    rows[:, :_CLIP] = vertices[corners].reshape(-1, _CLIP)
    facts = np.empty((len(commands), 8), np.uint32)
    facts[:, :4] = np.ascontiguousarray(commands["clip"]).view(np.uint32)
    facts[:, 4:6] = np.ascontiguousarray(commands["shared_texture"]).view(np.uint32).reshape(-1, 2)
    facts[:, 6:] = np.ascontiguousarray(commands["texture"]).view(np.uint32).reshape(-1, 2)
    rows[:, _CLIP:] = np.repeat(facts, commands["count"] // 3, axis=0)
    return rows


def find_boxes(rows: Array) -> Array:
    """The box of each triangle, clipped: float [n, 4]; left is beyond right where nothing is drawn."""
    numbers = np.ascontiguousarray(rows).view(np.float32)
    a, b, c = (numbers[:, start : start + 2] for start in range(0, _CLIP, VERTEX))
    low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
    clip = numbers[:, _CLIP:_TEXTURE]
    return np.hstack([np.maximum(low, clip[:, :2]), np.minimum(high, clip[:, 2:])])


def find_changed_boxes(before: Array, after: Array, boxes_before: Array, boxes_after: Array) -> list[Box]:
    """The boxes in which two lists of rows, whose triangles have these boxes, may draw other pixels."""
    shorter = min(len(before), len(after))
    if len(before) == len(after):
        changed = np.flatnonzero((before != after).any(1))
        groups = np.split(changed, np.flatnonzero(np.diff(changed) > GAP) + 1) if len(changed) else []
        if len(groups) > MOST_BOXES:
            groups = [changed]
        return [box for group in groups for box in surround(np.vstack([boxes_before[group], boxes_after[group]]))]
    same = (before[:shorter] == after[:shorter]).all(1)
    start = shorter if same.all() else int(same.argmin())
    left = shorter - start
    same = (before[len(before) - left :] == after[len(after) - left :]).all(1)[::-1]
    end = left if same.all() else int(same.argmin())
    return surround(np.vstack([boxes_before[start : len(before) - end], boxes_after[start : len(after) - end]]))


def find_picture_boxes(commands: Array, boxes: Array, textures: Collection[int]) -> list[Box]:
    """The boxes of pictures whose pixels have changed, by the names of their textures in OpenGL.

    `boxes` are those of all triangles.
    """
    shows = np.isin(commands["texture"], list(textures)) & (commands["shared_texture"] == 0)
    ends = np.cumsum(commands["count"] // 3)
    return [
        box
        for number in np.flatnonzero(shows).tolist()
        for box in surround(boxes[ends[number] - commands["count"][number] // 3 : ends[number]])
    ]


COVER_ROWS = 500
"""The first triangles of a list, among which opaque rectangles are looked for: backgrounds are drawn first."""

Covers = tuple[Array, Array]
"""Rows at which opaque rectangles of one color begin, and their boxes."""


def find_covers(rows: Array) -> Covers:
    """The opaque rectangles of a list, which hide what lies below them.

    Panels lie on backgrounds that lie on each other: four layers, each as large as the panel, and three are in vain.
    """
    if len(rows) < 2:
        return np.empty(0, np.intp), np.empty((0, 4), np.float32)
    is_solid = (rows[:, _TEXTURE] | rows[:, _TEXTURE + 1] != 0) & (rows[:, 4] >> 24 == 255)
    for number in (2, 3, 4):  # u, v and the color are those of the first vertex
        for vertex in (VERTEX, 2 * VERTEX):
            is_solid &= rows[:, vertex + number] == rows[:, number]
    starts = np.flatnonzero(is_solid[:-1] & is_solid[1:])
    first, second = (rows[at, :_CLIP].reshape(-1, 3, VERTEX)[..., :2] for at in (starts, starts + 1))
    starts = starts[_are_rectangles(first, second)]
    return starts, find_boxes(rows[starts])


def find_last_cover(covers: Covers, box: Box) -> int | None:
    """The last row from which on nothing below can be seen in a box."""
    starts, boxes = covers
    covering = starts[(boxes[:, :2] <= box[:2]).all(1) & (boxes[:, 2:] >= box[2:]).all(1)]
    return int(covering[-1]) if len(covering) else None


def _are_rectangles(first: Array, second: Array) -> Array:
    """Whether pairs of triangles (a, b, c), (a, c, d) are rectangles along the axes."""
    a, b, c = np.moveaxis(np.ascontiguousarray(first).view(np.float32), 1, 0)
    a2, c2, d = np.moveaxis(np.ascontiguousarray(second).view(np.float32), 1, 0)
    is_split = (a == a2).all(1) & (c == c2).all(1)
    x, y = (a[:, 0], c[:, 0]), (a[:, 1], c[:, 1])
    return is_split & (b[:, 0] == x[1]) & (b[:, 1] == y[0]) & (d[:, 0] == x[0]) & (d[:, 1] == y[1])


def surround(boxes: Array) -> list[Box]:
    """The box of all boxes of triangles, or none if they draw nothing."""
    boxes = boxes[(boxes[:, 0] < boxes[:, 2]) & (boxes[:, 1] < boxes[:, 3])]
    if not len(boxes):
        return []
    left, top = np.floor(boxes[:, :2].min(0)).tolist()
    right, bottom = np.ceil(boxes[:, 2:].max(0)).tolist()
    return [(int(left), int(top), int(right), int(bottom))]


def merge_boxes(boxes: Sequence[Box], window: Box) -> list[Box]:
    """Few rectangles of the window that cover all boxes, and overlap nowhere: merged where that costs less to draw."""
    merged: list[Box] = []
    for box in boxes:
        clipped = _intersect(box, window)
        if _area(clipped):
            merged = _add_box(merged, clipped)
    return merged


def _add_box(merged: list[Box], box: Box) -> list[Box]:
    others = list(merged)
    while True:
        near = next((other for other in others if _costs_less(other, box)), None)
        if near is None:
            return [*others, box]
        others.remove(near)
        box = _unite(near, box)


def _costs_less(first: Box, second: Box) -> bool:
    """True if two boxes overlap, or are better drawn as one."""
    if _area(_intersect(first, second)):
        return True
    return _area(_unite(first, second)) <= _area(first) + _area(second) + PASS_COST


def _area(box: Box) -> int:
    return max(box[2] - box[0], 0) * max(box[3] - box[1], 0)


def _unite(first: Box, second: Box) -> Box:
    return min(first[0], second[0]), min(first[1], second[1]), max(first[2], second[2]), max(first[3], second[3])


def _intersect(first: Box, second: Box) -> Box:
    return max(first[0], second[0]), max(first[1], second[1]), min(first[2], second[2]), min(first[3], second[3])
