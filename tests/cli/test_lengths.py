"""Units of lengths on the command line: `--set node.value.unit`, `explain` and `check`."""

from __future__ import annotations

BLUR = {
    "nodes": {"blur": {"type": "gaussian_blur", "values": {"sigma": 20.0}}},
    "links": {"blur.image": "light.out", "outputs.image": "blur.out"},
}


def find_length(cli, graph, *options: str) -> dict[str, object]:
    """What `explain` says of the sigma, for a picture of 540 lines."""
    explained = cli("explain", graph, "--json", *options)
    return next(item for item in explained.json["lengths"] if item["value"] == "blur.sigma")


def test_explain_says_how_many_pixels_a_length_is(cli, graphs) -> None:
    plain, relative = graphs("plain.json", **BLUR), graphs("relative.json", **BLUR, settings={"reference_height": 1080})
    assert find_length(cli, plain)["pixels"] == 20.0
    length = find_length(cli, relative)
    assert length["unit"] == "px@1080" and 0.0 < float(str(length["pixels"])) < 20.0
    assert find_length(cli, relative, "--scale", "0.5")["pixels"] == float(str(length["pixels"])) / 2.0
    assert "blur.sigma  20 px@1080 = " in cli("explain", relative).out


def test_a_unit_is_set_before_the_number(cli, graphs) -> None:
    length = find_length(cli, graphs(**BLUR), "--set", "blur.sigma.unit=height", "--set", "blur.sigma=0.5")
    assert (length["number"], length["unit"]) == (0.5, "height")


def test_an_unknown_unit_is_refused_with_a_sentence(cli, graphs) -> None:
    outcome = cli("explain", graphs(**BLUR), "--set", "blur.sigma.unit=inch")
    assert outcome.code and "'inch' is no unit of a length: write px, height, or px@" in outcome.err
    blur = {"type": "gaussian_blur", "units": {"sigma": "em"}}
    checked = cli("check", graphs(nodes={"blur": blur}))
    assert checked.code and "nodes.blur.units.sigma: 'em' is no unit of a length" in checked.out + checked.err
