"""The window as a picture file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from halation.nodes import Kind

from ... import media
from ...color.display import NO_VIEW
from ...color.transforms import decode_srgb
from ...resources.sandbox import UNRESTRICTED


def save_screenshot(path: Path, pixels: np.ndarray) -> None:
    """Write [height, width, 3] of 8 bits, the same bits in a PNG. Raises OutputError."""
    named = path if path.suffix else path.with_suffix(".png")
    media.write_picture(
        named, {"image": decode_srgb(pixels / 255.0)}, kinds={"image": Kind.IMAGE}, view=NO_VIEW, sandbox=UNRESTRICTED
    )
