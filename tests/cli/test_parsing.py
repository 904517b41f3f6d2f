"""What the user types after options, read as the manual says, and costs of several processes that are joined."""

from __future__ import annotations

import io
import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from halation import document
from halation.cli import helpers, options, parsing
from halation.cli.sweeping import parse_axes
from halation.document.limits import MAX_BYTES
from halation.errors import DocumentError, GraphError, UsageError
from halation.graph import Expression, Graph, Group, Input, Key, Keys, Port
from halation.nodes import Kind, catalogue
from halation.resources.sandbox import UNRESTRICTED


@pytest.mark.parametrize(
    ("words", "place"),
    [
        (["fmt", ""], "word 2 of the command"),
        (["", "x"], "word 1 of the command"),
        (["render", "-o", "", "x"], "what follows -o"),
        (["render", "--frames="], "--frames=: what follows ="),
    ],
)
def test_an_empty_word_is_named(words: list[str], place: str) -> None:
    with pytest.raises(UsageError, match=f"^{place} is empty"):
        parsing.check_words(words)


def test_some_texts_may_be_empty() -> None:
    words = ["test", "-k", "", "--view", "", "--look=", "--set", "a=", "x=", "-"]
    assert parsing.check_words(words) is None


def test_names_and_texts_are_read_in_order_and_once() -> None:
    assert list(parsing.parse_assignments(["b=1", "a=x=y"], "--set").items()) == [("b", "1"), ("a", "x=y")]
    assert parsing.parse_sets(None) == parsing.parse_inputs(None) == {}
    for text in ("a", "=1", "a="):
        with pytest.raises(UsageError, match=f"^--set {text}: write --set NAME=VALUE"):
            parsing.parse_sets([text])
    with pytest.raises(UsageError, match=r"^--set a=2: 'a' is given twice"):
        parsing.parse_sets(["a=1", "a=2"])
    assert parsing.parse_inputs(["a=1.exr", "b.exr"]) == {"a": "1.exr", "": "b.exr"}
    with pytest.raises(UsageError, match=r"^-i c\.exr: 'b.exr' is given already"):
        parsing.parse_inputs(["b.exr", "a=1.exr", "c.exr"])


def test_a_destination_is_a_file_or_a_name_and_a_file() -> None:
    texts = ["out.exr", "beauty=b.exr", "./a=b.exr", "a.b=c", "dir/x=y.png"]
    names = [("", "out.exr"), ("beauty", "b.exr"), ("", "a=b.exr"), ("", "a.b=c"), ("", "dir/x=y.png")]
    assert parsing.parse_destinations(texts) == tuple((name, Path(path)) for name, path in names)
    for text in ("=a.exr", "name="):
        with pytest.raises(UsageError, match=f"^-o {text}: write -o FILE"):
            parsing.parse_destinations([text])


@pytest.mark.parametrize(
    ("text", "value"),
    [("1", 1), ("-2.5e1", -25.0), ("true", True), ("1,2,.5", "1,2,.5"), ("1,2", [1, 2]), ("[1, 2]", [1, 2]),
     ("screen", "screen"), ('"1"', "1"), ("[" * 9000, "[" * 9000)],
)  # fmt: skip
def test_a_value_is_json_a_list_of_numbers_or_a_word(text: str, value: object) -> None:
    assert parsing.parse_value(text) == value and type(parsing.parse_value(text)) is type(value)


@pytest.mark.parametrize("text", ["NaN", "Infinity", "1,-Infinity"])
def test_numbers_are_finite(text: str) -> None:
    with pytest.raises(UsageError, match="is not a valid value; write a finite number"):
        parsing.parse_value(text)


@pytest.mark.parametrize(
    ("text", "count"),
    [(None, 0), ("1", 1), ("2K", 2 << 10), ("512M", 512 << 20), ("1.5g", 3 << 29), ("1T", 1 << 40),
     ("8388607T", 8388607 << 40)],
)  # fmt: skip
def test_memory(text: str | None, count: int) -> None:
    assert parsing.parse_memory(text) == count


@pytest.mark.parametrize("text", ["", "0", "0.9", "-1G", "1X", "G", "nan", "8388608T", "1 GB"])
def test_what_is_no_memory(text: str) -> None:
    with pytest.raises(UsageError, match="give a size as 512M or 2G"):
        parsing.parse_memory(text)


def test_numbers_of_processes_sizes_and_scales() -> None:
    assert [parsing.parse_jobs(text) for text in ("auto", "1", "12")] == [0, 1, 12]
    assert parsing.parse_size(None) is None and parsing.parse_size("960X540") == (960, 540)
    assert parsing.parse_size("999999x1") == (999999, 1)
    assert [parsing.parse_scale(scale) for scale in (1.0, 0.5, 1e-9)] == [1.0, 0.5, 1e-9]
    for read, texts in (
        (parsing.parse_jobs, ("0", "-1", "1.5", "", "٣")),
        (parsing.parse_size, ("960", "x540", "960x", "0x5", "5x0", "1x2x3", "1000000x1", "-1x2", "٣x3")),
        (parsing.parse_scale, (0.0, -1.0, 1.0001, math.nan)),
    ):
        for text in texts:
            with pytest.raises(UsageError, match=r"^(-j|--size|--scale) "):
                read(text)  # pyright: ignore[reportArgumentType]


def test_words_are_chosen_from() -> None:
    for read, words in (
        (parsing.parse_form, ("fragment", "compute")),
        (parsing.parse_form_or_device, ("fragment", "compute", "device")),
        (parsing.parse_precision, ("half", "float")), (parsing.parse_dither, ("blue", "none")),
        (parsing.parse_progress, ("bar", "json")),
    ):  # fmt: skip
        assert [read(word) for word in words] == [*words]
        with pytest.raises(UsageError, match=f"^--[a-z]+ odd: choose {' or '.join(words)}$"):
            read("odd")
    assert parsing.parse_form(None) is parsing.parse_precision(None) is None


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("= frame * 2 ", Expression("frame * 2")),
        ("1@1,4@24", Keys((Key(1.0, 1, "smooth"), Key(24.0, 4, "smooth")))),
        ("0,0@1:linear,1,.5@24", "0,0@1:linear,1,.5@24"),
        ("0,0@1:linear,1,0.5@24:constant", Keys((Key(1.0, (0.0, 0.0), "linear"), Key(24.0, (1.0, 0.5), "constant")))),
        ("true@1", Keys((Key(1.0, True, "smooth"),))),
        ("a@b.c", "a@b.c"), ("1@1,2", "1@1,2"), ("word@3", "word@3"), ("2.5", 2.5),
    ],
)  # fmt: skip
def test_keys_expressions_and_texts_with_an_at_sign(text: str, value: object) -> None:
    assert parsing.parse_setting(text) == value


def test_an_interpolation_that_is_none_is_named() -> None:
    with pytest.raises(UsageError, match=r"^--set 1@1:odd: odd: choose .*smooth"):
        parsing.parse_setting("1@1:odd")


def test_frames_are_given_in_one_way() -> None:
    assert parsing.parse_frame_options(None, None) is None
    assert parsing.parse_frame_options(0, None) == (0,) and parsing.parse_frame_options(None, "1-3") == (1, 2, 3)
    with pytest.raises(UsageError, match="--frame and --frames: give one of them"):
        parsing.parse_frame_options(0, "1-3")
    for name, expected in (("a.####.exr", True), ("a.mp4", True), ("a.exr", False)):
        assert parsing.have_frame_number([("", Path("b.exr")), ("", Path(name))]) is expected


# --- options ----------------------------------------------------------------------------------------------------------


GRAPH = Graph().add("e", catalogue()["exposure"]()).add("f", catalogue()["exposure"]()).add_input("plate", Input())
GRAPH = GRAPH.connect(Port("inputs", "plate"), Port("e", "image")).connect(Port("e", "out"), Port("f", "image"))


def test_files_fill_inputs_by_name_or_the_only_one(tmp_path: Path) -> None:
    two = GRAPH.add_input("matte", Input(Kind.IMAGE))
    assert (
        options.resolve_inputs(GRAPH, {"": "a.exr"})
        == {"plate": "a.exr"}
        == options.resolve_inputs(GRAPH, {"plate": "a.exr"})
    )
    assert options.resolve_inputs(two, {"matte": "m.exr"}) == {"matte": "m.exr"}
    assert options.resolve_inputs(two, {}) == {}
    (tmp_path / "12").touch()
    assert options.resolve_inputs(GRAPH, {"plate": str(tmp_path / "12")})
    for graph, files, sentence in (
        (two, {"": "a.exr"}, "-i a.exr: write -i NAME=FILE; the inputs of this graph are plate, matte"),
        (Graph(), {"": "a.exr"}, "-i a.exr: write -i NAME=FILE; the inputs of this graph are none"),
        (GRAPH, {"": "a.exr", "plate": "b.exr"}, "-i plate=a.exr: 'plate' is given twice"),
        (GRAPH, {"plat": "a.exr"}, "-i plat=a.exr: the graph has no input 'plat'; did you mean 'plate'?"),
        (Graph(), {"plate": "a.exr"}, "-i plate=a.exr: the graph has no input 'plate'; it has none"),
        (GRAPH, {"plate": "1.5"}, "-i plate=1.5: an input takes a file; set a number with --set NODE.VALUE=1.5"),
    ):  # fmt: skip
        with pytest.raises(UsageError) as fault:
            options.resolve_inputs(graph, files)
        assert str(fault.value) == sentence


def test_the_output_that_is_shown() -> None:
    shown: Any = SimpleNamespace(outputs={"beauty": None, "matte": None})
    nothing: Any = SimpleNamespace(outputs={})
    assert options.choose_output(shown, "", "") == "beauty" and options.choose_output(shown, "matte", "") == "matte"
    assert options.choose_output(nothing, "", "blur") == "blur"
    for graph, show, node, sentence in (
        (shown, "matte", "blur", "--show and --node: choose one"),
        (nothing, "", "", "the graph has no output to show: choose a node with --node"),
        (shown, "mate", "", "--show mate: there is no output 'mate'; did you mean 'matte'?"),
    ):
        with pytest.raises(UsageError) as fault:
            options.choose_output(graph, show, node)
        assert str(fault.value) == sentence


def test_a_value_that_cannot_be_set_is_named_with_how_to_write_it() -> None:
    assert options.override_value(GRAPH, "e.stops", "2").nodes["e"].stops == 2.0  # pyright: ignore[reportAttributeAccessIssue]
    with pytest.raises(UsageError, match=r"^--set stops=2: .*; write e.stops or f.stops$"):
        options.override_value(GRAPH, "stops", "2")
    with pytest.raises(UsageError, match=r"^--set e.stops=red: (?!e\.stops)"):
        options.override_value(GRAPH, "e.stops", "red")


@pytest.mark.parametrize(
    ("content", "said"),
    [(b"\xef\xbb\xbf{}", "{}"), (b"", ""), (b"ab\xff", "byte 2"), (b" " * (MAX_BYTES + 1), "MB")],
)
def test_standard_input_is_text_and_no_larger_than_a_graph(
    monkeypatch: pytest.MonkeyPatch, content: bytes, said: str
) -> None:
    monkeypatch.setattr(options.sys, "stdin", SimpleNamespace(buffer=io.BytesIO(content)))
    if said in ("{}", ""):
        assert options.read_standard_input() == said
        return
    with pytest.raises(DocumentError, match=said):
        options.read_standard_input()


def test_no_standard_input_is_an_empty_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(options.sys, "stdin", None)
    assert options.read_standard_input() == ""


def test_a_graph_is_a_path_or_a_preset(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder named like a preset hides it where folders are looked into, and only there."""
    monkeypatch.chdir(tmp_path)
    preset = options.locate_graph("soft_bloom")
    assert preset.is_file() and preset.stem == "soft_bloom" == options.expand_preset("soft_bloom").stem
    Path("soft_bloom").mkdir()
    assert options.locate_graph("soft_bloom") == preset and options.expand_preset("soft_bloom") == Path("soft_bloom")
    Path("soft_bloom").rmdir()
    Path("soft_bloom").symlink_to("nowhere")
    assert options.locate_graph("soft_bloom") == options.expand_preset("soft_bloom") == Path("soft_bloom")
    assert options.locate_graph("-") == Path("-")


def test_all_faults_are_counted_and_the_cause_comes_first(capsys: pytest.CaptureFixture[str]) -> None:
    """The link to a node that is not there comes before the output that it leaves empty; an unknown key is said too."""
    image = '{"type": "Image"}'
    nodes = '"nodes": {"e": {"type": "constant", "odd": 1}}, "links": {"outputs.b": "x.out", "outputs.c": "x.out"}'
    text = f'{{"halation": 1, "outputs": {{"a": {image}, "b": {image}, "c": {image}}}, {nodes}}}'
    lost = document.loads(text, "-", sandbox=UNRESTRICTED)
    for path, hint in ((Path("g.json"), ": halation check g.json"), (Path("-"), "")):
        with pytest.raises(GraphError) as fault:
            options.report_problems(path, lost)
        sentence = "'x.out' cannot feed 'outputs.b': there is no node 'x'; there is e"
        assert str(fault.value) == f"{path}: {sentence} (and 2 more{hint})"
        assert capsys.readouterr().err == f"{path}: nodes.e.odd means nothing to this version and is only kept\n"
    text = text.replace('"x.out"', '"e.out"').replace('"links": {', '"links": {"outputs.a": "e.out", ')
    sound = document.loads(text, "-", sandbox=UNRESTRICTED)
    options.report_problems(Path("g.json"), sound)
    assert capsys.readouterr().err == "g.json: nodes.e.odd means nothing to this version and is only kept\n"


# --- sweeps -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("setting", "texts"),
    [
        ("e.stops=1,2,2", ["1", "2"]), ("e.stops=0..1/5", ["0", "0.25", "0.5", "0.75", "1"]),
        ("e.stops=1..8/4log", ["1", "2", "4", "8"]), ("e.stops=1..0/2,5", ["1", "0", "5"]),
        ("e.stops=1; 2", ["1", "2"]),
        ("c.color=1,0,0,1;0,0,1,1", ["1,0,0,1", "0,0,1,1"]), ("p.segments=3..6/3", ["3", "4", "6"]),
    ],
)  # fmt: skip
def test_values_of_a_sweep(setting: str, texts: list[str]) -> None:
    graph = GRAPH.add("c", catalogue()["constant"]()).add("p", catalogue()["kaleidoscope"]())
    _, (axis,) = parse_axes(graph, [setting], ())
    assert [step.text for step in axis.steps] == texts and axis.name == setting.partition("=")[0]


@pytest.mark.parametrize(
    ("setting", "sentence"),
    [
        ("e.stops=*", r"\* works only for choices and switches"), ("e.stops=1,,2", "a value is missing between"),
        ("e.stops=1..2/1", "of 2 to 400 values"), ("e.stops=1..2/401", "of 2 to 400 values"),
        ("e.stops=0..2/3log", "even ratios need numbers above 0"), ("e.stops=a..b/3", "a range is FIRST..LAST/COUNT"),
        ("c.color=1,0,0,1,0,0,1,1", "a color is 4 numbers, and 8 are given"), ("e.stops", "write --set NAME=VALUE"),
    ],
)  # fmt: skip
def test_what_is_no_sweep(setting: str, sentence: str) -> None:
    graph = GRAPH.add("c", catalogue()["constant"]())
    with pytest.raises(UsageError, match=sentence):
        parse_axes(graph, [setting], ())


def test_single_values_are_set_and_frames_come_last() -> None:
    inner = Group(Graph().add("deep", catalogue()["exposure"]()))
    graph, axes = parse_axes(GRAPH.add("g", inner), ["e.stops=3", "g.deep.stops=1,2", "f.stops=1", "f.stops=4"], (7, 9))
    assert graph.nodes["e"].stops == 3.0  # pyright: ignore[reportAttributeAccessIssue]
    assert [axis.name for axis in axes] == ["g.deep.stops", "f.stops", "frame"]
    assert [step.text for step in axes[2].steps] == ["7", "9"] and [step.frame for step in axes[2].steps] == [7, 9]
    assert parse_axes(GRAPH, ["e.stops=3"], (7,))[1] == ()


# --- reports of several processes -------------------------------------------------------------------------------------


def make_report(number: int, **more: Any) -> dict[str, Any]:
    facts = {"passes": number, "programs": 10 * number, "peak_bytes": 100 * number, "repaired": {}, "warnings": {}}
    return {**facts, "views": {f"v{number}": ""}, "seconds": {"draw": 1.0 / number, "read": float(number)}, **more}


def test_reports_of_processes_are_one_with_frames_in_order() -> None:
    first = make_report(1, written=["3a", "3b", "1a", "1b"], frames=[3, 1], kept=[3])
    second = make_report(2, written=["2a", "2b"], frames=[2], kept=[2])
    joined = helpers.join_reports([first, second])
    assert (joined["frames"], joined["kept"]) == ([1, 2, 3], [2, 3])
    assert joined["written"] == ["1a", "1b", "2a", "2b", "3a", "3b"]
    assert (joined["passes"], joined["programs"], joined["peak_bytes"]) == (3, 30, 300)
    assert joined["views"] == {"v1": "", "v2": ""} and joined["seconds"] == {"draw": 1.0, "read": 2.0}
    assert helpers.join_reports([first]) == first
    chunks = helpers.join_chunk_costs([make_report(3, data=["b", "a"]), make_report(2, data=["a", "c"])])
    assert (chunks["peak_bytes"], chunks["data"], chunks["passes"]) == (300, ["b", "a", "c"], 5)


def test_processes_share_the_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(helpers, "available_cores", lambda: 8)
    for count, threads in ((2, "4"), (3, "2"), (20, "1")):
        shared = helpers._divide_cores(count)  # pyright: ignore[reportPrivateUsage]
        assert shared == {"LP_NUM_THREADS": threads, "OPENIMAGEIO_THREADS": threads}
    assert helpers._divide_cores(1) == {}  # pyright: ignore[reportPrivateUsage]
