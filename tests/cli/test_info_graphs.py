"""`halation info` of graphs and presets: inputs, controls and outputs, with what to type."""

from __future__ import annotations

from pathlib import Path


def test_a_graph_says_what_it_takes_and_what_can_be_changed(cli, graphs) -> None:
    graph = graphs(
        inputs={"mask": {"type": "Field", "default": 0.25, "doc": "Where."}},
        controls={"stops": {"target": "light.stops", "doc": "How bright."}},
        ui={"about": {"doc": "A look.", "tags": ["test"]}},
        settings={"frames": [3, 12]},
    )
    facts = cli("info", graph, "--json").json
    assert facts["doc"] == "A look." and facts["tags"] == ["test"] and facts["frames"] == [3, 12]
    assert facts["inputs"]["beauty"]["layer"] == "Combined" and facts["inputs"]["mask"]["source"] == "0.25"
    stops = facts["controls"]["stops"]
    assert (stops["value"], stops["range"], stops["unit"]) == ("1", "-10 .. 10", "EV")
    assert stops["target"] == "light.stops" and facts["outputs"]["image"]["type"] == "Image"
    said = cli("info", graph)
    lines = [" ".join(line.split()) for line in said.out.splitlines()]
    assert said.code == 0 and f"{graph}: A look." in lines
    assert "beauty Image Combined of shot.exr" in lines and "mask Field 0.25 Where." in lines
    assert "stops 1 -10 .. 10 EV How bright." in lines
    assert lines[-1] == "1 node, frames 3-12 at 24 per second; halation explain shows its passes"


def test_what_it_says_can_be_typed(cli, tmp_path: Path) -> None:
    """The names and numbers of a preset render."""
    facts = cli("info", "soft_bloom", "--json").json
    sets = [word for name, item in facts["controls"].items() for word in ("--set", f"{name}={item['value']}")]
    assert len(sets) == 8 and [*facts["inputs"]] == ["beauty"]
    assert cli("render", "soft_bloom", "-o", tmp_path / "a.png", *sets, "--scale", "0.1").code == 0


def test_a_picture_of_the_name_of_a_preset_is_a_picture(cli, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("soft_bloom").write_bytes(b"no picture")
    assert cli("info", "soft_bloom").code == 4


def test_a_broken_graph_is_said(cli, tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text("{")
    said = cli("info", tmp_path / "a.json")
    assert said.code == 3 and "not valid JSON" in said.err
