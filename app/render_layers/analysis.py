"""Analyzes a render: which layer is what, its conventions, and its camera.

    found = survey("shot.exr")
    found.layer(Role.DEPTH), found.conventions[Role.DEPTH].kind, found.camera.camera

The header is read at once, pixels when conventions or the camera are first asked for.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property, lru_cache
from pathlib import Path
from types import MappingProxyType

from halation.nodes import CameraModel, Kind
from msgspec import Struct, field
from msgspec.structs import replace

from ..color.transforms import Array
from ..errors import InputError
from ..media.convert import LayerRequest
from ..media.header import FileHeader, read_header
from ..media.layers import Layer, find_layer
from ..media.pixels import read_layers
from ..resources.input_files import fingerprint
from ..resources.sandbox import Sandbox
from . import evidence
from .camera import CameraSolution, measure_camera, read_header_camera, solve_camera
from .conventions import Convention, MotionDirection, VectorSpace, find_habit
from .naming import PLURAL_ROLES, Role
from .recognition import FileMaker, RenderPass, best_claims, find_maker, recognize_passes, suggest_by_role

_ROLES_WITH_CONVENTIONS = (Role.DEPTH, Role.NORMAL, Role.POSITION, Role.VELOCITY)
_AGREEMENT_PIXELS = 0.5
"""Pixels. A camera in the header whose error is below this is the camera of the picture: pixel centers leave half a
pixel open."""


class RenderCamera(Struct, frozen=True):
    """The camera of a render, or None, and the reason; `solved` says how exact it is."""

    camera: CameraModel | None
    reason: str
    solution: CameraSolution | None = None


class _PixelFindings(Struct, frozen=True):
    conventions: Mapping[Role, Convention]
    camera: RenderCamera


class RenderAnalysis(Struct, frozen=True, dict=True):
    """A render: `passes` are its layers with their roles, `before` is the previous frame, if it is given.

    `named` are layers that the user has chosen for a role.
    """

    header: FileHeader
    maker: FileMaker
    passes: tuple[RenderPass, ...]
    sandbox: Sandbox
    before: RenderAnalysis | None = None
    chosen_layers: Mapping[Role, Layer] = field(default_factory=lambda: MappingProxyType[Role, Layer]({}))

    def find_layer(self, role: Role) -> Layer | None:
        """The layer of a role: the chosen one, else the one with the best claim; None if several have an equal
        claim."""
        if role in self.chosen_layers:
            return self.chosen_layers[role]
        best = best_claims(self.passes, role)
        return best[0].layer if len(best) == 1 else None

    @property
    def roles(self) -> tuple[Role, ...]:
        """The roles that have a layer, in the order of the layers; roles with a chosen layer come last."""
        roles = [item.role for item in self.passes if item.role is not None]
        return tuple(dict.fromkeys([*roles, *self.chosen_layers]))

    @cached_property
    def rivals(self) -> Mapping[Role, tuple[Layer, ...]]:
        """The roles that several layers claim equally, so that the user must choose."""
        open_roles = [role for role in self.roles if role not in PLURAL_ROLES and role not in self.chosen_layers]
        claims = {role: best_claims(self.passes, role) for role in open_roles}
        return {role: tuple(item.layer for item in best) for role, best in claims.items() if len(best) > 1}

    @property
    def conventions(self) -> Mapping[Role, Convention]:
        """The conventions of depth, normals, positions and motion, if they exist. Raises InputError."""
        return self._findings.conventions

    @property
    def camera(self) -> RenderCamera:
        """The camera, in the axes of the positions. Raises InputError."""
        return self._findings.camera

    @cached_property
    def _findings(self) -> _PixelFindings:
        pixels = self._read_pixels()
        conventions = {role: rule for role in _ROLES_WITH_CONVENTIONS if (rule := self._find_habit(role))}
        camera = self._find_camera(pixels)
        for role, rule in (self._measure_by_positions(pixels, camera.camera) if camera.solution else {}).items():
            conventions[role] = rule
        depth = pixels.get(Role.DEPTH)
        if (
            depth is not None
            and not conventions[Role.DEPTH].is_measured
            and (rule := evidence.judge_depth_by_planes(depth[..., 0]))
        ):
            conventions[Role.DEPTH] = rule
        if (rule := self._measure_motion(pixels, camera)) is not None:
            conventions[Role.VELOCITY] = rule
        return _PixelFindings(MappingProxyType(conventions), camera)

    def _find_habit(self, role: Role) -> Convention | None:
        layer = self.find_layer(role)
        if layer is None:
            return None
        word = next((item.name for item in self.passes if item.layer is layer), layer.name)
        return find_habit(role, word, self.maker.renderer)

    def _read_pixels(self) -> dict[Role, Array]:
        """The layers from which conventions and the camera are found."""
        roles = [*_ROLES_WITH_CONVENTIONS, *([Role.BEAUTY] if self.before and self.find_layer(Role.VELOCITY) else [])]
        layers = {role: layer for role in roles if (layer := self.find_layer(role))}
        requests = [LayerRequest(layer.full_name, Kind.VECTOR, len(layer.channels)) for layer in layers.values()]
        arrays = read_layers(self.header.info.path, requests, sandbox=self.sandbox) if requests else []
        return {role: pixels.array for role, pixels in zip(layers, arrays, strict=True)}

    def _find_camera(self, pixels: Mapping[Role, Array]) -> RenderCamera:
        """The camera, solved from positions if possible, else from the header."""
        header = read_header_camera(self.header.attributes, self.header.info.size)
        position = pixels.get(Role.POSITION)
        if position is None or position.shape[2] < 3:
            reason = "named by the header" if header else "no positions to solve it from, and the header names none"
            return RenderCamera(header, reason)
        try:
            solved = solve_camera(position)
        except InputError as fault:
            return RenderCamera(header, f"named by the header ({fault})" if header else str(fault))
        check = self._compare_with_header(header, solved.camera, position)
        return RenderCamera(solved.camera, f"solved from the positions{check}", solved)

    def _compare_with_header(self, header: CameraModel | None, solved: CameraModel, position: Array) -> str:
        """A remark on a camera in the header, compared with the solved one."""
        if header is None:
            return ""
        if evidence.find_position_space(solved, position).kind != VectorSpace.WORLD:
            return ", which are those of its own axes; the header tells where it stands in the world"
        off = measure_camera(header, position).residual
        if off < _AGREEMENT_PIXELS:
            return f"; that of the header agrees to {off:.1g} px"
        return f"; that of the header is {off:.3g} px off and was not used"

    def _measure_by_positions(self, pixels: Mapping[Role, Array], camera: CameraModel | None) -> dict[Role, Convention]:
        """The conventions that the positions prove for themselves, depth and normals."""
        if camera is None:
            return {}
        position, conventions = pixels[Role.POSITION], dict[Role, Convention]()
        conventions[Role.POSITION] = evidence.find_position_space(camera, position)
        if Role.DEPTH in pixels and (
            rule := evidence.match_depth_with_positions(pixels[Role.DEPTH][..., 0], position, camera)
        ):
            conventions[Role.DEPTH] = rule
        normal = pixels.get(Role.NORMAL)
        if normal is not None and normal.shape[2] >= 3:
            home = VectorSpace(conventions[Role.POSITION].kind)
            if rule := evidence.match_normals_with_positions(normal, position, camera, home):
                conventions[Role.NORMAL] = rule
        return conventions

    def _measure_motion(self, pixels: Mapping[Role, Array], camera: RenderCamera) -> Convention | None:
        """The convention of motion that the previous frame proves."""
        velocity = pixels.get(Role.VELOCITY)
        if velocity is None or velocity.shape[2] < 2 or self.before is None:
            return None
        rule, camera_before, habit_rule = None, self.before.camera, self._find_habit(Role.VELOCITY)
        if camera.camera and camera.solution and camera_before.camera and camera_before.solution:
            rule = evidence.match_velocity_with_cameras(
                velocity, pixels[Role.POSITION], camera.camera, camera_before.camera
            )
        picture = self.before.find_layer(Role.BEAUTY)
        if rule is None and picture is not None and Role.BEAUTY in pixels:
            want = LayerRequest(picture.full_name, Kind.VECTOR, len(picture.channels))
            (earlier,) = read_layers(self.before.header.info.path, [want], sandbox=self.sandbox)
            rule = evidence.match_velocity_with_pictures(velocity, pixels[Role.BEAUTY], earlier.array)
            if rule is not None and habit_rule is not None and habit_rule.kind == MotionDirection.TO_NEXT:
                rule = replace(rule, kind=habit_rule.kind)  # colors change little between frames
        if rule is not None and habit_rule is not None and habit_rule.scale[:2] == rule.scale:
            return replace(rule, scale=habit_rule.scale)  # the other two channels as usual, too
        return rule


def analyze_render(
    path: str | Path,
    before: str | Path | None = None,
    named: Mapping[Role, str] = MappingProxyType({}),
    *,
    sandbox: Sandbox,
) -> RenderAnalysis:
    """Analyze a render; `before` is the same render one frame earlier, which shows the direction of motion vectors.

    `named` are layers that are to have a role whatever they look like. The same file is looked at once.

    Raises:
        InputError: as `info`, and as `find_layer` for a layer that is not there.
    """
    earlier = (str(before), fingerprint(before, sandbox=sandbox)) if before is not None else None
    analysis = _analyze_version(
        str(path), fingerprint(path, sandbox=sandbox), earlier, tuple(sorted(named.items())), sandbox=sandbox
    )
    size, size_before = (item.header.info.size for item in (analysis, analysis.before or analysis))
    if size != size_before:
        raise InputError(
            f"{before}: is {size_before[0]}x{size_before[1]} and {path} is {size[0]}x{size[1]}: name the frame before"
        )
    return analysis


@lru_cache(maxsize=64)
def _analyze_version(
    path: str, mark: str, before: tuple[str, str] | None, named: tuple[tuple[Role, str], ...] = (), *, sandbox: Sandbox
) -> RenderAnalysis:
    header = read_header(path, sandbox=sandbox)
    maker = find_maker(header.attributes, header.info.layers)
    views = {part.index: part.view for part in header.parts}
    passes = recognize_passes(header.info.layers, header.attributes, maker.renderer, views)

    def find_chosen(role: Role, name: str) -> Layer:
        return find_layer(header.info, name, lambda unknown: suggest_by_role(passes, unknown, role))

    layers = {role: find_chosen(role, name) for role, name in named}
    return RenderAnalysis(
        header,
        maker,
        passes,
        sandbox,
        _analyze_version(*before, None, sandbox=sandbox) if before else None,
        MappingProxyType(layers),
    )
