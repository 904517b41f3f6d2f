"""Writes pairs of pictures side by side, with their differences."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from halation.nodes import Kind
from msgspec import Struct

from ...color.transforms import Array
from ...resources.sandbox import Sandbox
from ..pictures.writer import write_picture
from .contact_sheet import make_sheet, show_data, show_light
from .metrics import amplify_difference


class PicturePair(Struct, frozen=True):
    """A picture before and after, [h, w, c]; one of them may be None. `view` shows light."""

    before: Array | None
    after: Array | None
    is_light: bool
    view: str = ""


def write_side_by_side(path: Path, pairs: Mapping[str, PicturePair], titles: tuple[str, str], sandbox: Sandbox) -> None:
    """A row for each pair: before, after, and the difference with its largest as white. Raises OutputError."""
    cells: dict[str, Array] = {}
    for name, pair in pairs.items():
        pictures = [picture for picture in (pair.before, pair.after) if picture is not None]
        numbers = np.concatenate([picture[np.isfinite(picture)].ravel() for picture in pictures])
        low, high = (float(numbers.min()), float(numbers.max())) if numbers.size else (0.0, 1.0)
        for title, picture in zip(titles, (pair.before, pair.after), strict=True):
            if picture is None:
                cells[f"{name}: not in {title}"] = np.zeros((*pictures[0].shape[:2], 3), np.float32)
            elif pair.is_light:
                cells[f"{name}: {title}"] = show_light(picture, pair.view)
            else:
                cells[f"{name}: {title}"] = show_data(picture, low, high if high > low else low + 1.0)
        pair_of_pictures = pictures if len(pictures) == len(titles) else (pictures[0], np.zeros_like(pictures[0]))
        cells[f"{name}: difference"] = amplify_difference(pair_of_pictures[1], pair_of_pictures[0])
    write_picture(
        path, {"image": make_sheet(cells, len(titles) + 1)}, kinds={"image": Kind.IMAGE}, view="none", sandbox=sandbox
    )
