"""`halation sweep`: every combination once, each the picture that `render --set` makes, on a sheet with labels."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from exr_files import header, read


def swept(cli, graph, *words, out="sheet.png"):
    sheet = graph.parent / out
    result = cli("sweep", graph, "-o", sheet, "--cell", "48", *words, "--json")
    assert result.code == 0, result.err
    assert tuple(read(sheet).shape[1::-1]) == tuple(result.json["size"])
    return result.json


def values(found, name):
    return [cell["values"][name] for cell in found["cells"]]


@pytest.mark.parametrize("ending", ["png", "exr"])
def test_cells_alone_are_what_render_makes(cli, graphs, tmp_path, ending):
    cells = tmp_path / "cells"
    found = swept(cli, graphs(), "--set", "light.stops=-1,0.5,2", "--cells", cells, "--ending", ending)
    assert values(found, "light.stops") == ["-1", "0.5", "2"]
    assert [cell["label"] for cell in found["cells"]] == ["stops -1", "stops 0.5", "stops 2"]
    for cell in found["cells"]:
        text = cell["values"]["light.stops"]
        assert cell["file"] == str(cells / f"light.stops={text}.{ending}")
        one = tmp_path / f"one.{ending}"
        assert cli("render", graphs(), "--set", f"light.stops={text}", "-o", one).code == 0
        assert (cells / f"light.stops={text}.{ending}").read_bytes() == one.read_bytes()


def test_a_sheet_shows_each_picture_where_it_should(cli, graphs, tmp_path):
    """Rows of one value, columns of the other: flat colors are found again in the middle of their cells."""
    path = graphs(
        nodes={"fill": {"type": "constant"}, "dim": {"type": "exposure"}},
        links={"dim.image": "fill.out", "outputs.image": "dim.out"},
        settings={"size": [48, 32]},
    )
    words = ("--set", "dim.stops=0,-1,-2", "--set", "fill.color=0.8,0,0,1;0,0.8,0,1", "--view", "none")
    found = swept(cli, path, *words)
    assert [cell["label"] for cell in found["cells"]] == [
        f"stops {stops}  color {color}" for stops in ("0", "-1", "-2") for color in ("0.8,0,0,1", "0,0.8,0,1")
    ]
    sheet = read(tmp_path / "sheet.png")
    for channel in (0, 1):
        other = sheet[..., 1 - channel]
        pure = (sheet[..., channel] > 0.2) & (other < 0.02)
        rows, columns = np.nonzero(pure)
        assert np.ptp(columns) < 48 and np.ptp(rows) > 2 * 32, "one color is one column"
        levels = {round(float(level), 2) for level in np.unique(sheet[..., channel][pure], return_counts=False)}
        srgb = [1.055 * (0.8 * 2.0**-stops) ** (1 / 2.4) - 0.055 for stops in range(3)]
        assert all(any(abs(level - one) < 0.01 for level in levels) for one in srgb)
        first = [rows[np.isclose(sheet[..., channel][pure], one, atol=0.004)].mean() for one in srgb]
        assert first == sorted(first), "rows are in the order of the values"


def test_one_value_makes_rows_that_wrap(cli, graphs, tmp_path):
    few, many = (swept(cli, graphs(), "--set", f"light.stops=0..1/{count}") for count in (3, 12))
    assert 3 * 48 < few["size"][0] < 5 * 48 and len(few["cells"]) == 3
    assert 0.6 < many["size"][0] / many["size"][1] < 3.0
    narrow = swept(cli, graphs(), "--set", "light.stops=0..1/12", "--columns", "2")
    assert 2 * 48 < narrow["size"][0] < 3 * 48


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("light.stops=0..3/4", ["0", "1", "2", "3"]),
        ("light.stops=1..100/3log", ["1", "10", "100"]),
        ("light.stops=-1..1/3,5", ["-1", "0", "1", "5"]),
        ("light.stops=1;2,3", None),
        ("light.stops=1,1,2", ["1", "2"]),
        ("light.stops=2..0/3", ["2", "1", "0"]),
        ("light.stops==frame;0", ["=frame", "0"]),
        ("light.stops=1@1,4@24;2", ["1@1,4@24", "2"]),
        ("noise.octaves=1..4/4", ["1", "2", "3", "4"]),
        ("mix.mode=plus,over", ["plus", "over"]),
        ("tone.clip=*", ["false", "true"]),
        ("fill.color=1,0,0,1;0,1,0,1", ["1,0,0,1", "0,1,0,1"]),
        ("glow=1,2", ["1", "2"]),
    ],
)
def test_lists_and_ranges(cli, graphs, text, expected):
    nodes = {
        "noise": {"type": "noise"},
        "mix": {"type": "merge"},
        "tone": {"type": "tone_map"},
        "fill": {"type": "constant"},
    }
    path = graphs(nodes=nodes, controls={"glow": {"target": "light.stops"}})
    sheet = path.parent / "sheet.png"
    result = cli("sweep", path, "-o", sheet, "--cell", "16", "--set", text, "--json")
    if expected is None:
        assert result.code == 2 and "'2,3'" in result.err.replace("[2, 3]", "'2,3'")
        return
    assert result.code == 0, result.err
    name = text.partition("=")[0]
    assert values(result.json, name) == expected


def test_repeated_flags_go_on_with_the_list_and_single_values_are_set(cli, graphs, tmp_path):
    path = graphs(nodes={"fill": {"type": "constant"}}, links={"light.image": "fill.out"}, settings={"size": [48, 32]})
    words = ("--set", "fill.color=0.5,0,0,1", "--set", "light.stops=0", "--set", "light.stops=1")
    found = swept(cli, path, *words, "--cells", tmp_path / "cells", "--ending", "exr")
    assert values(found, "light.stops") == ["0", "1"]
    assert [float(read(tmp_path / "cells" / f"light.stops={stops}.exr")[0, 0, 0]) for stops in (0, 1)] == [0.5, 1.0]


def test_all_choices(cli, graphs):
    from halation.nodes import catalogue

    links = {"mix.a": "light.out", "mix.b": "inputs.beauty", "outputs.image": "mix.out"}
    path = graphs(nodes={"mix": {"type": "merge"}}, links=links)
    found = swept(cli, path, "--set", "mix.mode=*")
    assert values(found, "mix.mode") == list(catalogue()["merge"].values["mode"].choices)


def test_frames(cli, graphs, tmp_path):
    path = graphs(settings={"frames": [1, 24]})
    found = swept(cli, path, "--set", "light.stops==frame/24;0", "--frames", "1-24x8", "--cells", tmp_path / "cells")
    assert [cell["frame"] for cell in found["cells"]] == [1, 9, 17] * 2
    assert (tmp_path / "cells" / "light.stops=0,frame=0009.png").exists()
    one = tmp_path / "one.png"
    assert cli("render", path, "--set", "light.stops==frame/24", "--frame", "17", "-o", one).code == 0
    assert (tmp_path / "cells" / "light.stops=_frame_24,frame=0017.png").read_bytes() == one.read_bytes()


def test_what_a_history_makes_of_values(cli, graphs, tmp_path):
    """Every cell has its own past."""
    path = graphs(
        nodes={"trail": {"type": "frame_blend", "values": {"amount": 0.5}}},
        settings={"frames": [1, 8]},
        links={"trail.image": "light.out", "outputs.image": "trail.out"},
        animation={},
    )
    words = ("--set", "light.stops==frame;=-frame", "--frame", "4", "--cells", tmp_path / "cells")
    found = swept(cli, path, *words)
    for cell in found["cells"]:
        one, text = tmp_path / "one.png", cell["values"]["light.stops"]
        assert cli("render", path, "--set", f"light.stops={text}", "--frame", "4", "-o", one).code == 0
        assert one.read_bytes() == Path(cell["file"]).read_bytes()


def test_data_is_shown_between_its_limits(cli, graphs):
    parts = {
        "inputs": {"depth": {"type": "Field", "file": "shot.exr", "layer": "Depth"}},
        "outputs": {"far": {"type": "Field"}},
        "links": {"outputs.far": "inputs.depth"},
    }
    found = swept(cli, graphs(**parts), "--set", "light.stops=0,1", "--show", "far")
    assert len(found["cells"]) == 2


def test_the_sheet_names_its_cells(cli, graphs, tmp_path):
    swept(cli, graphs(), "--set", "light.stops=0,1")
    assert header(tmp_path / "sheet.png")["ImageDescription"] == "stops 0\nstops 1"


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--set", "light.stops=1"), "nothing is swept: give several values"),
        ((), "nothing is swept"),
        (("--set", "light.stops==max(1,2)"), "nothing is swept"),
        (("--set", "light.stosp=1,2"), "node 'light' has no value 'stosp'; did you mean 'stops'?"),
        (("--set", "fill.color=1,0,0,1,0,1,0,1"), "a color is 4 numbers, and 8 are given; separate several of"),
        (("--set", "fill.color=1,2,3"), "a color is 4 numbers, and 3 are given"),
        (("--set", "light.stops=1,,2"), "a value is missing between two separators"),
        (("--set", "light.stops=*"), "* works only for choices and switches"),
        (("--set", "light.stops=1..a/3"), "a range is FIRST..LAST/COUNT"),
        (("--set", "light.stops=1..2/1"), "a range is FIRST..LAST/COUNT of 2 to"),
        (("--set", "light.stops=-1..2/3log"), "even ratios need numbers above 0"),
        (("--set", "light.stops"), "write --set NAME=VALUE,VALUE"),
        (("--set", "mix.mode=plus,ovr"), "'ovr' is not a choice"),
        (("--set", "light.stops=1,2", "--set", "mix.amount=0,1", "--frames", "1-2"), "no more: give all but two"),
        (("--set", "light.stops=0..1/400", "--set", "mix.amount=0,1"), "800 pictures are more than the 400"),
        (("--set", "light.stops=1,2", "--show", "imgae"), "did you mean 'image'?"),
        (("--set", "light.stops=1,2", "--view", "typo"), "no view 'typo'"),
    ],
)
def test_what_makes_no_sense(cli, graphs, tmp_path, words, sentence):
    path = graphs(nodes={"fill": {"type": "constant"}, "mix": {"type": "merge"}}, settings={"frames": [1, 2]})
    result = cli("sweep", path, "-o", tmp_path / "sheet.png", *words)
    assert result.code == 2 and sentence in result.err, result.err
    assert not (tmp_path / "sheet.png").exists() and result.err.count("halation: ") == 1


def test_sheets_are_for_eyes(cli, graphs, tmp_path):
    for name, code in (("sheet.exr", 2), ("sheet", 2), ("missing/sheet.png", 1)):
        result = cli("sweep", graphs(), "-o", tmp_path / name, "--set", "light.stops=0,1")
        assert result.code == code, (name, result.err)
