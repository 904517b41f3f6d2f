"""Names that renderers give the layers of a render: one table per renderer, from the role of a layer to its names.

Case, blanks, `_` and `-` do not matter. Of several names for one role the first one is preferred.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from enum import StrEnum
from types import MappingProxyType

from msgspec import Struct

from ..media.channels import DATA_NAMES
from ..media.layers import normalize_name


class Role(StrEnum):
    """The role of a layer."""

    BEAUTY = "beauty"
    NOISY = "noisy_beauty"
    """The picture before denoising."""
    LIGHT_GROUP = "light_group"
    """The part of the picture that comes from some of the lights."""

    DEPTH = "depth"
    MIST = "mist"
    NORMAL = "normal"
    POSITION = "position"
    VELOCITY = "velocity"
    """Motion in the picture."""
    MOTION = "motion"
    """Motion in space."""
    UV = "uv"

    ALBEDO = "albedo"
    EMISSION = "emission"
    ENVIRONMENT = "environment"
    OCCLUSION = "occlusion"
    SHADOW = "shadow"
    DIFFUSE = "diffuse"
    DIFFUSE_DIRECT = "diffuse_direct"
    DIFFUSE_INDIRECT = "diffuse_indirect"
    SPECULAR = "specular"
    SPECULAR_DIRECT = "specular_direct"
    SPECULAR_INDIRECT = "specular_indirect"
    SPECULAR_COLOR = "specular_color"
    TRANSMISSION = "transmission"
    TRANSMISSION_DIRECT = "transmission_direct"
    TRANSMISSION_INDIRECT = "transmission_indirect"
    TRANSMISSION_COLOR = "transmission_color"
    COAT = "coat"
    SHEEN = "sheen"
    SUBSURFACE = "subsurface"
    VOLUME = "volume"
    VOLUME_DIRECT = "volume_direct"
    VOLUME_INDIRECT = "volume_indirect"

    OBJECT_ID = "object_id"
    MATERIAL_ID = "material_id"
    CRYPTOMATTE_OBJECT = "cryptomatte_object"
    CRYPTOMATTE_MATERIAL = "cryptomatte_material"
    CRYPTOMATTE_ASSET = "cryptomatte_asset"
    CRYPTOMATTE = "cryptomatte"
    """A matte whose names are not listed."""
    MATTE = "matte"

    DENOISE_NORMAL = "denoise_normal"
    DENOISE_ALBEDO = "denoise_albedo"
    DENOISE_DEPTH = "denoise_depth"
    VARIANCE = "variance"
    """The noise of another layer, for a denoiser."""
    SAMPLES = "samples"

    @property
    def words(self) -> str:
        """The role in words."""
        return self.value.replace("_", " ")


PLURAL_ROLES = frozenset(
    {
        Role.LIGHT_GROUP,
        Role.MATTE,
        Role.VARIANCE,
        Role.CRYPTOMATTE,
        Role.CRYPTOMATTE_OBJECT,
        Role.CRYPTOMATTE_MATERIAL,
        Role.CRYPTOMATTE_ASSET,
    }
)
"""Roles that several layers may have."""


class RenderProgram(StrEnum):
    """The renderer that made a file."""

    BLENDER = "Blender"
    ARNOLD = "Arnold"
    VRAY = "V-Ray"
    KARMA = "Karma"
    RENDERMAN = "RenderMan"
    REDSHIFT = "Redshift"
    MITSUBA = "Mitsuba"
    NUKE = "Nuke"


class NamingScheme(Struct, frozen=True):
    """The names of one renderer. `marks` match `attribute=value` of headers that only it writes."""

    marks: re.Pattern[str]
    names: Mapping[Role, tuple[str, ...]]

    def find_role(self, word: str) -> tuple[Role, int] | None:
        """The role of a normalized name, and how many names of that role are preferred to it."""
        return next(((role, names.index(word)) for role, names in self.names.items() if word in names), None)


def _make_scheme(marks: str, **names: str) -> NamingScheme:
    table = {Role(role): tuple(normalize_name(name) for name in words.split()) for role, words in names.items()}
    return NamingScheme(re.compile(marks, re.IGNORECASE), MappingProxyType(table))


SCHEMES: Mapping[RenderProgram, NamingScheme] = MappingProxyType(
    {
        # The short names are those of 2.8 to 4.x, the long ones those of 5.x.
        RenderProgram.BLENDER: _make_scheme(
            r"BlenderMultiChannel=.*|Software=Blender.*|cycles\..*",
            beauty="Combined",
            noisy_beauty="Noisy_Image",
            depth="Depth",
            mist="Mist",
            normal="Normal",
            position="Position",
            velocity="Vector",
            uv="UV",
            albedo="DiffCol Diffuse_Color",
            emission="Emit Emission",
            environment="Env Environment",
            occlusion="AO Ambient_Occlusion",
            shadow="Shadow Shadow_Catcher",
            diffuse_direct="DiffDir Diffuse_Direct",
            diffuse_indirect="DiffInd Diffuse_Indirect",
            specular_direct="GlossDir Glossy_Direct",
            specular_indirect="GlossInd Glossy_Indirect",
            specular_color="GlossCol Glossy_Color",
            transmission_direct="TransDir Transmission_Direct",
            transmission_indirect="TransInd Transmission_Indirect",
            transmission_color="TransCol Transmission_Color",
            volume_direct="VolumeDir Volume_Direct",
            volume_indirect="VolumeInd Volume_Indirect",
            object_id="IndexOB Object_Index",
            material_id="IndexMA Material_Index",
            denoise_normal="Denoising_Normal",
            denoise_albedo="Denoising_Albedo",
            denoise_depth="Denoising_Depth",
            samples="Debug_Sample_Count",
        ),
        RenderProgram.ARNOLD: _make_scheme(
            r"arnold/.*|Software=Arnold.*",
            beauty="RGBA RGB beauty",
            depth="Z depth",
            normal="N",
            position="P",
            velocity="motionvector",
            albedo="albedo diffuse_albedo",
            emission="emission",
            environment="background",
            occlusion="ao",
            shadow="shadow_matte",
            diffuse="diffuse",
            diffuse_direct="diffuse_direct",
            diffuse_indirect="diffuse_indirect",
            specular="specular",
            specular_direct="specular_direct",
            specular_indirect="specular_indirect",
            specular_color="specular_albedo",
            transmission="transmission",
            transmission_direct="transmission_direct",
            transmission_indirect="transmission_indirect",
            transmission_color="transmission_albedo",
            coat="coat coat_direct coat_indirect",
            sheen="sheen sheen_direct sheen_indirect",
            subsurface="sss sss_direct sss_indirect",
            volume="volume",
            volume_direct="volume_direct",
            volume_indirect="volume_indirect",
            object_id="ID",
            denoise_normal="N_denoise N_noice",
            denoise_albedo="denoise_albedo_noice denoise_albedo",
            denoise_depth="Z_denoise Z_noice",
            variance="variance noice_variance",
        ),
        RenderProgram.VRAY: _make_scheme(
            r"vrayInfo/.*|vfb2_layers_json=.*|Software=V-?Ray.*",
            beauty="RGBA RGB rgb_color effectsResult",
            depth="VRayZDepth zDepth Z",
            mist="atmosphere VRayAtmosphere",
            normal="VRayNormals normals VRayBumpNormals bump_normals",
            position="VRayWorldPosition worldPosition VRaySamplerInfo SamplerInfo",
            velocity="VRayVelocity velocity",
            uv="uvs",
            albedo="VRayDiffuseFilter diffuse",
            emission="VRaySelfIllumination selfIllumination",
            environment="VRayBackground background",
            occlusion="AO VRayExtraTexAO ExtraTexAO",
            shadow="VRayShadows shadow",
            diffuse_direct="VRayLighting lighting",
            diffuse_indirect="VRayGlobalIllumination globalIllumination gi",
            specular_direct="VRaySpecular specular",
            specular_indirect="VRayReflection reflection",
            specular_color="VRayReflectionFilter reflection_filter",
            transmission="VRayRefraction refraction",
            transmission_color="VRayRefractionFilter refraction_filter",
            coat="VRayCoatSpecular coat_specular VRayCoatReflection coat_reflection",
            sheen="VRaySheenSpecular sheen_specular VRaySheenReflection sheen_reflection",
            subsurface="VRaySSS2 SSS2 VRaySubsurface",
            object_id="VRayRenderID renderID VRayNodeID nodeID",
            material_id="VRayMtlID mtlID materialID",
            matte="MultiMatteElement MultiMatte",
            denoise_albedo="VRayDenoiserAlbedo denoiserAlbedo",
            denoise_normal="VRayDenoiserNormals denoiserNormals",
            samples="VRaySampleRate sampleRate",
        ),
        RenderProgram.KARMA: _make_scheme(
            r"(karma|husk|mantra)[:/].*|Software=.*\b(karma|husk|mantra|houdini)\b.*|HoudiniVersion=.*",
            beauty="C RGBA RGB beauty",
            depth="depth hitPz Pz hitdist",
            normal="N Ng Ng_camera N_camera",
            position="P P_camera",
            velocity="motionvectors velocity",
            uv="uv uv_extra st",
            albedo="albedo albedodiffuse basecolor",
            emission="combinedemission directemission indirectemission",
            environment="visiblelights",
            occlusion="ao",
            diffuse="combineddiffuse",
            diffuse_direct="directdiffuse",
            diffuse_indirect="indirectdiffuse",
            specular="combinedglossyreflection glossyreflection",
            specular_direct="directglossyreflection",
            specular_indirect="indirectglossyreflection",
            specular_color="albedoreflection",
            transmission="combinedtransmission glossytransmission",
            transmission_direct="directtransmission",
            transmission_indirect="indirecttransmission",
            coat="combinedcoat coat",
            subsurface="sss combinedsss",
            volume="combinedvolume",
            volume_direct="directvolume",
            volume_indirect="indirectvolume",
            object_id="primid element",
        ),
        RenderProgram.RENDERMAN: _make_scheme(
            r"PRManVersion=.*|(rman|prman|Pixar)[:/].*|Software=.*\b(RenderMan|prman)\b.*",
            beauty="Ci RGBA RGB beauty",
            depth="z zfiltered __depth",
            normal="Nn __Nworld normal",
            position="P __Pworld",
            velocity="motionBack motionFore backward forward",
            motion="dPdtime dPcameradtime",
            uv="__st",
            albedo="albedo",
            emission="emissive",
            occlusion="occluded",
            diffuse="diffuse",
            diffuse_direct="directDiffuse",
            diffuse_indirect="indirectDiffuse",
            specular="specular",
            specular_direct="directSpecular",
            specular_indirect="indirectSpecular",
            transmission="transmissive",
            subsurface="subsurface",
            object_id="id rawId",
            samples="sampleCount",
        ),
        RenderProgram.REDSHIFT: _make_scheme(
            r"(rs|redshift)/.*|Software=.*\bRedshift\b.*",
            beauty="RGBA RGB beauty",
            depth="Z Depth",
            mist="VolumeFogEmission",
            normal="N Normals BumpNormals",
            position="P WorldPosition Position",
            velocity="MotionVectors",
            uv="UV",
            albedo="DiffuseFilter Albedo",
            emission="Emission",
            environment="Background",
            occlusion="AO AmbientOcclusion",
            shadow="Shadows",
            diffuse_direct="DiffuseLighting",
            diffuse_indirect="GI GlobalIllumination",
            specular_direct="SpecularLighting",
            specular_indirect="Reflections",
            specular_color="ReflectionsFilter",
            transmission="Refractions",
            transmission_color="RefractionsFilter",
            subsurface="SubSurfaceScatter",
            volume="VolumeLighting",
            object_id="ObjectID",
            matte="PuzzleMatte",
        ),
        RenderProgram.MITSUBA: _make_scheme(
            r"generatedBy=Mitsuba.*|Software=Mitsuba.*",
            beauty="img RGBA RGB",
            depth="depth dd",
            normal="sh_normal geo_normal nn",
            position="position pp",
            uv="uv",
            albedo="albedo al",
            object_id="shape_index id",
        ),
        RenderProgram.NUKE: _make_scheme(
            r"nuke/.*|Software=.*\bNuke\b.*",
            beauty="rgba rgb",
            depth="depth",
            normal="N normal",
            position="P worldpos Position",
            velocity="backward forward motion",
            uv="STMap",
            matte="mask",
            object_id="ObjectID id",
        ),
    }
)

PATTERNS: Mapping[Role, re.Pattern[str]] = MappingProxyType(
    {
        role: re.compile(pattern)
        for role, pattern in {
            Role.DENOISE_NORMAL: r"denois(e|er|ing)n(ormals?)?|n(ormals?)?denois(e|er|ing|ed)",
            Role.DENOISE_ALBEDO: r"denois(e|er|ing)albedo|albedodenois(e|er|ing|ed)",
            Role.DENOISE_DEPTH: r"denois(e|er|ing)(z|depth)|(z|depth)denois(e|er|ing|ed)",
            Role.VARIANCE: r".+(variance|var|mse)",
            Role.NORMAL: r"(world|camera|shading|smooth|bump)?normals?(world|camera|ws|cs)?|n(world|camera|s)",
            Role.POSITION: r"(world|camera)?(pos|position)(world|camera|ws|cs)?|p(ref)?(world|camera)|"
            r"point(position)?s?",
            Role.VELOCITY: r"(2d|screen|pixel)?(motionvec(tor)?s?|motion|velocity)(2d|screen|pixels?)?|mv",
            Role.MOTION: r"(motion|velocity)3d|worldvelocity",
            Role.UV: r"uvs?\d*|texcoords?|stmap",
            Role.ALBEDO: r"(diffuse|base)?albedo(color)?|(diffuse|base)color",
            Role.EMISSION: r"emission|emissive|selfillum(ination)?|incandescence",
            Role.OCCLUSION: r"ao|ambientocclusion|occlusion",
            Role.ENVIRONMENT: r"environment|background",
            Role.SHADOW: r"shadows?(pass|mask)?",
            Role.DIFFUSE_DIRECT: r"directdiffuse|diffusedirect",
            Role.DIFFUSE_INDIRECT: r"indirectdiffuse|diffuseindirect|gi",
            Role.SPECULAR_DIRECT: r"direct(specular|glossy)|(specular|glossy)direct",
            Role.SPECULAR_INDIRECT: r"indirect(specular|glossy)|(specular|glossy)indirect|reflections?",
            Role.TRANSMISSION: r"transmission|refractions?",
            Role.SUBSURFACE: r"sss|subsurface(scattering)?",
            Role.OBJECT_ID: r"(object|node|prim|instance)(id|index)s?",
            Role.MATERIAL_ID: r"(material|mtl|shader)(id|index)s?",
            Role.MATTE: r"(puzzle|multi|holdout|object)?(mattes?|masks?)\d*",
            Role.BEAUTY: r"beauty|main|primary|final",
        }.items()
    }
)
"""Patterns of names that are clear in every renderer, whole and normalized."""

HINTS: Mapping[Role, re.Pattern[str]] = MappingProxyType(
    {
        role: re.compile(DATA_NAMES[word])
        for role, word in {
            Role.DEPTH: "depth",
            Role.NORMAL: "normal",
            Role.POSITION: "position",
            Role.VELOCITY: "velocity",
            Role.UV: "uv",
            Role.MATTE: "matte",
            Role.OBJECT_ID: "id",
        }.items()
    }
)
"""Words in a name that only suggest a role."""
