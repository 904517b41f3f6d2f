"""Makes pfstmo.npz: Reinhard's and Drago's own operators on a corner of the sample, gray and in color.

Run once with Debian's pfstools and pfstmo 2.2.0 (`apt-get install pfstools pfstmo`); the programs are only called:

    python tests/data/make_pfstmo.py
"""

from __future__ import annotations

import subprocess
import tempfile
from pathlib import Path

import numpy as np
import OpenImageIO as oiio

HERE = Path(__file__).parent
COMMANDS = {"reinhard": "pfstmo_reinhard02 -k 0.18", "drago": "pfstmo_drago03 -b 0.85"}


def toned(picture: np.ndarray, command: str, folder: Path) -> np.ndarray:
    """What a program makes of [h, w, 3] of float32, through PFM files (bottom row first)."""
    height, width, _ = picture.shape
    source, result = folder / "in.pfm", folder / "out.pfm"
    source.write_bytes(f"PF\n{width} {height}\n-1.0\n".encode() + picture[::-1].astype("<f4").tobytes())
    subprocess.run(f"pfsinpfm {source} | {command} | pfsoutpfm {result}", shell=True, check=True, cwd=folder)
    head, size, scale, pixels = result.read_bytes().split(b"\n", 3)
    assert head == b"PF" and size.split() == [str(width).encode(), str(height).encode()]
    order = "<f4" if float(scale) < 0.0 else ">f4"
    return np.frombuffer(pixels, order).reshape(height, width, 3)[::-1].astype(np.float32)


def main() -> None:
    """Write pfstmo.npz beside this file."""
    frame = oiio.ImageBuf(str(HERE.parents[1] / "presets" / "samples" / "neon.exr")).get_pixels(oiio.FLOAT)[..., :3]
    color = np.maximum(frame[20:240:6, 10:470:8], 1e-3).astype(np.float32)
    gray = np.repeat(color.max(-1, keepdims=True), 3, -1)
    made: dict[str, np.ndarray] = {"color": color, "gray": gray}
    with tempfile.TemporaryDirectory() as folder:
        for name, command in COMMANDS.items():
            for kind in ("color", "gray"):
                made[f"{name}_{kind}"] = toned(made[kind], command, Path(folder))
    np.savez_compressed(HERE / "pfstmo.npz", **made)


if __name__ == "__main__":
    main()
