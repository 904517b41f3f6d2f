"""Valid pictures of rare kinds: every depth, layout, window, tag and chunk that a reader may meet, undamaged."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator
from itertools import product
from pathlib import Path

import numpy as np
import OpenImageIO as oiio

Array = np.ndarray
NOISE = np.random.default_rng(5).random((12, 17, 4)).astype(np.float32)
LAYOUTS = {"y": 1, "ya": 2, "rgb": 3, "rgba": 4}
COMPRESSIONS = ("none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab")
GAMUTS = {
    "xyz": (1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0 / 3.0, 1.0 / 3.0),
    "zero": (0.0,) * 8,
    "line": (0.1, 0.1, 0.2, 0.2, 0.3, 0.3, 0.31, 0.33),
    "nan": (float("nan"),) * 8,
    "wide": (0.78, 0.30, 0.12, 1.49, 0.1, -0.08, 0.31, 0.33),
}
WINDOWS = ((0, 0, 17, 12), (-5, -3, 30, 20), (4, 2, 6, 5), (100, 100, 9, 9), (-40, -40, 10, 10))


def _spec(layout: str, format: str) -> oiio.ImageSpec:
    spec = oiio.ImageSpec(17, 12, LAYOUTS[layout], format)
    spec.channelnames = {"y": ("Y",), "ya": ("Y", "A"), "rgb": tuple("RGB"), "rgba": tuple("RGBA")}[layout]
    spec.alpha_channel = LAYOUTS[layout] - 1 if layout.endswith("a") else -1
    return spec


def _save(path: Path, spec: oiio.ImageSpec, array: Array = NOISE) -> None:
    output = oiio.ImageOutput.create(str(path))
    if output is None or not output.open(str(path), spec):
        oiio.geterror()
        return
    output.write_image(np.ascontiguousarray(array[..., : spec.nchannels]))
    output.close()


def _write_exrs(folder: Path) -> None:
    for layout, format, compression in product(LAYOUTS, ("half", "float", "uint"), COMPRESSIONS):
        spec = _spec(layout, format)
        spec.attribute("compression", compression)
        if compression in ("zip", "piz"):
            spec.tile_width = spec.tile_height = 8
        _save(folder / f"{layout}-{format}-{compression}.exr", spec)
    for number, (x, y, width, height) in enumerate(WINDOWS):
        spec = _spec("rgba", "half")
        spec.full_x, spec.full_y, spec.full_width, spec.full_height = x, y, width, height
        _save(folder / f"window{number}.exr", spec)
    for name, gamut in GAMUTS.items():
        spec = _spec("rgba", "half")
        spec.attribute("chromaticities", oiio.TypeDesc("float[8]"), gamut)
        _save(folder / f"gamut-{name}.exr", spec)
    alphas = NOISE.copy()
    alphas[..., 3] = np.array([0.0, 1e-8, -1.0, 2.0, np.nan, np.inf] * 34, np.float32).reshape(12, 17)
    for space in ("lin_ap1_scene", "arri_logc4", "srgb_rec709_scene"):
        spec = _spec("rgba", "float")
        spec.attribute("colorInteropID", space)
        _save(folder / f"alpha-{space}.exr", spec, alphas)
    parts = [_spec("rgba", "half"), _spec("y", "float"), _spec("rgb", "half")]
    for number, spec in enumerate(parts):
        spec.attribute("oiio:subimagename", f"part{number}")
    output = oiio.ImageOutput.create("parts.exr")
    assert output and output.open(str(folder / "parts.exr"), tuple(parts))
    for number, spec in enumerate(parts):
        assert number == 0 or output.open(str(folder / "parts.exr"), spec, "AppendSubimage")
        output.write_image(np.ascontiguousarray(NOISE[..., : spec.nchannels]))
    output.close()


def _write_tiffs(folder: Path) -> None:
    for layout, format in product(
        LAYOUTS, ("uint8", "int8", "uint16", "int16", "uint", "int", "half", "float", "double")
    ):
        for turn, alpha in ((1, 0), (6, 1)):
            spec = _spec(layout, format)
            spec.attribute("Orientation", turn)
            spec.attribute("oiio:UnassociatedAlpha", alpha)
            _save(folder / f"{layout}-{format}-{turn}.tif", spec)
    for bits in (1, 2, 4, 6, 10, 12, 14, 24):
        spec = _spec("rgb", "uint16" if bits > 8 else "uint8")
        spec.attribute("oiio:BitsPerSample", bits)
        _save(folder / f"bits{bits}.tif", spec)
        _save(folder / f"bits{bits}.dpx", spec)


def _chunk(name: bytes, body: bytes) -> bytes:
    return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))


def _write_pngs(folder: Path) -> None:
    chunks = {
        "plain": b"",
        "srgb": _chunk(b"sRGB", b"\0"),
        "chrm": _chunk(b"cHRM", struct.pack(">8I", 31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000)),
        "icc": _chunk(b"iCCP", b"profile\0\0" + zlib.compress(bytes(200))),
        "cicp": _chunk(b"cICP", bytes((9, 16, 0, 1))),
        "text": _chunk(b"tEXt", b"Title\0caf\xe9"),
        **{
            f"gama{number}": _chunk(b"gAMA", struct.pack(">I", number))
            for number in (0, 1, 35000, 45455, 100000, 2**31 - 1)
        },
    }
    kinds = [(0, depth, 1) for depth in (1, 2, 4, 8, 16)] + [
        (2, 8, 3),
        (2, 16, 3),
        (4, 8, 2),
        (4, 16, 2),
        (6, 8, 4),
        (6, 16, 4),
    ]
    kinds += [(3, depth, 1) for depth in (1, 2, 4, 8)]
    for (kind, depth, samples), (name, extra), interlaced in product(kinds, chunks.items(), (0, 1)):
        if interlaced and name != "plain":
            continue
        width, height = 8, 1 if interlaced else 5
        row = b"\0" + bytes((7 * place) % 256 for place in range((width * depth * samples + 7) // 8))
        passes = (1, 1, 2, 4) if interlaced else (width,) * height  # pixels of each row, by Adam7
        rows = b"".join(row[: 1 + (count * depth * samples + 7) // 8] for count in passes)
        palette = _chunk(b"PLTE", bytes(3 * 2**depth)) + _chunk(b"tRNS", bytes(2**depth)) if kind == 3 else b""
        header = _chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, depth, kind, 0, 0, interlaced))
        body = header + extra + palette + _chunk(b"IDAT", zlib.compress(rows)) + _chunk(b"IEND", b"")
        (folder / f"{kind}-{depth}-{name}-{interlaced}.png").write_bytes(b"\x89PNG\r\n\x1a\n" + body)


def _write_others(folder: Path) -> None:
    endings = (
        "jpg",
        "hdr",
        "tga",
        "bmp",
        "webp",
        "ppm",
        "pgm",
        "pfm",
        "dpx",
        "sgi",
        "gif",
        "ico",
        "rla",
        "iff",
        "fits",
        "jxl",
    )
    for ending, layout, format in product(endings, LAYOUTS, ("uint8", "uint16", "float")):
        _save(folder / f"{layout}-{format}.{ending}", _spec(layout, format))


def write_relatives(folder: Path) -> Iterator[Path]:
    """All of them, in a fixed order."""
    for write in (_write_exrs, _write_tiffs, _write_pngs, _write_others):
        write(folder)
    yield from sorted(path for path in folder.iterdir() if path.stat().st_size)
