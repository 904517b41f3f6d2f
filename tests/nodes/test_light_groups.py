"""Light groups of renders, against sums of the groups in numpy."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.errors import InputError
from halation.nodes import LightGroup, name_light_groups
from halation.nodes.input.light_groups import LightGroups
from halation.render_layers.render import read_render
from halation.resources.sandbox import UNRESTRICTED

SIZE = (12, 8)
Array = np.ndarray
NAMES = {
    "Blender": ("ViewLayer.Combined", "ViewLayer.Combined_{}", {"Software": "Blender 5.0.1"}),
    "Arnold": ("", "RGBA_{}", {"arnold/version": "7.2"}),
    "V-Ray": ("", "VRayLightSelect_{}", {}),
    "Karma": ("C", "C_{}", {"Software": "karma 21.0"}),
    "others": ("C", "Beauty_{}", {}),
}


def write_render(folder: Path, program: str = "Blender") -> tuple[str, dict[str, Array]]:
    """A render whose light is that of three groups, and some light of no group."""
    picture, pattern, attributes = NAMES[program]
    random = np.random.default_rng(3)
    groups = {name: random.gamma(1.0, 1.0, (*SIZE[::-1], 3)).astype(np.float32) for name in ("key", "fill", "Rim")}
    rest = random.gamma(0.5, 0.3, (*SIZE[::-1], 3)).astype(np.float32)
    beauty = np.dstack([sum(groups.values()) + rest, random.uniform(0.2, 1.0, SIZE[::-1])])
    prefix = f"{picture}." if picture else ""
    names, layers = [f"{prefix}{channel}" for channel in "RGBA"], [beauty]
    for name, light in groups.items():
        names += [f"{pattern.format(name)}.{channel}" for channel in "RGB"]
        layers.append(light)
    spec = oiio.ImageSpec(*SIZE, len(names), "float")
    spec.channelnames = names
    for name, text in attributes.items():
        spec.attribute(name, text)
    output, path = oiio.ImageOutput.create("a.exr"), folder / "render.exr"
    assert output.open(str(path), spec)
    assert output.write_image(np.ascontiguousarray(np.dstack(layers), np.float32)) and output.close()
    return str(path), groups | {"beauty": beauty.astype(np.float32), "rest": rest}


@pytest.mark.parametrize("program", NAMES)
def test_groups_are_known_by_the_names_of_renderers(tmp_path, program):
    path, _ = write_render(tmp_path, program)
    assert set(read_render(path, sandbox=UNRESTRICTED).light_groups) == {"key", "fill", "Rim"}


def test_without_changes_it_is_the_render(run, tmp_path):
    path, light = write_render(tmp_path)
    assert run(LightGroups(path=path)).tobytes() == light["beauty"].tobytes()
    named = LightGroups(path=path, groups=name_light_groups(key=LightGroup(), fill=LightGroup()))
    assert run(named).tobytes() == light["beauty"].tobytes()


def test_groups_are_dimmed_colored_and_switched_off(run, tmp_path):
    path, light = write_render(tmp_path)
    groups = name_light_groups(key=LightGroup(exposure=1.5, color=(1.0, 0.5, 0.2)), rim=LightGroup(on=False))
    found = run(LightGroups(path=path, groups=groups))
    expected = light["key"] * np.array([1.0, 0.5, 0.2]) * 2.0**1.5 + light["fill"] + light["rest"]
    np.testing.assert_allclose(found[..., :3], expected, atol=1e-5)
    assert (found[..., 3] == light["beauty"][..., 3]).all()


def test_solo_groups_shine_alone(run, tmp_path):
    path, light = write_render(tmp_path)
    groups = name_light_groups(key=LightGroup(solo=True, exposure=-1.0), fill=LightGroup(exposure=2.0))
    np.testing.assert_allclose(run(LightGroups(path=path, groups=groups))[..., :3], 0.5 * light["key"], atol=1e-6)


def test_the_rest_can_be_left_out(run, tmp_path):
    path, light = write_render(tmp_path)
    found = run(LightGroups(path=path, rest=False, groups=name_light_groups(fill=LightGroup(on=False))))
    np.testing.assert_allclose(found[..., :3], light["key"] + light["Rim"], atol=1e-5)


def test_a_temperature_colors_a_group_without_changing_its_luminance(run, tmp_path):
    path, light = write_render(tmp_path)
    groups = name_light_groups(key=LightGroup(temperature=2850.0, solo=True))
    ratio = run(LightGroups(path=path, groups=groups))[..., :3] / light["key"]
    assert (ratio[..., 0] > ratio[..., 1]).all() and (ratio[..., 1] > ratio[..., 2]).all()
    np.testing.assert_allclose(ratio @ [0.2126, 0.7152, 0.0722], 1.0, atol=2e-3)


def test_an_unknown_group_is_named(run, tmp_path):
    path, _ = write_render(tmp_path)
    with pytest.raises(InputError, match="kye"):
        run(LightGroups(path=path, groups=name_light_groups(kye=LightGroup(exposure=1.0))))
