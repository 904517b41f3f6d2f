"""The cryptomattes of a render: their layers by rank, and the names that their manifests give to ids.

Friedman and Jones 2015, as specified by Psyop: the header says `cryptomatte/KEY/name`, and the manifest of that name in
`cryptomatte/KEY/manifest`, or in a file beside the picture that `cryptomatte/KEY/manif_file` names.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import cast

from ...nodes import Matte
from .layers import plain
from .naming import Role
from .passes import Pass
from .survey import Survey

_NAME = re.compile(r"cryptomatte/(\w+)/name")
_ROLES = MappingProxyType({
    Role.CRYPTOMATTE_OBJECT: "object", Role.CRYPTOMATTE_MATERIAL: "material", Role.CRYPTOMATTE_ASSET: "asset",
    Role.CRYPTOMATTE: "",
})


def mattes_of(found: Survey) -> tuple[Matte, ...]:
    """All of them, in the order of the layers. A manifest that cannot be read has no names."""
    groups: dict[str, list[Pass]] = {}
    for item in found.passes:
        if item.role in _ROLES:
            groups.setdefault(item.layer.full[:-2], []).append(item)
    said = found.header.attributes
    keys = {plain(str(value)): match[1] for name, value in said.items() if (match := _NAME.fullmatch(name))}
    made: list[Matte] = []
    for name, items in groups.items():
        items.sort(key=lambda item: item.rank)
        key = keys.get(plain(name))
        ids = _manifest(said, key, Path(found.header.info.path).parent) if key else {}
        role = items[0].role
        assert role is not None
        made.append(Matte(_ROLES[role], tuple(item.layer.full for item in items), MappingProxyType(ids)))
    return tuple(made)


def _manifest(attributes: Mapping[str, object], key: str, folder: Path) -> dict[str, int]:
    """Ids by name."""
    try:
        said = attributes.get(f"cryptomatte/{key}/manifest")
        beside = attributes.get(f"cryptomatte/{key}/manif_file")
        file = folder / Path(str(beside)).name
        text = file.read_text(encoding="utf-8") if said is None and beside else str(said or "{}")
        found = json.loads(text)
        names = cast("dict[str, object]", found if isinstance(found, dict) else {})
        return {name: int(str(number), 16) for name, number in names.items()}
    except (OSError, ValueError):
        return {}
