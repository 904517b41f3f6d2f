"""Renders as nodes ask for them: layers by role, what their numbers mean, the camera, and cryptomattes."""

from __future__ import annotations

from types import MappingProxyType

from ...nodes import Meaning, Render
from .mattes import mattes_of
from .survey import survey


def find_render(path: str) -> Render:
    """What the file of a render holds; roles that several layers claim alike are left out.

    Raises:
        InputError: the file cannot be read.
    """
    found = survey(path)
    layers = {role: layer for role in found.roles if (layer := found.layer(role))}
    return Render(
        MappingProxyType({role.value: layer.full for role, layer in layers.items()}),
        MappingProxyType({role.value: len(layer.channels) for role, layer in layers.items()}),
        MappingProxyType({
            role.value: Meaning(rule.kind, rule.scale, rule.offset) for role, rule in found.conventions.items()
        }),
        found.camera.camera,
        mattes_of(found),
    )
