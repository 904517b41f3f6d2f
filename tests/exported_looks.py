"""A look that tests export, what is in its page, and what the reference compiler says of its programs."""

from __future__ import annotations

import json
import shutil
import subprocess
import zlib
from base64 import b64decode
from pathlib import Path

import numpy as np
from halation import document
from halation.compiler import Plan, Request, compile_graph
from halation.export.package.planning import TARGET
from halation.inputs.provider import MediaProvider
from halation.presets import paths
from halation.resources.sandbox import UNRESTRICTED

VALIDATOR = shutil.which("glslangValidator")
LOOK = {
    "nodes": {
        "glow": {"type": "bloom", "values": {"radius": 0.1}},
        "tone": {"type": "saturation", "values": {"saturation": 1.0}},
        "grain": {"type": "film_grain", "values": {"amount": 0.1}},
    },
    "links": {
        "glow.image": "light.out",
        "tone.image": "glow.out",
        "grain.image": "tone.out",
        "outputs.image": "grain.out",
    },
    "controls": {
        "stops": {"target": "light.stops"},
        "glow": {"target": "glow.intensity"},
        "size": {"target": "glow.radius"},
        "color": {"target": "tone.saturation", "label": "Color"},
    },
}


def validate(texts: dict[str, str], folder: Path, *words: str) -> list[str]:
    """What the reference compiler of Khronos finds wrong with shaders by file name."""
    assert VALIDATOR is not None
    for name, text in texts.items():
        (folder / name).write_text(text)
    command = [VALIDATOR, *words, *sorted(str(folder / name) for name in texts)]
    said = subprocess.run(command, capture_output=True, text=True, cwd=folder).stdout
    return [line for line in said.splitlines() if line.startswith("ERROR")]


def plan_presets() -> list[Plan]:
    pictures = MediaProvider(sandbox=UNRESTRICTED)
    return [
        compile_graph(document.load(path, sandbox=UNRESTRICTED), Request(), pictures, target=TARGET) for path in paths()
    ]


def open_page(text: str) -> tuple[dict, list[bytes]]:
    """The content of a page and its pixels."""
    packed = json.loads(text.partition('<script id="package" type="application/json">')[2].partition("</script>")[0])
    content = json.loads(zlib.decompress(b64decode(packed["content"])))
    blobs = []
    for stride, blob in packed["blobs"]:
        planes = np.frombuffer(zlib.decompress(b64decode(blob)), np.uint8)
        blobs.append(planes.reshape(stride, -1).T.tobytes())
    return content, blobs
