"""What a render turns out to hold: which layer is what, by which conventions, seen by which camera.

    found = survey("shot.exr")
    found.layer(Role.DEPTH), found.conventions[Role.DEPTH].kind, found.camera.camera

The header is read at once, pixels when conventions or the camera are first asked for.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from pathlib import Path
from types import MappingProxyType

from halation.nodes import Camera, Kind

from ..color.transforms import Array
from ..errors import InputError
from ..media.convert import LayerRequest
from ..media.header import FileHeader, read_header
from ..media.layers import Layer, find_layer
from ..media.pixels import read_layers
from ..resources.input_files import fingerprint
from . import evidence
from .camera import Solved, header_camera, residual_of, solve_camera
from .conventions import Convention, Motion, Space, habit
from .naming import PLURAL, Role
from .recognition import Maker, Pass, chosen, maker_of, passes_of

_CONVENED = (Role.DEPTH, Role.NORMAL, Role.POSITION, Role.VELOCITY)
_AGREED = 0.5


@dataclass(frozen=True)
class FoundCamera:
    """The camera of a render, None where nothing tells it, and how it was found; `solved` says how exactly."""

    camera: Camera | None
    reason: str
    solved: Solved | None = None


@dataclass(frozen=True)
class _Findings:
    conventions: Mapping[Role, Convention]
    camera: FoundCamera


@dataclass(frozen=True)
class Survey:
    """A render: `passes` says what its layers are, `before` is the frame before it, if that was given.

    `named` are layers that somebody chose for a role.
    """

    header: FileHeader
    maker: Maker
    passes: tuple[Pass, ...]
    before: Survey | None = None
    named: Mapping[Role, Layer] = field(default_factory=lambda: MappingProxyType[Role, Layer]({}))

    def layer(self, role: Role) -> Layer | None:
        """The layer of this role: that which was named, else the one with the best claim; None if several have it."""
        if role in self.named:
            return self.named[role]
        best = chosen(self.passes, role)
        return best[0].layer if len(best) == 1 else None

    def ranks(self, role: Role) -> tuple[Layer, ...]:
        """All layers of a cryptomatte, by rank."""
        found = [item for item in self.passes if item.role is role]
        return tuple(item.layer for item in sorted(found, key=lambda item: item.rank))

    @property
    def roles(self) -> tuple[Role, ...]:
        """The roles that have a layer, in the order of the layers; those that somebody chose one for come last."""
        found = [item.role for item in self.passes if item.role is not None]
        return tuple(dict.fromkeys([*found, *self.named]))

    @cached_property
    def rivals(self) -> Mapping[Role, tuple[Layer, ...]]:
        """The roles that several layers claim alike, which leaves them to the user."""
        open_roles = [role for role in self.roles if role not in PLURAL and role not in self.named]
        claims = {role: chosen(self.passes, role) for role in open_roles}
        return {role: tuple(item.layer for item in best) for role, best in claims.items() if len(best) > 1}

    @property
    def conventions(self) -> Mapping[Role, Convention]:
        """How depth, normals, positions and motion are meant, of those that there are. Raises InputError."""
        return self._findings.conventions

    @property
    def camera(self) -> FoundCamera:
        """The camera, in the axes that positions refer to. Raises InputError."""
        return self._findings.camera

    @cached_property
    def _findings(self) -> _Findings:
        pixels = self._pixels()
        conventions = {role: rule for role in _CONVENED if (rule := self._habit(role))}
        camera = self._camera(pixels)
        for role, rule in (self._measured(pixels, camera.camera) if camera.solved else {}).items():
            conventions[role] = rule
        depth = pixels.get(Role.DEPTH)
        if depth is not None and not conventions[Role.DEPTH].measured and (rule := evidence.depth_alone(depth[..., 0])):
            conventions[Role.DEPTH] = rule
        if (rule := self._motion(pixels, camera)) is not None:
            conventions[Role.VELOCITY] = rule
        return _Findings(MappingProxyType(conventions), camera)

    def _habit(self, role: Role) -> Convention | None:
        layer = self.layer(role)
        if layer is None:
            return None
        word = next((item.name for item in self.passes if item.layer is layer), layer.name)
        return habit(role, word, self.maker.renderer)

    def _pixels(self) -> dict[Role, Array]:
        """The layers that conventions and the camera are found in."""
        wanted = [*_CONVENED, *([Role.BEAUTY] if self.before and self.layer(Role.VELOCITY) else [])]
        layers = {role: layer for role in wanted if (layer := self.layer(role))}
        wants = [LayerRequest(layer.full_name, Kind.VECTOR, len(layer.channels)) for layer in layers.values()]
        arrays = read_layers(self.header.info.path, wants) if wants else []
        return {role: pixels.array for role, pixels in zip(layers, arrays, strict=True)}

    def _camera(self, pixels: Mapping[Role, Array]) -> FoundCamera:
        """Solved from positions where that is possible, else as the header says."""
        named = header_camera(self.header.attributes, self.header.info.size)
        position = pixels.get(Role.POSITION)
        if position is None or position.shape[2] < 3:
            said = "named by the header" if named else "no positions to solve it from, and the header names none"
            return FoundCamera(named, said)
        try:
            solved = solve_camera(position)
        except InputError as fault:
            return FoundCamera(named, f"named by the header ({fault})" if named else str(fault))
        check = self._check(named, solved.camera, position)
        return FoundCamera(solved.camera, f"solved from the positions{check}", solved)

    def _check(self, named: Camera | None, solved: Camera, position: Array) -> str:
        """What there is to say of a camera in the header beside one that was solved."""
        if named is None:
            return ""
        if evidence.position_space(solved, position).kind != Space.WORLD:
            return ", which are those of its own axes; the header tells where it stands in the world"
        off = residual_of(named, position).residual
        if off < _AGREED:
            return f"; that of the header agrees to {off:.1g} px"
        return f"; that of the header is {off:.3g} px off and was not used"

    def _measured(self, pixels: Mapping[Role, Array], camera: Camera | None) -> dict[Role, Convention]:
        """What the positions prove of themselves, of depth and of normals."""
        if camera is None:
            return {}
        position, found = pixels[Role.POSITION], dict[Role, Convention]()
        found[Role.POSITION] = evidence.position_space(camera, position)
        if Role.DEPTH in pixels and (rule := evidence.depth_by_position(pixels[Role.DEPTH][..., 0], position, camera)):
            found[Role.DEPTH] = rule
        normal = pixels.get(Role.NORMAL)
        if normal is not None and normal.shape[2] >= 3:
            home = Space(found[Role.POSITION].kind)
            if rule := evidence.normal_by_position(normal, position, camera, home):
                found[Role.NORMAL] = rule
        return found

    def _motion(self, pixels: Mapping[Role, Array], camera: FoundCamera) -> Convention | None:
        """What the frame before proves of motion."""
        velocity = pixels.get(Role.VELOCITY)
        if velocity is None or velocity.shape[2] < 2 or self.before is None:
            return None
        rule, there, usual = None, self.before.camera, self._habit(Role.VELOCITY)
        if camera.camera and camera.solved and there.camera and there.solved:
            rule = evidence.velocity_by_cameras(velocity, pixels[Role.POSITION], camera.camera, there.camera)
        picture = self.before.layer(Role.BEAUTY)
        if rule is None and picture is not None and Role.BEAUTY in pixels:
            want = LayerRequest(picture.full_name, Kind.VECTOR, len(picture.channels))
            (earlier,) = read_layers(self.before.header.info.path, [want])
            rule = evidence.velocity_by_pictures(velocity, pixels[Role.BEAUTY], earlier.array)
            if rule is not None and usual is not None and usual.kind == Motion.TO_NEXT:
                rule = replace(rule, kind=usual.kind)  # what pictures show is much the same before and after
        if rule is not None and usual is not None and usual.scale[:2] == rule.scale:
            return replace(rule, scale=usual.scale)  # the other two channels as usual, too
        return rule


def survey(
    path: str | Path, before: str | Path | None = None, named: Mapping[Role, str] = MappingProxyType({})
) -> Survey:
    """Look at a render; `before` is the same render one frame earlier, which shows which way motion points.

    `named` are layers that are to have a role whatever they look like. The same file is looked at once.

    Raises:
        InputError: as `info`, and as `find_layer` for a layer that is not there.
    """
    earlier = (str(before), fingerprint(before)) if before is not None else None
    found = _survey(str(path), fingerprint(path), earlier, tuple(sorted(named.items())))
    here, there = (item.header.info.size for item in (found, found.before or found))
    if here != there:
        raise InputError(f"{before}: is {there[0]}x{there[1]} and {path} is {here[0]}x{here[1]}: name the frame before")
    return found


@lru_cache(maxsize=64)
def _survey(path: str, mark: str, before: tuple[str, str] | None, named: tuple[tuple[Role, str], ...] = ()) -> Survey:
    header = read_header(path)
    maker = maker_of(header.attributes, header.info.layers)
    views = {part.index: part.view for part in header.parts}
    passes = passes_of(header.info.layers, header.attributes, maker.renderer, views)
    layers = {role: find_layer(header.info, name) for role, name in named}
    return Survey(header, maker, passes, _survey(*before, None) if before else None, MappingProxyType(layers))
