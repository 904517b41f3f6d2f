"""What every renderer calls its layers is understood, and what is ambiguous is said to be."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.render_layers.analysis import RenderAnalysis, analyze_render
from halation.render_layers.naming import SCHEMES, RenderProgram, Role
from halation.render_layers.recognition import RoleGrounds, find_light_groups
from halation.resources.sandbox import UNRESTRICTED

ROOT = Path(__file__).parents[2]
LETTERS = {"rgb": "RGB", "rgba": "RGBA", "xyz": "XYZ", "z": "Z", "x": "X", "uv": "UV", "xyzw": "XYZW", "y": "Y"}


def written(
    path: Path,
    parts: Mapping[str, tuple[str, ...]],
    attributes: Mapping[str, Any],
    type: str = "float",
    views: Sequence[str | None] = (),
) -> RenderAnalysis:
    """A file of black parts with these channels, straight from OpenImageIO."""
    specs = []
    for name, channels, view in zip_longest(parts, parts.values(), views):
        spec = oiio.ImageSpec(4, 3, len(channels), type)
        spec.channelnames = channels
        for key, value in attributes.items():
            spec.attribute(key, *(value if isinstance(value, tuple) else (value,)))
        if view:
            spec.attribute("view", view)
        if name:
            spec.attribute("oiio:subimagename", name)
        specs.append(spec)
    file = oiio.ImageOutput.create(str(path))
    assert file.open(str(path), tuple(specs)), file.geterror()
    for index, spec in enumerate(specs):
        assert index == 0 or file.open(str(path), spec, "AppendSubimage")
        assert file.write_image(np.zeros((3, 4, spec.nchannels), np.float32))
    assert file.close()
    return analyze_render(path, sandbox=UNRESTRICTED)


def single(path: Path, layers: str, attributes: Mapping[str, Any] | None = None, type: str = "float") -> RenderAnalysis:
    """One part with `name:rgb` layers; a name of `-` stands for channels without one."""
    channels: list[str] = []
    for item in layers.split():
        name, _, kind = item.partition(":")
        channels += [letter if name == "-" else f"{name}.{letter}" for letter in LETTERS.get(kind, kind)]
    return written(path, {"": tuple(channels)}, attributes or {}, type)


def roles(found: RenderAnalysis) -> dict[str, str]:
    return {item.layer.name: item.role.value if item.role else "" for item in found.passes}


BLENDER_4 = """Combined:rgba beauty, Depth:z depth, Mist:z mist, Position:xyz position, Normal:xyz normal,
    Vector:xyzw velocity, UV:xyz uv, IndexOB:x object_id, IndexMA:x material_id, DiffDir:rgb diffuse_direct,
    DiffInd:rgb diffuse_indirect, DiffCol:rgb albedo, GlossDir:rgb specular_direct, GlossInd:rgb specular_indirect,
    GlossCol:rgb specular_color, TransDir:rgb transmission_direct, TransInd:rgb transmission_indirect,
    TransCol:rgb transmission_color, VolumeDir:rgb volume_direct, VolumeInd:rgb volume_indirect, Emit:rgb emission,
    Env:rgb environment, AO:rgb occlusion, Combined_key:rgba light_group, CryptoObject00:rgba cryptomatte_object,
    CryptoMaterial00:rgba cryptomatte_material, CryptoAsset00:rgba cryptomatte_asset"""
ARNOLD = """-:rgba beauty, Z:y depth, N:xyz normal, P:xyz position, motionvector:rgb velocity, albedo:rgb albedo,
    diffuse:rgb diffuse, diffuse_direct:rgb diffuse_direct, diffuse_indirect:rgb diffuse_indirect,
    specular:rgb specular, specular_albedo:rgb specular_color, transmission:rgb transmission, coat:rgb coat,
    sss:rgb subsurface, emission:rgb emission, background:rgb environment, ID:y object_id, RGBA_key:rgba light_group,
    crypto_object00:rgba cryptomatte_object, crypto_material00:rgba cryptomatte_material,
    crypto_asset02:rgba cryptomatte_asset, N_denoise:xyz denoise_normal, variance:rgb variance"""
VRAY = """-:rgba beauty, VRayZDepth:z depth, VRayNormals:xyz normal, VRayWorldPosition:xyz position,
    VRayVelocity:xyz velocity, VRayDiffuseFilter:rgb albedo, VRayGlobalIllumination:rgb diffuse_indirect,
    VRayLighting:rgb diffuse_direct, VRaySpecular:rgb specular_direct, VRayReflection:rgb specular_indirect,
    VRayReflectionFilter:rgb specular_color, VRayRefraction:rgb transmission, VRaySelfIllumination:rgb emission,
    VRayBackground:rgb environment, VRayRenderID:x object_id, VRayMtlID:x material_id, VRayShadows:rgb shadow,
    atmosphere:rgb mist, MultiMatteElement:rgb matte, VRayCryptomatte00:rgba cryptomatte,
    diffuse:rgb albedo, specular:rgb specular_direct"""
KARMA = """C:rgba beauty, depth:z depth, hitPz:z depth, N:xyz normal, P:xyz position, motionvectors:xyz velocity,
    albedo:rgb albedo, directdiffuse:rgb diffuse_direct, indirectdiffuse:rgb diffuse_indirect,
    directglossyreflection:rgb specular_direct, combinedemission:rgb emission, visiblelights:rgb environment,
    ao:rgb occlusion, primid:x object_id, uv:uv uv, CryptoMaterial00:rgba cryptomatte_material"""
RENDERMAN = """Ci:rgb beauty, z:z depth, zfiltered:z depth, Nn:xyz normal, __Nworld:xyz normal, P:xyz position,
    __Pworld:xyz position, motionBack:xyz velocity, dPdtime:xyz motion, albedo:rgb albedo, occluded:rgb occlusion,
    directDiffuse:rgb diffuse_direct, indirectSpecular:rgb specular_indirect, emissive:rgb emission, __st:xyz uv,
    id:x object_id, albedo_mse:rgb variance, diffuse:rgb diffuse"""
REDSHIFT = """-:rgba beauty, Z:y depth, N:xyz normal, P:xyz position, MotionVectors:rgb velocity, AO:rgb occlusion,
    DiffuseFilter:rgb albedo, DiffuseLighting:rgb diffuse_direct, GI:rgb diffuse_indirect, Emission:rgb emission,
    SpecularLighting:rgb specular_direct, Reflections:rgb specular_indirect, ObjectID:x object_id,
    PuzzleMatte:rgb matte, SubSurfaceScatter:rgb subsurface"""
NUKE = """-:rgba beauty, depth:z depth, forward:uv velocity, backward:uv velocity, mask:a matte, P:xyz position,
    N:xyz normal"""
MITSUBA = """img:rgba beauty, dd:y depth, pp:xyz position, nn:xyz normal, uv:uv uv, al:rgb albedo, id:y object_id"""


@pytest.mark.parametrize(
    ("renderer", "marks", "table"),
    [
        (RenderProgram.BLENDER, {"Software": "Blender 4.5.1"}, BLENDER_4),
        (RenderProgram.BLENDER, {"BlenderMultiChannel": "Blender V2.55.1 and newer"}, BLENDER_4),
        (RenderProgram.ARNOLD, {"arnold/version": "7.3.2.1"}, ARNOLD),
        (RenderProgram.VRAY, {"vrayInfo/vrayversion": "6.20.00"}, VRAY),
        (RenderProgram.KARMA, {"husk:command_line": "husk -R Karma"}, KARMA),
        (RenderProgram.RENDERMAN, {"PRManVersion": "26.3"}, RENDERMAN),
        (RenderProgram.REDSHIFT, {"rs/camera/nearPlane": 0.1}, REDSHIFT),
        (RenderProgram.NUKE, {"nuke/version": "15.1v3"}, NUKE),
        (RenderProgram.MITSUBA, {"generatedBy": "Mitsuba version 3.9.1"}, MITSUBA),
    ],
)
def test_every_scheme(tmp_path: Path, renderer: RenderProgram, marks: dict[str, Any], table: str) -> None:
    rows = [row.split() for row in table.split(",")]
    found = single(tmp_path / "x.exr", " ".join(layer for layer, _ in rows), marks)
    assert found.maker.renderer is renderer and next(iter(marks)) in found.maker.reason
    wanted = {layer.partition(":")[0].replace("-", "RGBA"): role for layer, role in rows}
    assert roles(found) == wanted
    assert all(item.reason and item.grounds < RoleGrounds.NONE for item in found.passes)


LONG = {
    "Combined": "rgba",
    "Noisy Image": "rgba",
    "Depth": "z",
    "Normal": "xyz",
    "Vector": "xyzw",
    "Object Index": "x",
    "Material Index": "x",
    "Diffuse Color": "rgb",
    "Diffuse Direct": "rgb",
    "Glossy Indirect": "rgb",
    "Transmission Color": "rgb",
    "Ambient Occlusion": "rgb",
    "Environment": "rgb",
    "Denoising Depth": "z",
    "Denoising Normal": "xyz",
    "Denoising Albedo": "rgb",
}


def test_blender_5_in_parts(tmp_path: Path) -> None:
    parts = {
        f"ViewLayer.{name}": tuple(f"ViewLayer.{name}.{letter}" for letter in LETTERS[kind])
        for name, kind in LONG.items()
    }
    found = written(tmp_path / "x.exr", parts, {"Software": "Blender 5.0.1"})
    assert list(roles(found).values()) == [
        "beauty",
        "noisy_beauty",
        "depth",
        "normal",
        "velocity",
        "object_id",
        "material_id",
        "albedo",
        "diffuse_direct",
        "specular_indirect",
        "transmission_color",
        "occlusion",
        "environment",
        "denoise_depth",
        "denoise_normal",
        "denoise_albedo",
    ]
    assert found.find_layer(Role.DEPTH).part == 2 and found.rivals == {}


def test_parts_that_name_bare_channels(tmp_path: Path) -> None:
    parts = {"rgba": tuple("RGBA"), "VRayZDepth": ("Z",), "VRayNormals": tuple("XYZ")}
    found = written(tmp_path / "x.exr", parts, {})
    assert list(roles(found).values()) == ["beauty", "depth", "normal"]
    assert found.maker.renderer is RenderProgram.VRAY and "VRayZDepth" in found.maker.reason


@pytest.mark.parametrize("name", ["presets/samples/neon.exr", "tests/data/blender45_multilayer.exr"])
def test_real_renders(name: str) -> None:
    found = analyze_render(ROOT / name, sandbox=UNRESTRICTED)
    assert found.maker.renderer is RenderProgram.BLENDER
    assert {role.value for role in found.roles} == {
        "beauty",
        "noisy_beauty",
        "depth",
        "position",
        "normal",
        "velocity",
        "object_id",
        "albedo",
        "emission",
        "cryptomatte_object",
    }
    assert all(item.role for item in found.passes) and found.rivals == {}
    crypto = [item for item in found.passes if item.role is Role.CRYPTOMATTE_OBJECT]
    assert [item.grounds for item in crypto] == [RoleGrounds.HEADER] * 3
    assert sorted((item.rank, item.layer.name[-2:]) for item in crypto) == [(0, "00"), (1, "01"), (2, "02")]


# --- without a known renderer -------------------------------------------------------------------------------------


def test_a_name_that_renderers_use_differently_is_left_open(tmp_path: Path) -> None:
    found = single(tmp_path / "x.exr", "-:rgba diffuse:rgb specular:rgb")
    by_name = {item.layer.name: item for item in found.passes}
    assert found.maker.renderer is None
    assert by_name["diffuse"].role is None
    assert set(by_name["diffuse"].candidates) == {Role.DIFFUSE, Role.ALBEDO}
    assert "albedo in V-Ray" in by_name["diffuse"].reason
    assert set(by_name["specular"].candidates) == {Role.SPECULAR, Role.SPECULAR_DIRECT}
    assert found.find_layer(Role.DIFFUSE) is None and found.find_layer(Role.ALBEDO) is None


@pytest.mark.parametrize(
    ("layer", "role"),
    [
        ("worldNormals:xyz", "normal"),
        ("Pos_World:xyz", "position"),
        ("motion_vec:xy", "velocity"),
        ("linear_depth:y", "depth"),
        ("z-depth:r", "depth"),
        ("baseColor:rgb", "albedo"),
        ("whitebarmask:r", "matte"),
        ("mask1:r", "matte"),
        ("foo:z", "depth"),
        ("subsurface_scattering:rgb", "subsurface"),
        ("indirect_specular:rgb", "specular_indirect"),
        ("incandescence:rgb", "emission"),
        ("N_denoised:xyz", "denoise_normal"),
        ("my_crypto_thing:rgb", ""),
        ("velocity3d:xyz", "motion"),
        ("Camera.Depth:z", "depth"),
        ("qwerty:rgb", ""),
    ],
)
def test_names_are_read_like_a_person_would(tmp_path: Path, layer: str, role: str) -> None:
    found = single(tmp_path / "x.exr", f"-:rgba {layer}")
    assert [item.role for item in found.passes if item.layer.name != "RGBA"] == [role or None]


@pytest.mark.parametrize(
    ("layer", "candidates"),
    [
        ("foo:xyz", {Role.NORMAL, Role.POSITION, Role.VELOCITY}),
        ("foo:uv", {Role.UV, Role.VELOCITY}),
        ("light_position:xyz", {Role.POSITION}),
        ("depth_of_field_depth:r", {Role.DEPTH}),
        ("foo:rgb", set()),
    ],
)
def test_what_only_looks_like_something_is_listed(tmp_path: Path, layer: str, candidates: set[Role]) -> None:
    item = single(tmp_path / "x.exr", f"-:rgba {layer}").passes[1]
    assert item.role is None and set(item.candidates) == candidates and item.grounds is RoleGrounds.NONE


def test_a_lone_picture_is_the_beauty(tmp_path: Path) -> None:
    item = single(tmp_path / "x.exr", "N:xyz glow:rgb other:rgb").passes[1]
    assert item.role is Role.BEAUTY and item.reason == "the first layer of color that is nothing else"
    assert single(tmp_path / "y.exr", "N:xyz foo:xyz").find_layer(Role.BEAUTY) is None


# --- several with one claim ---------------------------------------------------------------------------------------


def test_the_better_name_wins(tmp_path: Path) -> None:
    found = single(tmp_path / "x.exr", "Ci:rgb zfiltered:z z:z zDepth:z", {"PRManVersion": "26"})
    assert found.find_layer(Role.DEPTH).name == "z" and found.rivals == {}


def test_of_view_layers_that_of_the_picture_counts(tmp_path: Path) -> None:
    found = single(
        tmp_path / "x.exr",
        "Main.Combined:rgba Main.Depth:z Other.Combined:rgba Other.Depth:z",
        {"Software": "Blender 4.2"},
    )
    assert (
        found.find_layer(Role.BEAUTY).full_name == "Main.Combined"
        and found.find_layer(Role.DEPTH).full_name == "Main.Depth"
    )


def test_light_groups_are_those_of_the_view_layer_of_the_picture(tmp_path: Path) -> None:
    words = [
        f"{view}.{name}:rgba" for view in ("Main", "Other") for name in ("Combined", "Combined_key", "Combined_rim")
    ]
    found = single(
        tmp_path / "x.exr", f"{' '.join(words)} Main.Combined_x:rgba Main.Depth:z", {"Software": "Blender 4.2"}
    )
    groups = find_light_groups(found.passes)
    assert {name: layer.full_name for name, layer in groups.items()} == {
        name: f"Main.Combined_{name}" for name in ("key", "rim", "x")
    }


def test_equal_claims_are_left_to_the_user(tmp_path: Path) -> None:
    found = single(tmp_path / "x.exr", "-:rgba mask1:r mask2:r normalsCS:xyz worldNormals:xyz")
    assert found.find_layer(Role.NORMAL) is None and found.find_layer(Role.MATTE) is None
    assert {role: [layer.name for layer in layers] for role, layers in found.rivals.items()} == {
        Role.NORMAL: ["normalsCS", "worldNormals"]  # of mattes there may be many
    }


STEREO = "-:rgba Z:y disparityL:xy forward.left:uv forward.right:uv left:rgba left:z bars.left:mask bars.right:mask"
"""The channels of the beach ball among OpenEXR's test images, which is seen by the right eye first."""


@pytest.mark.parametrize("named", [True, False])
def test_views_of_one_part(tmp_path: Path, named: bool) -> None:
    attributes = {"multiView": ("string[2]", ("right", "left"))} if named else {}
    found = single(tmp_path / "x.exr", STEREO.replace("mask", "K"), attributes)
    assert roles(found) == {
        "RGBA": "beauty",
        "Z": "depth",
        "disparityL": "",
        "forward.left": "velocity",
        "forward.right": "velocity",
        "left": "beauty",
        "left.Z": "depth",
        "bars.left": "",
        "bars.right": "",
    }
    assert found.find_layer(Role.BEAUTY).name == "RGBA" and found.find_layer(Role.DEPTH).name == "Z"
    motion = found.find_layer(Role.VELOCITY)
    assert motion.name == "forward.right" if named else motion is None


def test_views_of_parts(tmp_path: Path) -> None:
    """The same image in parts, each of which names its view; only disparity has none."""
    parts = {
        "rgba_right": tuple("RGBA"),
        "depth_left": ("Z",),
        "forward_left": ("forward.u", "forward.v"),
        "rgba_left": tuple("RGBA"),
        "depth_right": ("Z",),
        "forward_right": ("forward.u", "forward.v"),
        "disparityL": ("disparityL.x", "disparityL.y"),
    }
    views = ["right", "left", "left", "left", "right", "right", None]
    found = written(tmp_path / "x.exr", parts, {}, views=views)
    assert list(roles(found).values()) == ["beauty", "depth", "velocity", "beauty", "depth", "velocity", ""]
    assert found.find_layer(Role.BEAUTY).part == 0 and found.find_layer(Role.DEPTH).part == 4
    assert found.find_layer(Role.VELOCITY).part == 5 and found.rivals == {}


# --- cryptomatte --------------------------------------------------------------------------------------------------


def test_the_manifest_names_cryptomattes(tmp_path: Path) -> None:
    attributes = {"cryptomatte/1234567/name": "uid_of_objects"}
    found = single(tmp_path / "x.exr", "-:rgba uid_of_objects00:rgba uid_of_objects01:rgba", attributes)
    assert [item.role for item in found.passes[1:]] == [Role.CRYPTOMATTE_OBJECT] * 2
    assert [item.rank for item in found.passes[1:]] == [0, 1]


def test_a_preview_and_half_floats_are_no_cryptomatte(tmp_path: Path) -> None:
    found = single(tmp_path / "x.exr", "-:rgba crypto_object:rgba crypto_object00:rgba")
    assert [item.role for item in found.passes] == [Role.BEAUTY, None, Role.CRYPTOMATTE_OBJECT]
    half = single(tmp_path / "y.exr", "-:rgba crypto_object00:rgba", type="half").passes[1]
    assert half.role is None and "32 bits" in half.reason


# --- the tables ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("renderer", RenderProgram)
def test_a_name_has_one_role_in_a_table(renderer: RenderProgram) -> None:
    names = [name for words in SCHEMES[renderer].names.values() for name in words]
    assert len(names) == len(set(names)) and Role.BEAUTY in SCHEMES[renderer].names


def test_marks_do_not_fit_other_headers() -> None:
    lines = (
        "Software=Blender 5.0.1",
        "arnold/version=7",
        "vrayInfo/x=1",
        "husk:x=1",
        "PRManVersion=26",
        "rs/x=1",
        "generatedBy=Mitsuba 3",
        "nuke/version=15",
        "Software=OpenImageIO 3.2",
        "Software=Adobe Photoshop",
    )
    fits = [[name for name, scheme in SCHEMES.items() if scheme.marks.fullmatch(line)] for line in lines]
    assert fits == [
        [renderer]
        for renderer in (
            RenderProgram.BLENDER,
            RenderProgram.ARNOLD,
            RenderProgram.VRAY,
            RenderProgram.KARMA,
            RenderProgram.RENDERMAN,
            RenderProgram.REDSHIFT,
            RenderProgram.MITSUBA,
            RenderProgram.NUKE,
        )
    ] + [[], []]
