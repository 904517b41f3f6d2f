"""A render in a few words: what fills each role and why, what fills none, the camera. For people who choose."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from halation.nodes import Matte

from ..errors import InputError
from ..media.layers import find_layer, suggest_layers
from .analysis import FoundCamera, Survey, survey
from .conventions import Convention
from .mattes import mattes_of
from .naming import Role
from .recognition import Pass, chosen
from .report import either, maker_line, metadata_rows, part_rows, report, size_line


@dataclass(frozen=True)
class Use:
    """What fills a role: the `layer` in use and the one that was `found`, "" for none.

    `reason` says why that one, or why none; `open` that somebody has to choose. `fault` is what is wrong with the
    layer that was named. `rule` is how its numbers are meant, if that matters.
    """

    layer: str
    found: str
    reason: str
    open: bool = False
    fault: str = ""
    rule: Convention | None = None


@dataclass(frozen=True)
class Overview:
    """What a render turns out to hold; `fault` says why its pixels cannot be looked at."""

    size: str
    maker: str
    uses: Mapping[Role, Use]
    others: tuple[Pass, ...]
    """Layers of no role that was asked for, without cryptomattes."""
    camera: FoundCamera
    mattes: tuple[Matte, ...]
    parts: tuple[tuple[str, ...], ...]
    metadata: tuple[tuple[str, str], ...]
    report: str
    fault: str = ""


def overview(path: str, roles: Sequence[Role], named: Mapping[Role, str] = MappingProxyType({})) -> Overview:
    """Look at a render for some roles; `named` are layers that somebody chose for them.

    Raises:
        InputError: the file cannot be read.
    """
    plain = survey(path)
    faults = dict(_faults(plain, named))
    found = survey(path, named={role: layer for role, layer in named.items() if role not in faults})
    try:
        rules, camera, fault, text = found.conventions, found.camera, "", "\n".join(report(found))
    except InputError as error:
        rules, camera, fault, text = {}, FoundCamera(None, str(error)), str(error), ""
    uses = {role: _use(plain, found, role, faults.get(role, ""), rules.get(role)) for role in roles}
    used = {use.layer for use in uses.values()}
    others = tuple(
        item
        for item in found.passes
        if item.layer.name not in used and not (item.role and item.role.value.startswith("cryptomatte"))
    )
    return Overview(
        size_line(found),
        maker_line(found),
        MappingProxyType(uses),
        others,
        camera,
        mattes_of(found),
        tuple(part_rows(found)),
        tuple(metadata_rows(found)),
        text,
        fault,
    )


def _faults(found: Survey, named: Mapping[Role, str]) -> Iterator[tuple[Role, str]]:
    for role, layer in named.items():
        try:
            find_layer(found.header.info, layer)
        except InputError:
            near = suggest_layers(found.header.info.layers, layer)
            yield role, f"no layer '{layer}' in this file{f': did you mean {either(near)}?' if near else ''}"


def _use(plain: Survey, found: Survey, role: Role, fault: str, rule: Convention | None) -> Use:
    usual, layer = plain.layer(role), found.layer(role)
    name = usual.name if usual else ""
    if role in found.named or fault:
        return Use(layer.name if layer else "", name, "chosen by hand", False, fault, rule)
    if layer is not None:
        return Use(layer.name, name, chosen(found.passes, role)[0].reason, rule=rule)
    if role in found.rivals:
        layers = [rival.name for rival in found.rivals[role]]
        return Use("", "", f"may be {either(layers)}: choose one", True)
    maybe = [item.layer.name for item in found.passes if item.role is None and role in item.candidates]
    return Use("", "", f"may be {either(maybe)}", True) if maybe else Use("", "", "not in this file")
