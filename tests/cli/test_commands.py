"""explain, nodes, fmt, demo, and what the program says of itself."""

from __future__ import annotations

import json
import re
from importlib import metadata
from pathlib import Path

import numpy as np
import pytest
from command_reference import list_commands
from exr_files import header, read
from halation.nodes import catalogue

# --- explain ------------------------------------------------------------------------------------------------------

CHAIN = {
    "nodes": {"blur": {"type": "gaussian_blur", "values": {"sigma": 2.0}}, "color": {"type": "saturation"}},
    "links": {"blur.image": "light.out", "color.image": "blur.out", "outputs.image": "color.out"},
}


def test_explain_prints_passes_and_the_peak(cli, graphs, shot):
    result = cli("explain", graphs(**CHAIN), "--set", "color.saturation=0.5")
    assert result.code == 0 and result.err == ""
    assert f"inputs.beauty <- {shot}:Combined" in result.out
    assert re.search(r"^pass 0 .*48x32.*exposure", result.out, re.M)
    # the largest moment: the upload (half) and the first result (float), or two results; never less than one of each
    total = re.search(r"(\d+) passes, (\d+) programs, .* peak ([\d.]+) KiB", result.out)
    assert total and float(total[3]) * 1024 >= 48 * 32 * 16


def test_explain_for_machines(cli, graphs):
    found = cli("explain", graphs(**CHAIN), "--set", "color.saturation=0.5", "--json").json
    assert found["form"] == "compute" and list(found["outputs"]) == ["image"]
    assert found["peak_bytes"] >= max(item["bytes"] for item in found["surfaces"])
    assert {name for item in found["passes"] for name in item["nodes"]} >= {"light", "blur", "color"}


def test_explain_what_if(cli, graphs, shot):
    """Every flag changes the plan as it would change the rendering."""
    path = graphs(**CHAIN)

    def plan(*words):
        return cli("explain", path, *words, "--json").json

    def sizes(found):
        return {tuple(item["size"]) for item in found["surfaces"]}

    assert {one["form"] for one in plan("--form", "fragment")["passes"]} == {"fragment"}
    assert sizes(plan()) == {(48, 32)} and (24, 16) in sizes(plan("--scale", "0.5"))
    assert (20, 10) in sizes(plan("--size", "20x10"))
    assert plan("--precision", "half")["peak_bytes"] < plan("--precision", "float")["peak_bytes"]
    assert plan("-i", f"{shot}:Cool")["uploads"][0]["layer"] == "Cool"
    assert list(plan("--node", "light")["outputs"]) == ["light"]
    assert "blur" not in {name for one in plan("--node", "light")["passes"] for name in one["nodes"]}
    # without light there is nothing to brighten: the node vanishes
    assert "light" not in {name for one in plan("--set", "light.stops=0")["passes"] for name in one["nodes"]}
    for words in (("--form", "x"), ("--precision", "x"), ("--size", "x"), ("--scale", "2"), ("--node", "x")):
        assert cli("explain", path, *words).code == 2


def test_explain_says_which_form_of_passes_and_why(cli, graphs):
    path = graphs(**CHAIN)
    assert cli("explain", path).out.splitlines()[0] == (
        "target    none, GL 4.3, compute passes (planned without a device)"
    )
    here = cli("explain", path, "--form", "device")
    line = r"target    \w.*, GL \d\.\d, (compute|fragment) passes \((by the table|measured): .+\)$"
    assert re.match(line, here.out, re.M)
    found = cli("explain", path, "--form", "device", "--json").json
    assert found["target"] in here.out and found["why"] in here.out
    ran = cli("bench", path, "-n", "1", "--warm-up", "0", "--json").json["device"]
    assert f"{found['target']} " in ran and f"{found['form']} passes" in ran, "what explain says is what runs"


def test_explain_as_graphviz(cli, graphs):
    result = cli("explain", graphs(**CHAIN), "--dot")
    assert result.code == 0 and result.out.startswith("digraph plan {") and result.out.rstrip().endswith("}")
    assert len(re.findall(r"^  pass\d+ \[", result.out, re.M)) == len(
        cli("explain", graphs(**CHAIN), "--json").json["passes"]
    )
    assert cli("explain", graphs(), "--dot", "--json").code == 2


# --- nodes --------------------------------------------------------------------------------------------------------


def test_nodes_lists_the_catalogue(cli):
    result = cli("nodes")
    known = catalogue()
    assert result.code == 0
    assert re.findall(r"^  (\w+) +\S", result.out, re.M) == [*known]
    assert {line for line in result.out.splitlines() if line and line[0] != " "} == {
        node.category for node in known.values()
    }


@pytest.mark.parametrize("id", catalogue())
def test_nodes_shows_a_page(cli, id):
    result = cli("nodes", id)
    node = catalogue()[id]
    assert result.code == 0 and result.out.startswith(f"{id}  ({node.category}, version {node.version})")
    for name in (*node.inputs, *node.outputs, *node.values):
        assert re.search(rf"^  {name} ", result.out, re.M), name
    *passes, peak = result.out.split("\npasses at these values, 1920x1080\n")[1].splitlines()
    facts = cli("nodes", id, "--json").json["plan"]
    assert peak.endswith(" of textures at the peak") and len(passes) == max(1, len(facts["passes"]))
    for index, (line, item) in enumerate(zip(passes, facts["passes"], strict=False)):
        assert line.startswith(f"  {index} ") and item["label"] in line
        assert all(f"{'x'.join(map(str, one['size']))} {one['format']}" in line for one in item["writes"])


def test_nodes_for_machines(cli):
    every = cli("nodes", "--json").json["nodes"]
    assert [item["id"] for item in every] == [*catalogue()]
    one = cli("nodes", "vignette", "--json").json
    assert one == next(item for item in every if item["id"] == "vignette")
    amount = one["values"]["amount"]
    assert (amount["default"], amount["soft"], amount["hard"], amount["unit"]) == (0.5, [0, 1], [-16, 1], "ratio")
    assert one["inputs"]["image"]["type"] == "Image" and "smooth" in one["values"]["falloff"]["choices"]
    assert one["plan"]["passes"] == [{"label": "vignette", "writes": [{"size": [1920, 1080], "format": "rgba32f"}]}]


def list_ids(text: str) -> list[str]:
    return re.findall(r"^  (\w+) +\S", text, re.M)


def test_nodes_of_a_menu_and_of_another_name_are_listed(cli):
    lens = list_ids(cli("nodes", "lens").out)
    assert set(lens) >= {id for id, node in catalogue().items() if node.category == "lens"}
    assert {item["id"] for item in cli("nodes", "lens", "--json").json["nodes"]} == set(lens)
    for node in catalogue().values():
        if node.aliases and node.aliases[0] not in catalogue():
            assert node.id in list_ids(cli("nodes", node.aliases[0].upper()).out), node.id
    assert list_ids(cli("nodes", "Unsharp-Mask").out) == ["sharpen"]
    merge = cli("nodes", "merge")
    assert merge.out.startswith("merge  (") and merge.err.startswith("the menu merge has ")
    nothing = cli("nodes", "nowhere-at-all")
    assert nothing.code == 2 and "there is no node, menu or installed plug-in 'nowhere-at-all'" in nothing.err


def test_a_page_has_the_other_names_of_a_node(cli):
    assert "\nalso known as unsharp mask, usm, " in cli("nodes", "sharpen").out
    assert "\nAlso known as unsharp mask, usm, " in cli("nodes", "--markdown").out
    assert cli("nodes", "sharpen", "--json").json["aliases"] == list(catalogue()["sharpen"].aliases)


def test_no_summary_of_the_help_is_cut(cli, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    lines = cli("--help").out.partition("\nCommands:\n")[2].partition("\n\n")[0].splitlines()
    assert len(lines) > 20 and all(line.endswith(".") and not line.endswith("...") for line in lines)


def test_a_neutral_node_has_no_passes(cli):
    assert "  none: the picture passes through unchanged\n" in cli("nodes", "exposure").out
    assert "  none: nothing has to be drawn\n" in cli("nodes", "read_image").out
    assert cli("nodes", "exposure", "--json").json["plan"]["passes"] == []


# --- fmt ----------------------------------------------------------------------------------------------------------


def test_fmt_rewrites_once(cli, graphs):
    path = graphs()
    messy = path.read_bytes()
    result = cli("fmt", "--check", path)
    assert (result.code, path.read_bytes()) == (1, messy) and f"{path}: would be rewritten" in result.err
    assert cli("fmt", path).code == 0 and path.read_bytes() != messy
    tidy = path.read_bytes()
    result = cli("fmt", path)
    assert (result.code, path.read_bytes()) == (0, tidy) and result.err == "1 file: nothing to rewrite\n"
    assert cli("fmt", "--check", path).code == 0
    assert json.loads(tidy)["nodes"]["light"]["values"] == json.loads(messy)["nodes"]["light"]["values"]


def test_fmt_minds_the_ends_of_lines(cli, graphs):
    path = graphs()
    cli("fmt", path)
    path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    assert cli("fmt", "--check", path).code == 1


def test_fmt_for_machines(cli, graphs):
    one, two = graphs("one.json"), graphs("two.json")
    assert cli("fmt", one).code == 0
    result = cli("fmt", "--check", one, two, "--json")
    assert result.code == 1 and result.json == {"changed": [str(two)], "checked": 2, "written": False}
    assert cli("fmt", one, two, "--json").json == {"changed": [str(two)], "checked": 2, "written": True}


def test_fmt_changes_nothing_where_one_file_is_broken(cli, graphs, tmp_path):
    path, broken = graphs(), tmp_path / "broken.json"
    broken.write_text('{"halation": 1, "nodes": 3}')
    before = path.read_bytes()
    result = cli("fmt", path, broken)
    assert result.code == 3 and result.err.startswith(f"halation: {broken}: nodes: ")
    assert (path.read_bytes(), broken.read_text()) == (before, '{"halation": 1, "nodes": 3}')


# --- demo ---------------------------------------------------------------------------------------------------------


def test_demo_renders_every_preset(cli, graphs, tmp_path, monkeypatch):
    from halation import presets

    paths = (graphs("one.json"), graphs("two.json", nodes={"light": {"type": "exposure", "values": {"stops": -1.0}}}))
    monkeypatch.setattr(presets, "paths", lambda: paths)
    folder = tmp_path / "a" / "b"
    result = cli("demo", "-o", folder)
    assert result.code == 0 and sorted(item.name for item in folder.iterdir()) == [
        "one.exr",
        "one.png",
        "two.exr",
        "two.png",
    ]
    np.testing.assert_allclose(read(folder / "one.exr"), read(folder / "two.exr") * (4, 4, 4, 1), rtol=1e-3)
    lines = result.err.splitlines()
    assert len(lines) == 3 and lines[1].startswith("one ") and lines[2].endswith(str(folder / "two.png"))
    found = cli("demo", "--output", folder, "--json").json
    assert [item["preset"] for item in found["pictures"]] == ["one", "two"]
    assert found["device"].startswith(header(folder / "one.exr")["halation:renderer"])


def test_demo_says_where_it_cannot_write(cli, shot):
    result = cli("demo", "-o", shot / "out")
    assert result.code == 1 and result.err.startswith(f"halation: {shot / 'out'}: the folder cannot be created (")


# --- the program --------------------------------------------------------------------------------------------------


def test_version(cli):
    result = cli("--version")
    assert (result.code, result.out) == (0, f"halation {metadata.version('halation')}\n")


def test_help(cli):
    result = cli("--help")
    assert result.code == 0 and result.out.count("130  interrupted") == 1
    for command in ("render", "check", "explain", "info", "nodes", "fmt", "demo", "gallery"):
        assert f"\n  {command} " in result.out
        page = cli(command, "--help")
        assert page.code == 0 and "--json" in page.out and page.out.startswith(f"Usage: halation {command} ")


def test_without_a_command_the_help_is_shown(cli):
    result = cli()
    assert (result.code, result.out) == (2, "") and result.err.startswith("Usage: halation ")


def test_the_reference_has_every_command_and_exit_code(cli):
    docs = Path(__file__).parents[2] / "docs"
    page = (docs / "command-line.md").read_text(encoding="utf-8")
    everything = page + "".join((docs / name).read_text(encoding="utf-8") for name in ("fit.md", "running.md"))
    shown = set(re.findall(r"^## halation ([\w-]+)$", page, re.M))
    assert shown == {name for name, command in list_commands().items() if not command.hidden}
    assert all(f"<!-- {name} -->" in everything for name in shown)
    codes = set(re.findall(r"^(\d+)  ", cli("--help").out.replace("\n  ", "\n"), re.M))
    assert codes <= {code for row in re.findall(r"^\| (\d+[\d, ]*) \|", page, re.M) for code in row.split(", ")}
