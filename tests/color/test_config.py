"""Which config counts, and what is said of one that cannot be read."""

from __future__ import annotations

import json

import halation as hal
import numpy as np
import pytest
from halation import document
from halation.color.display import list_displays, list_looks, list_views
from halation.color.management import get_color_manager, get_default_color_manager
from halation.color.primaries import find_working_space, primaries_to_xyz
from halation.errors import GraphError, UsageError
from halation.graph import color_settings
from halation.graph.paths import rebase_paths
from halation.nodes import ColorSettings
from halation.resources.sandbox import UNRESTRICTED
from house_config import AP1_LUMINANCE, AP1_TO_REC709, HOUSE, studio, write_house

AP1 = (0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767)


def graph_of(**color: str):
    return document.loads(
        json.dumps({"halation": 1, "settings": {"color": color}}), folder="/shots/a", sandbox=UNRESTRICTED
    )


def test_a_graph_comes_before_the_environment_and_that_before_the_built_in_one(house, tmp_path, monkeypatch):
    assert list_displays()[0] == "sRGB - Display" and get_default_color_manager().is_plain
    monkeypatch.setenv("OCIO", str(house))
    assert list_displays() == ("Screen", "Projector") and not get_default_color_manager().is_plain
    other = write_house(tmp_path, "other.ocio", HOUSE.replace("Screen", "Wall"))
    assert list_displays(get_color_manager(ColorSettings(str(other)), UNRESTRICTED)) == ("Wall", "Projector")
    assert list_displays(get_color_manager(ColorSettings("ocio://default"), UNRESTRICTED))[0] == "sRGB - Display"
    assert (
        list_views("Screen") == ("Plain", "Warm", "none")
        and list_views("proj") == ("Dim", "none")
        and list_looks() == ("warm",)
    )


def test_a_config_that_changes_is_read_again(house):
    color = ColorSettings(str(house))
    digest = get_color_manager(color, UNRESTRICTED).digest
    house.write_text(HOUSE.replace("Projector", "Laser projector"))
    assert (
        list_displays(get_color_manager(color, UNRESTRICTED)) == ("Screen", "Laser projector")
        and get_color_manager(color, UNRESTRICTED).digest != digest
    )


def test_paths_start_at_the_folder_of_the_graph():
    graph = graph_of(config="../house.ocio")
    assert color_settings(graph).config == "/shots/a/../house.ocio"
    assert rebase_paths(graph, "/shots/b/c").settings.color.config == "../../house.ocio"
    built_in = graph_of(config="ocio://default")
    assert color_settings(built_in).config == rebase_paths(built_in, "/x").settings.color.config == "ocio://default"


def test_only_what_differs_is_saved_and_the_rest_is_kept():
    plain = document.loads('{"halation": 1}', sandbox=UNRESTRICTED)
    assert "color" not in document.dumps(plain) and plain.settings.color == ColorSettings()
    text = '{"halation": 1, "settings": {"color": {"working": "ACEScg", "new": [1]}}}'
    again = json.loads(document.dumps(document.loads(text, sandbox=UNRESTRICTED)))
    assert again["settings"] == {"color": {"new": [1], "working": "ACEScg"}}
    with pytest.raises(GraphError, match=r"settings\.color\.config"):
        document.loads('{"halation": 1, "settings": {"color": {"config": 3}}}', sandbox=UNRESTRICTED)


@pytest.mark.parametrize(
    ("config", "said"),
    [
        ("hause.ocio", r"color\.config: .*hause\.ocio: there is no such color config; did you mean 'house\.ocio'"),
        ("broken.ocio", r"settings\.color\.config: .*broken\.ocio: is no color config that can be read"),
        ("ocio://studio-config-latst", r"no such built-in config; did you mean 'ocio://studio-config-latest'"),
    ],
)
def test_a_config_that_is_not_there(house, tmp_path, config, said):
    (tmp_path / "broken.ocio").write_text("hello: [")
    path = config if config.startswith("ocio:") else str(tmp_path / config)
    with pytest.raises(GraphError, match=said) as fault:
        list_displays(get_color_manager(ColorSettings(path), UNRESTRICTED))
    assert "\n" not in str(fault.value)


def test_a_broken_environment_is_one_of_usage(monkeypatch, tmp_path):
    monkeypatch.setenv("OCIO", str(tmp_path / "gone.ocio"))
    with pytest.raises(UsageError, match=r"^\$OCIO: .*gone\.ocio: there is no such color config"):
        list_displays()
    assert list_displays(get_color_manager(ColorSettings("ocio://default"), UNRESTRICTED))


@pytest.mark.parametrize("name", ["ACEScg", "acescg", "lin_ap1", "scene_linear", "lin_ap1_scene"])
def test_acescg_by_its_names(name):
    made = find_working_space(get_color_manager(ColorSettings("", name), UNRESTRICTED))
    assert made is not None
    np.testing.assert_allclose(np.reshape(made.to_rec709, (3, 3)), AP1_TO_REC709, atol=1e-6)
    np.testing.assert_allclose(np.reshape(made.from_rec709, (3, 3)), np.linalg.inv(AP1_TO_REC709), atol=1e-6)
    assert made.luminance == pytest.approx(AP1_LUMINANCE, abs=1e-9)
    np.testing.assert_allclose(primaries_to_xyz(AP1)[1], AP1_LUMINANCE, atol=1e-9)


@pytest.mark.parametrize("name", ["", "linear rec709", "lin_rec709_scene", "Linear Rec.709 (sRGB)", "lin_srgb"])
def test_linear_rec709_needs_no_other_shaders(name, house):
    assert (
        find_working_space(get_color_manager(ColorSettings("", name), UNRESTRICTED)) is None
        and find_working_space(get_color_manager(ColorSettings(str(house), name), UNRESTRICTED)) is None
    )


def test_a_house_may_call_it_otherwise(house):
    manager = get_color_manager(ColorSettings(str(house)), sandbox=UNRESTRICTED)
    assert manager.working.name == "house seven"  # found by what it computes
    assert get_color_manager(ColorSettings(str(house), "acescg"), sandbox=UNRESTRICTED).working.name == "house linear"
    made = find_working_space(get_color_manager(ColorSettings(str(house), "scene_linear"), UNRESTRICTED))
    assert made is not None and made.luminance == pytest.approx(AP1_LUMINANCE, abs=1e-9)


def test_what_a_config_lacks_comes_over_the_interchange_space(house, light):
    manager = get_color_manager(ColorSettings(str(house)), sandbox=UNRESTRICTED)
    found = manager.find("arri logc4")
    assert found is not None and not found.own
    made = light.reshape(-1, 3).copy()
    manager.make_processor(manager.working, found).getDefaultCPUProcessor().applyRGB(made)
    expected = light.reshape(-1, 3).copy()
    studio().getProcessor("lin_rec709_scene", "arri_logc4").getDefaultCPUProcessor().applyRGB(expected)
    np.testing.assert_allclose(made, expected, atol=2e-5)


@pytest.mark.parametrize(
    ("working", "said"),
    [
        ("ACESgc", "'ACESgc' is unknown: did you mean 'ACEScg'"),
        ("house log", "'house log' is not scene-linear"),
        ("numbers", "'numbers' holds numbers, not color"),
    ],
)
def test_a_working_space_that_makes_no_sense(house, working, said):
    config = "" if working == "ACESgc" else str(house)
    with pytest.raises(GraphError, match=rf"^settings\.color\.working: {said}") as fault:
        find_working_space(get_color_manager(ColorSettings(config, working), UNRESTRICTED))
    assert "\n" not in str(fault.value)


def test_a_config_without_a_way_to_rec709_says_what_to_do(tmp_path):
    text = HOUSE.replace("aces_interchange: exchange, ", "").replace("0.055", "0.2")
    start = text.index("  - !<ColorSpace>\n    name: house seven")
    end = text.index("  - !<ColorSpace>\n    name: house texture")
    alone = write_house(tmp_path, "alone.ocio", text[:start] + text[end:])
    with pytest.raises(GraphError, match=r"set settings\.color\.working to a space or role of this config"):
        _ = get_color_manager(ColorSettings(str(alone)), sandbox=UNRESTRICTED).working
    assert (
        get_color_manager(ColorSettings(str(alone), "scene_linear"), sandbox=UNRESTRICTED).working.name
        == "house linear"
    )


def test_a_graph_without_files_minds_no_environment(monkeypatch):
    monkeypatch.setenv("OCIO", "/gone.ocio")
    text = """{"halation": 1, "settings": {"size": [8, 8]}, "outputs": {"o": {"type": "Image"}},
        "nodes": {"c": {"type": "checker"}}, "links": {"outputs.o": "c.out"}}"""
    assert np.isfinite(hal.render(document.loads(text, sandbox=UNRESTRICTED))["o"]).all()


def test_names_of_the_users_config_that_are_not_utf8_are_found_at_once(house, monkeypatch):
    house.write_bytes(house.read_bytes().replace(b"Screen", "Schirm \u00fc".encode("latin-1")))
    monkeypatch.setenv("OCIO", str(house))
    with pytest.raises(UsageError, match=r"^\$OCIO: "):
        get_default_color_manager().config  # noqa: B018
