"""Pictures on disk, by OpenImageIO alone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO as oiio


def write_exr(path: Path, parts: dict[str, np.ndarray], formats: dict[str, str]) -> Path:
    """A multi-part EXR straight from OpenImageIO: layer -> [h, w, c]."""
    letters = {1: ("Z",), 2: ("X", "Y"), 3: ("X", "Y", "Z"), 4: ("R", "G", "B", "A")}
    specs = []
    for name, array in parts.items():
        spec = oiio.ImageSpec(array.shape[1], array.shape[0], array.shape[2], formats[name])
        spec.channelnames = tuple(f"{name}.{letter}" for letter in letters[array.shape[2]])
        spec.attribute("oiio:subimagename", name)
        spec.attribute("Camera", "Lens 50")
        specs.append(spec)
    file = create_output(path)
    assert file.open(str(path), tuple(specs))
    for index, (spec, array) in enumerate(zip(specs, parts.values(), strict=True)):
        assert index == 0 or file.open(str(path), spec, "AppendSubimage")
        assert file.write_image(array)
    assert file.close()
    return path


def create_output(path: Path) -> oiio.ImageOutput:
    """OpenImageIO's writer of the format that the suffix names."""
    output = oiio.ImageOutput.create(str(path))
    assert output is not None, oiio.geterror()
    return output


def read(path: Path | str, part: int = 0) -> np.ndarray:
    """The pixels of one part, as float32."""
    pixels = oiio.ImageBuf(str(path), part, 0).get_pixels(oiio.FLOAT)
    assert pixels is not None, path
    return np.asarray(pixels)


def header(path: Path | str, part: int = 0) -> oiio.ImageSpec:
    return oiio.ImageBuf(str(path), part, 0).spec()
