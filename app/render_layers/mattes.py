"""The cryptomattes of a render: their layers by rank, and the names that their manifests give to ids.

As specified by Friedman and Jones 2015 and Psyop: the header has `cryptomatte/KEY/name`, and the manifest of that name
in `cryptomatte/KEY/manifest`, or in a file beside the picture that `cryptomatte/KEY/manif_file` names.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import cast

import numpy as np
from halation.nodes import Kind, Matte, float_bits
from msgspec import Struct

from ..color.transforms import Array
from ..errors import InputError
from ..media.layers import normalize_name
from ..media.pixels import read_layer
from ..resources.input_files import read_bytes
from ..resources.sandbox import Sandbox
from .analysis import RenderAnalysis, analyze_render
from .naming import Role
from .recognition import RenderPass

_NAME = re.compile(r"cryptomatte/(\w+)/name")
_ROLES = MappingProxyType(
    {
        Role.CRYPTOMATTE_OBJECT: "object",
        Role.CRYPTOMATTE_MATERIAL: "material",
        Role.CRYPTOMATTE_ASSET: "asset",
        Role.CRYPTOMATTE: "",
    }
)


def find_mattes(analysis: RenderAnalysis) -> tuple[Matte, ...]:
    """The cryptomattes of a file, in the order of the layers. A manifest that cannot be read has no names."""
    groups: dict[str, list[RenderPass]] = {}
    for item in analysis.passes:
        if item.role in _ROLES:
            groups.setdefault(item.layer.full_name[:-2], []).append(item)
    attributes = analysis.header.attributes
    keys = {
        normalize_name(str(value)): match[1] for name, value in attributes.items() if (match := _NAME.fullmatch(name))
    }
    mattes: list[Matte] = []
    for name, items in groups.items():
        items.sort(key=lambda item: item.rank)
        key = keys.get(normalize_name(name))
        ids = (
            _read_manifest(attributes, key, Path(analysis.header.info.path).parent, sandbox=analysis.sandbox)
            if key
            else {}
        )
        role = items[0].role
        assert role is not None
        mattes.append(Matte(_ROLES[role], tuple(item.layer.full_name for item in items), MappingProxyType(ids)))
    return tuple(mattes)


class IdMap(Struct, frozen=True):
    """The id that covers most of each pixel, [h, w] of uint32, 0 for none; and the names of ids."""

    ids: Array
    names: Mapping[int, str]

    def id_at(self, u: float, v: float) -> int:
        """The id at a point of the picture, given as fractions; 0 outside."""
        height, width = self.ids.shape
        x, y = math.floor(u * width), math.floor(v * height)
        return int(self.ids[y, x]) if 0 <= x < width and 0 <= y < height else 0


def read_id_map(path: str, first: str, sandbox: Sandbox) -> IdMap:
    """The ids of a picture, from the first layer of a cryptomatte.

    Raises:
        InputError: as `read`, also for a layer that is none of a cryptomatte.
    """
    matte = next(
        (matte for matte in find_mattes(analyze_render(path, sandbox=sandbox)) if matte.layers[0] == first),
        None,
    )
    if matte is None:
        raise InputError(f"{path}: '{first}' is no cryptomatte")
    ranks = read_layer(path, first, Kind.VECTOR, 4, sandbox=sandbox).array.astype(np.float32, copy=False)
    ids, covered = np.ascontiguousarray(ranks[..., 0::2]).view(np.uint32), ranks[..., 1::2]
    ids_on_top = np.where(covered[..., 1] > covered[..., 0], ids[..., 1], ids[..., 0])
    ids_on_top[~(covered.max(axis=2) > 0.0)] = 0
    return IdMap(ids_on_top, MappingProxyType({float_bits(bits): name for name, bits in matte.ids.items()}))


def _read_manifest(attributes: Mapping[str, object], key: str, folder: Path, sandbox: Sandbox) -> dict[str, int]:
    """Ids by name."""
    try:
        embedded = attributes.get(f"cryptomatte/{key}/manifest")
        file_name = attributes.get(f"cryptomatte/{key}/manif_file")
        file = folder / Path(str(file_name)).name
        is_beside = embedded is None and bool(file_name)
        text = read_bytes(file, sandbox).decode() if is_beside else str(embedded or "{}")
        parsed = json.loads(text)
        names = cast("dict[str, object]", parsed if isinstance(parsed, dict) else {})
        ids = {name: int(str(number), 16) for name, number in names.items()}
        return {name: number for name, number in ids.items() if 0 <= number < 2**32}
    except (InputError, ValueError, RecursionError):
        return {}
