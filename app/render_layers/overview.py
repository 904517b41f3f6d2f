"""A short description of a render for users: the layer of each role and why, empty roles, the camera."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType

from halation.nodes import Matte
from msgspec import Struct

from ..errors import InputError
from ..media.layers import find_layer
from ..resources.sandbox import Sandbox
from .analysis import RenderAnalysis, RenderCamera, analyze_render
from .conventions import Convention
from .mattes import find_mattes
from .naming import Role
from .recognition import RenderPass, best_claims, suggest_by_role
from .report import describe_maker, describe_size, format_report, join_choices, list_metadata, list_parts


class RoleUse(Struct, frozen=True):
    """The layer of a role: the `layer` in use and the one that was `found`, "" for none.

    `reason` says why this one, or why none; `open` means that the user has to choose. `fault` is what is wrong with the
    chosen layer. `rule` is the convention of its numbers, if that matters.
    """

    layer: str
    found_layer: str
    reason: str
    is_open: bool = False
    fault: str = ""
    rule: Convention | None = None


class RenderOverview(Struct, frozen=True):
    """The description of a render; `fault` says why its pixels cannot be read."""

    size: str
    maker: str
    uses: Mapping[Role, RoleUse]
    other_passes: tuple[RenderPass, ...]
    """Layers without a requested role, except cryptomattes."""
    camera: RenderCamera
    mattes: tuple[Matte, ...]
    parts: tuple[tuple[str, ...], ...]
    metadata: tuple[tuple[str, str], ...]
    report: str
    fault: str = ""


def summarize_render(
    path: str, roles: Sequence[Role], named: Mapping[Role, str] = MappingProxyType({}), *, sandbox: Sandbox
) -> RenderOverview:
    """Describe a render for some roles; `named` are layers that the user has chosen for them.

    Raises:
        InputError: the file cannot be read.
    """
    unchosen = analyze_render(path, sandbox=sandbox)
    faults = dict(_find_faults(unchosen, named))
    analysis = analyze_render(
        path, named={role: layer for role, layer in named.items() if role not in faults}, sandbox=sandbox
    )
    try:
        rules = analysis.conventions
        camera = analysis.camera
        fault = ""
        text = "\n".join(format_report(analysis))
    except InputError as error:
        rules, camera, fault, text = {}, RenderCamera(None, str(error)), str(error), ""
    uses = {role: _find_use(unchosen, analysis, role, faults.get(role, ""), rules.get(role)) for role in roles}
    used = {use.layer for use in uses.values()}
    other_passes = tuple(
        item
        for item in analysis.passes
        if item.layer.name not in used and not (item.role and item.role.value.startswith("cryptomatte"))
    )
    return RenderOverview(
        describe_size(analysis),
        describe_maker(analysis),
        MappingProxyType(uses),
        other_passes,
        camera,
        find_mattes(analysis),
        tuple(list_parts(analysis)),
        tuple(list_metadata(analysis)),
        text,
        fault,
    )


def _find_faults(analysis: RenderAnalysis, named: Mapping[Role, str]) -> Iterator[tuple[Role, str]]:
    for role, layer in named.items():
        try:
            find_layer(analysis.header.info, layer)
        except InputError:
            near = suggest_by_role(analysis.passes, layer, role)
            yield role, f"no layer '{layer}' in this file{f': did you mean {join_choices(near)}?' if near else ''}"


def _find_use(
    unchosen: RenderAnalysis, analysis: RenderAnalysis, role: Role, fault: str, rule: Convention | None
) -> RoleUse:
    usual, layer = unchosen.find_layer(role), analysis.find_layer(role)
    name = usual.name if usual else ""
    if role in analysis.chosen_layers or fault:
        return RoleUse(layer.name if layer else "", name, "chosen by hand", False, fault, rule)
    if layer is not None:
        return RoleUse(layer.name, name, best_claims(analysis.passes, role)[0].reason, rule=rule)
    if role in analysis.rivals:
        layers = [rival.name for rival in analysis.rivals[role]]
        return RoleUse("", "", f"may be {join_choices(layers)}: choose one", True)
    candidates = [item.layer.name for item in analysis.passes if item.role is None and role in item.candidates]
    return (
        RoleUse("", "", f"may be {join_choices(candidates)}", True)
        if candidates
        else RoleUse("", "", "not in this file")
    )
