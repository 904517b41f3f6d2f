"""Renders as nodes ask for them: layers by role, what their numbers mean, the camera, and cryptomattes."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from halation.nodes import Meaning, Render

from ..errors import HalationError
from ..resources.sandbox import Sandbox
from .analysis import analyze_render
from .mattes import find_mattes
from .naming import Role
from .recognition import find_light_groups

_DATA = frozenset(
    {
        Role.DEPTH,
        Role.NORMAL,
        Role.POSITION,
        Role.VELOCITY,
        Role.UV,
        Role.ALBEDO,
        Role.EMISSION,
        Role.OCCLUSION,
        Role.OBJECT_ID,
        Role.MATERIAL_ID,
        Role.CRYPTOMATTE,
        Role.CRYPTOMATTE_OBJECT,
        Role.CRYPTOMATTE_MATERIAL,
        Role.CRYPTOMATTE_ASSET,
    }
)
"""Roles that make a picture a render: layers that effects use."""


def read_render(path: str, named: Mapping[str, str] = MappingProxyType({}), *, sandbox: Sandbox) -> Render:
    """The layers of a render's file; roles that several layers claim equally are left out.

    `named` are layers that are to have a role, by that.

    Raises:
        InputError: the file cannot be read, or has no such layer.
    """
    analysis = analyze_render(path, named={Role(role): layer for role, layer in named.items()}, sandbox=sandbox)
    layers = {role: layer for role in analysis.roles if (layer := analysis.find_layer(role))}
    return Render(
        MappingProxyType({role.value: layer.full_name for role, layer in layers.items()}),
        MappingProxyType({role.value: len(layer.channels) for role, layer in layers.items()}),
        MappingProxyType(
            {role.value: Meaning(rule.kind, rule.scale, rule.offset) for role, rule in analysis.conventions.items()}
        ),
        analysis.camera.camera,
        find_mattes(analysis),
        MappingProxyType({name: layer.full_name for name, layer in find_light_groups(analysis.passes).items()}),
    )


def is_render(path: str | Path, sandbox: Sandbox) -> bool:
    """True for a file of several layers of which one is, or may be, a layer for effects; only its header is read."""
    try:
        analysis = analyze_render(path, sandbox=sandbox)
    except HalationError:
        return False
    roles = {role for item in analysis.passes for role in (item.role, *item.candidates) if role is not None}
    return len(analysis.passes) > 1 and bool(roles & _DATA)
