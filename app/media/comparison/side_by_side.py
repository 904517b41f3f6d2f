"""Two sets of pictures side by side, with what differs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from halation.nodes import Kind

from ...color.transforms import Array
from ..pictures.writer import write
from .contact_sheet import data_shown, sheet, shown
from .metrics import amplified


@dataclass(frozen=True)
class Pair:
    """A picture before and after, [h, w, c]; None where there is none, of at least one. `view` shows light."""

    before: Array | None
    after: Array | None
    light: bool
    view: str = ""


def write_beside(path: Path, pairs: Mapping[str, Pair], titles: tuple[str, str]) -> None:
    """A row for each pair: before, after, and the difference with its largest as white. Raises OutputError."""
    cells: dict[str, Array] = {}
    for name, pair in pairs.items():
        there = [picture for picture in (pair.before, pair.after) if picture is not None]
        numbers = np.concatenate([picture[np.isfinite(picture)].ravel() for picture in there])
        low, high = (float(numbers.min()), float(numbers.max())) if numbers.size else (0.0, 1.0)
        for title, picture in zip(titles, (pair.before, pair.after), strict=True):
            if picture is None:
                cells[f"{name}: not in {title}"] = np.zeros((*there[0].shape[:2], 3), np.float32)
            elif pair.light:
                cells[f"{name}: {title}"] = shown(picture, pair.view)
            else:
                cells[f"{name}: {title}"] = data_shown(picture, low, high if high > low else low + 1.0)
        both = there if len(there) == len(titles) else (there[0], np.zeros_like(there[0]))
        cells[f"{name}: difference"] = amplified(both[1], both[0])
    write(path, {"image": sheet(cells, len(titles) + 1)}, kinds={"image": Kind.IMAGE}, view="none")
