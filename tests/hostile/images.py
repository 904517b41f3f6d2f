"""Damaged files of every kind that a graph can name: pictures, tables of colors, meshes, shaders."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random
from tempfile import mkdtemp

import numpy as np
import OpenImageIO as oiio
from cases import Case
from relatives import write_relatives

PICTURES = (
    "exr",
    "png",
    "jpg",
    "tif",
    "hdr",
    "tga",
    "bmp",
    "webp",
    "ppm",
    "pfm",
    "dpx",
    "sgi",
    "gif",
    "ico",
    "jp2",
    "cin",
)
CUBE = "LUT_3D_SIZE 2\n" + "".join(f"{r} {g} {b}\n" for b in (0, 1) for g in (0, 1) for r in (0, 1))
GLTF = {
    "asset": {"version": "2.0"},
    "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri": f"data:application/octet-stream;base64,{'A' * 48}"}],
}

TEXTS = {
    "cube": CUBE,
    "spi1d": "Version 1\nFrom 0.0 1.0\nLength 2\nComponents 1\n{\n0.0\n1.0\n}\n",
    "spi3d": "SPILUT 1.0\n3 3\n2 2 2\n"
    + "".join(f"{r} {g} {b} {r} {g} {b}\n" for r in (0, 1) for g in (0, 1) for b in (0, 1)),
    "cc": '<ColorCorrection id="a"><SOPNode><Slope>1 1 1</Slope><Offset>0 0 0</Offset><Power>1 1 1</Power></SOPNode>'
    "</ColorCorrection>",
    "clf": '<?xml version="1.0"?><ProcessList id="a" compCLFversion="3"><Matrix inBitDepth="32f" outBitDepth="32f">'
    '<Array dim="3 3">1 0 0 0 1 0 0 0 1</Array></Matrix></ProcessList>',
    "obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n",
    "ply": "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
    "gltf": json.dumps(GLTF),
    "fs": '/*{"ISFVSN": "2", "INPUTS": [{"NAME": "amount", "TYPE": "float", "DEFAULT": 0.5}]}*/\n'
    "void main() { gl_FragColor = vec4(amount); }\n",
}
"""Small files of the other kinds, by the ending of their name."""


def write_corpus(folder: Path) -> list[Path]:
    """One small valid file of every kind."""
    noise = np.random.default_rng(5).random((12, 17, 3), np.float32)
    for ending in PICTURES:
        output = oiio.ImageOutput.create(f"a.{ending}")
        if output is None:
            oiio.geterror()  # it would be printed in the end
            continue
        buffer = oiio.ImageBuf(noise)
        buffer.write(str(folder / f"whole.{ending}"))
    tiled = oiio.ImageSpec(64, 40, 4, "half")
    tiled.tile_width = tiled.tile_height = 16
    buffer = oiio.ImageBuf(tiled)
    oiio.ImageBufAlgo.fill(buffer, (0.1, 0.2, 0.3, 1.0))
    buffer.write(str(folder / "tiled.exr"))
    for ending, text in TEXTS.items():
        (folder / f"whole.{ending}").write_text(text)
    return sorted(path for path in folder.iterdir() if path.stat().st_size)


def collect_files(collection: Path | None) -> list[Path]:
    """Our own small files and valid ones of rare kinds, or, where a folder is named, all files in it and below."""
    if collection is None:
        rare = list(write_relatives(Path(mkdtemp(prefix="hostile-rare-"))))
        return write_corpus(Path(mkdtemp(prefix="hostile-corpus-"))) + rare
    return sorted(path for path in collection.rglob("*") if path.is_file() and path.stat().st_size < 64 << 20)


def build_cases(seed: int, count: int, collection: Path | None = None) -> Iterator[Case]:
    """So many cases: each file once as it is, as far as half of them go, then damaged copies of any.

    Of our own files those that are whole are chosen by the seed.
    """
    sources = collect_files(collection)
    whole = len(sources) if collection else min(len(sources), count // 2)
    if not collection:
        Random(f"images {seed}").shuffle(sources)
    for number in range(count):
        rng = Random(f"images {seed} {number}")
        source = sources[number] if number < whole else rng.choice(sources)
        data = source.read_bytes()
        if number >= whole:
            data = damage(rng, data)
        yield Case(f"image-{seed}-{number}-{source.name}", _writer(data, source.suffix), _command(rng, source.suffix))


def damage(rng: Random, whole: bytes) -> bytes:
    """A copy: cut, with bytes changed (most of them near the start), or with a part repeated, zeroed or doubled."""
    data = bytearray(whole)
    kind = rng.randrange(5)
    if kind == 0:
        del data[rng.randrange(len(data)) :]
    elif kind == 1:
        at, length = rng.randrange(len(data)), rng.randrange(1, 64)
        data[at : at + length] = rng.choice((bytes(length), b"\xff" * length, bytes(data[:length]), bytes(data)))
    else:
        reach = len(data) if kind == 2 else min(len(data), 400)
        for _ in range(rng.choice((1, 2, 8, 40))):
            data[rng.randrange(reach)] = rng.choice((0, 255, 127, 128, 48 + rng.randrange(10), rng.randrange(256)))
    return bytes(data)


def _graph(name: str, ending: str) -> dict[str, object]:
    node: dict[str, object] = {"type": "read_image", "values": {"path": name}}
    if ending in (".cube", ".spi1d", ".spi3d", ".cc", ".clf"):
        node = {"type": "lut_file", "values": {"file": name}}
    elif ending in (".obj", ".ply", ".gltf"):
        node = {"type": "scene", "values": {"scene": "file", "file": name}}
    elif ending == ".fs":
        node = {"type": "isf", "file": name}
    links = {"outputs.image": "n.color" if node["type"] == "scene" else "n.out"}
    if node["type"] == "lut_file":
        links["n.image"] = "s.out"
    return {
        "halation": 1,
        "settings": {"size": [24, 16]},
        "outputs": {"image": {"type": "Image"}},
        "nodes": {"n": node, "s": {"type": "noise"}},
        "links": links,
    }


def _writer(data: bytes, ending: str) -> Callable[[Path], None]:
    def prepare(folder: Path) -> None:
        (folder / f"file{ending}").write_bytes(data)
        (folder / "graph.json").write_text(json.dumps(_graph(f"file{ending}", ending)))

    return prepare


def _command(rng: Random, ending: str) -> tuple[str, ...]:
    render = ("render", "graph.json", "-o", "out.exr", "--timeout", "8")
    if ending.lstrip(".") in TEXTS:
        return rng.choice((render, render, ("check", "graph.json")))
    return rng.choice((render, render, ("info", f"file{ending}"), ("info", f"file{ending}", "--json")))
