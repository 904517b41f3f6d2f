"""`halation test`: what passes, what fails and how that is told, what is blessed, and where the pictures are."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from xml.etree import ElementTree as ET

import numpy as np
import OpenImageIO as oiio
import pytest
from clocks import FakeClock
from halation.media.pictures.stored import StoredPart
from halation.regression import case_runner
from halation.regression import parallel as crew
from halation.regression.cases import Case
from halation.regression.comparison import find_unusable
from halation.regression.results import Outcome
from halation.renderer import Renderer
from halation.renderer.pinned_device import pin_driver
from halation.resources.sandbox import UNRESTRICTED
from msgspec.structs import replace

ALL = """
[defaults]
golden = "goldens/{case}.exr"

[cases.look]
graph = "graph.json"
"""


def pixels(path: Path, part: int = 0) -> np.ndarray:
    return np.asarray(oiio.ImageBuf(str(path), part, 0).get_pixels(oiio.FLOAT))


def test_goldens_are_made_pass_and_stay(cli, suite, tmp_path) -> None:
    suite(ALL)
    first = cli()
    assert first.code == 1 and "goldens/look.exr is missing" in first.out
    made = cli("--update")
    assert made.code == 0 and "goldens/look.exr: new" in made.out
    before = (tmp_path / "goldens/look.exr").read_bytes()
    for words in ((), ("--update",)):
        again = cli(*words)
        assert again.code == 0 and "pass  looks.suite.toml::look  max_rel 0 " in again.out
        assert "1 passed" in again.err and "deterministic" in again.err
    assert (tmp_path / "goldens/look.exr").read_bytes() == before
    assert [path.name for path in (tmp_path / "goldens").iterdir()] == ["look.exr"]


def test_a_golden_is_what_render_writes(cli, suite, tmp_path) -> None:
    suite(ALL)
    cli("--update")
    from halation.cli.program import run

    assert run(["render", "graph.json", "-o", "other.exr", "--deterministic"]) == 0
    for part in (0, 1):
        assert (pixels(tmp_path / "goldens/look.exr", part) == pixels(tmp_path / "other.exr", part)).all()


def test_one_percent_fails_and_shows(cli, suite, graph, tmp_path) -> None:
    suite(ALL)
    cli("--update")
    graph(stops=1.0 + np.log2(1.01))
    failed = cli("--out", "out", "--report", "report.html", "--junit", "junit.xml")
    assert failed.code == 1
    assert "max_rel 0.0" in failed.out and "where at most 0.004 is allowed; worst at " in failed.out
    folder = tmp_path / "out/looks/look"
    assert sorted(path.name for path in folder.iterdir()) == [
        "look.actual.exr",
        "look.actual.view.png",
        "look.difference.exr",
        "look.difference.view.png",
        "look.expected.exr",
        "look.expected.view.png",
    ]
    expected, actual = pixels(folder / "look.expected.exr"), pixels(folder / "look.actual.exr")
    assert actual == pytest.approx(np.where(np.arange(4) < 3, expected * 1.01, expected), rel=2e-3)
    difference = pixels(folder / "look.difference.exr")
    assert difference[..., :3] == pytest.approx(np.abs(actual - expected)[..., :3], abs=1e-6)
    page = (tmp_path / "report.html").read_text()
    assert page.count("data:image/png;base64,") == 3 and "1.01" not in page.split("data:")[0]
    found = ET.parse(tmp_path / "junit.xml").getroot()
    case = found.find("testsuite/testcase")
    assert case is not None and case.find("failure") is not None
    assert str(folder / "look.actual.exr") in (case.findtext("system-out") or "")


def test_blessing_says_what_changes(cli, suite, graph, tmp_path) -> None:
    suite(ALL + '[cases.same]\ngraph = "graph.json"\nset = {"light.stops" = 0.0}\n')
    cli("--update")
    kept = (tmp_path / "goldens/same.exr").stat().st_mtime_ns
    graph(stops=2.0)
    blessed = cli("--update")
    assert blessed.code == 0 and "1 passed, 1 blessed" in blessed.err
    assert "goldens/look.exr 'image': max_rel 1 where at most 0.004" in blessed.out
    assert cli().code == 0
    assert (tmp_path / "goldens/same.exr").stat().st_mtime_ns == kept


@pytest.mark.parametrize(
    ("metric", "by", "passes"),
    [
        ("max_rel", 1.001, True),
        ("max_rel", 1.01, False),
        ("max_abs", 1.00001, True),
        ("max_abs", 1.01, False),
        ("rms", 1.0001, True),
        ("rms", 1.05, False),
        ("psnr", 1.001, True),
        ("psnr", 2.0, False),
        ("ssim", 1.01, True),
        ("ssim", 4.0, False),
        ("flip", 1.001, True),
        ("flip", 1.2, False),
    ],
)
def test_every_metric(cli, suite, graph, metric: str, by: float, passes: bool) -> None:
    suite(f'[cases.a]\ngraph = "graph.json"\ngolden = {{image = "a.exr"}}\nmetric = "{metric}"\nprecision = "float"\n')
    cli("--update")
    graph(stops=1.0 + np.log2(by))
    result = cli("--json")
    assert result.code == (0 if passes else 1), result.json
    case = result.json["cases"][0]
    assert case["metric"] == metric and case["checks"][0][metric] == case["checks"][0]["value"]


def test_some_pixels_may_fail(cli, suite, tmp_path) -> None:
    text = '[cases.a]\ngraph = "graph.json"\ngolden = {image = "a.exr"}\n'
    suite(text)
    cli("--update")
    buffer = oiio.ImageBuf(str(tmp_path / "a.exr"))
    buffer.setpixel(9, 9, (9.0, 9.0, 9.0, 1.0))
    assert buffer.write(str(tmp_path / "a.exr"))
    failed = cli("--json")
    check = failed.json["cases"][0]["checks"][0]
    assert failed.code == 1 and check["worst"] == [9, 9] and check["failing"] == pytest.approx(1 / (48 * 32))
    assert "another" not in check["message"] and check["expected"][0] == 9.0
    suite(f"{text}failing = 0.1\n")
    assert cli().code == 0
    suite(f"{text}failing = 0.05\n")
    assert "0.0651 % of the pixels are beyond 0.004 where 0.05 % may be" in cli().out


def test_png_goldens_and_their_views(cli, suite, graph) -> None:
    suite('[cases.a]\ngraph = "graph.json"\ngolden = {image = "a.png"}\nview = "none"\nmetric = "max_abs"\n')
    cli("--update")
    assert cli().code == 0
    graph(stops=1.2)
    assert "max_abs 0." in cli().out


def test_frames_nodes_sizes_and_inputs(cli, suite, tmp_path) -> None:
    (tmp_path / "other").mkdir()
    shutil.copy(tmp_path / "shot.exr", tmp_path / "other/größe 1.exr")
    suite("""
[cases.frames]
graph = "graph.json"
set = {"light.stops" = "= frame * 0.5"}
frames = "2-6x2"
golden = {image = "goldens/f.##.exr"}
[cases.node]
graph = "graph.json"
node = "light"
size = "24x16"
golden = "goldens/node.exr"
[cases.input]
graph = "graph.json"
inputs = {beauty = "other/größe 1.exr:Combined"}
scale = 0.5
golden = {image = "goldens/input.png"}
""")
    assert cli("--update").code == 0 and cli().code == 0
    frames = [pixels(tmp_path / f"goldens/f.{frame:02d}.exr")[20, 20, 1] for frame in (2, 4, 6)]
    assert frames == pytest.approx([0.25 * 2.0**frame for frame in (1, 2, 3)], rel=1e-3)
    assert pixels(tmp_path / "goldens/node.exr").shape == (16, 24, 4)
    assert pixels(tmp_path / "goldens/input.png").shape[:2] == (16, 24)


def test_wildcards_make_a_case_of_every_graph(cli, suite, graph) -> None:
    graph("one.json", 0.0)
    graph("two.json", 2.0)
    suite('[cases.all]\ngraph = "*.json"\ngolden = {image = "goldens/{graph}.exr"}\n')
    listed = cli("--list")
    assert listed.out.splitlines() == [f"looks.suite.toml::all/{name}" for name in ("graph", "one", "two")]
    assert cli("--update", "-k", "one or two").code == 0
    result = cli("--json")
    assert [case["status"] for case in result.json["cases"]] == ["failed", "passed", "passed"]


def test_cases_that_must_fail_or_only_render(cli, suite) -> None:
    suite("""
[defaults]
graph = "graph.json"
[cases.right]
error = "no node 'bloom'"
set = {"bloom.x" = 1}
[cases.otherwise]
error = "something else"
set = {"bloom.x" = 1}
[cases.works]
error = "anything"
[cases.renders]
[cases.black]
node = "light"
set = {"light.stops" = -200}
[cases.dark]
set = {"light.stops" = -200}
allow = ["black"]
node = "light"
[cases.skipped]
skip = "not yet"
[cases.missing]
graph = "gone.json"
""")
    result = cli("--json")
    found = {case["name"]: (case["status"], case["message"]) for case in result.json["cases"]}
    assert result.code == 1
    assert [name for name, (status, _) in found.items() if status == "failed"] == [
        "otherwise",
        "works",
        "black",
        "missing",
    ]
    assert "not with 'something else'" in found["otherwise"][1] and "but it renders" in found["works"][1]
    assert "all black" in found["black"][1] and found["skipped"] == ("skipped", "not yet")
    assert "gone.json: there is no such file" in found["missing"][1]


def test_broken_pictures_are_not_blessed(cli, suite, tmp_path) -> None:
    text = '[cases.a]\ngraph = "graph.json"\nset = {"light.stops" = -200}\ngolden = {image = "a.exr"}\n'
    suite(text)
    refused = cli("--update")
    assert refused.code == 1 and "a.exr is not blessed: the picture is all black" in refused.out
    assert not (tmp_path / "a.exr").exists()
    suite(f'{text}allow = ["black"]\n')
    assert cli("--update").code == 0 and cli().code == 0


@pytest.mark.parametrize(
    ("value", "letters", "count"),
    [
        (np.nan, ("R", "G", "B", "A"), 2),
        (np.inf, ("a.R", "a.G", "a.B", "a.A"), 2),
        (np.nan, ("Z",), 2),
        (np.inf, ("Z",), 0),
    ],
)
def test_what_is_not_finite_is_counted(value: float, letters: tuple[str, ...], count: int) -> None:
    """Infinity is what depth is where nothing is."""
    array = np.ones((3, 3, len(letters)), np.float32)
    array[1, 1, 0] = array[2, 0, -1] = value
    parts = {"": StoredPart(array, letters, is_encoded=False)}
    case = Case(Path("a.suite.toml"), "a", Path("graph.json"))
    assert parts[""].count_unusable == count
    said = f'{count} pixels are not finite; allow = ["nonfinite"] if they may be'
    assert find_unusable(case, parts) == (said if count else "")
    assert find_unusable(replace(case, allow=("nonfinite",)), parts) == ""


def test_a_golden_that_the_graph_reads_is_left_alone(cli, suite, tmp_path) -> None:
    suite('[cases.a]\ngraph = "graph.json"\ngolden = {image = "shot.exr"}\n')
    before = (tmp_path / "shot.exr").read_bytes()
    result = cli("--update")
    assert result.code == 1 and "the graph reads this file" in result.out
    assert (tmp_path / "shot.exr").read_bytes() == before


def test_damaged_and_foreign_goldens(cli, suite, tmp_path) -> None:
    suite(ALL)
    cli("--update")
    golden = tmp_path / "goldens/look.exr"
    whole = golden.read_bytes()
    for damage in (b"", whole[:300], b"no picture"):
        golden.write_bytes(damage)
        result = cli()
        assert result.code == 1 and "goldens/look.exr" in result.out and "Traceback" not in result.err
    buffer = oiio.ImageBuf(np.zeros((8, 9, 4), np.float32))
    buffer.write(str(golden))
    assert "the layers are image, depth, and " in cli().out
    golden.write_bytes(whole.replace(b"llvmpipe (", b"raytracer("))
    graph = tmp_path / "graph.json"
    graph.write_text(graph.read_text().replace("1.0", "3.0"))
    said = cli("--report", "report.html").out
    assert "the golden was made by raytracer(" in said and "this is llvmpipe (" in said
    assert "raytracer(" in (tmp_path / "report.html").read_text()
    assert cli("--update").code == 0 and golden.stat().st_size > 1000


def test_processes_give_the_same_bytes(cli, suite, tmp_path) -> None:
    """Two processes, and one with another number of threads and other wishes of the environment."""
    suite(ALL.replace("[cases.look]", "[cases.one]") + '[cases.two]\ngraph = "graph.json"\n')
    assert cli("--update", "-j", "2").code == 0
    shared = [(tmp_path / f"goldens/{name}.exr").read_bytes() for name in ("one", "two")]
    shutil.rmtree(tmp_path / "goldens")
    environment = {**os.environ, "LP_NUM_THREADS": "3", "LP_NATIVE_VECTOR_WIDTH": "256", "LC_ALL": "de_DE.UTF-8"}
    command = [sys.executable, "-m", "halation.cli", "test", "--update", "--json"]
    result = subprocess.run(command, env=environment, cwd=tmp_path, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    alone = [(tmp_path / f"goldens/{name}.exr").read_bytes() for name in ("one", "two")]
    assert pixels(tmp_path / "goldens/one.exr").any() and shared == alone
    for part in (0, 1):
        assert not oiio.ImageBuf(str(tmp_path / "goldens/one.exr"), part, 0).spec().get_string_attribute("DateTime")


def test_stopping_at_the_first_failure(cli, suite) -> None:
    suite('[defaults]\ngraph = "graph.json"\n[cases.a]\n[cases.b]\nerror = "x"\n[cases.c]\n')
    result = cli("-x", "--json")
    assert [case["name"] for case in result.json["cases"]] == ["a", "b"] and result.code == 1


def test_a_gpu_alone_is_told_of(cli, suite, monkeypatch, tmp_path) -> None:
    """Where no software rasterizer is, the tests go on with what there is."""
    real = crew._open_renderer(True, UNRESTRICTED).device
    device = real.with_target(replace(real.target, renderer="GPU 9000", software=False))
    monkeypatch.setattr(crew, "_open_renderer", lambda *_: Renderer(device, budget=0, sandbox=UNRESTRICTED))
    suite(ALL)
    cli("--update")
    result = cli("--report", "report.html", "--json")
    assert result.code == 0 and result.json["deterministic"] is False
    assert "no software rasterizer was found: GPU 9000" in result.json["remark"]
    assert "no software rasterizer was found: GPU 9000" in (tmp_path / "report.html").read_text()
    assert "no software rasterizer was found: GPU 9000" in cli().err


def test_pinning_leaves_the_environment_as_it_was(monkeypatch) -> None:
    monkeypatch.setenv("GALLIUM_DRIVER", "softpipe")
    monkeypatch.setenv("LP_DEBUG", "tgsi")
    monkeypatch.delenv("LIBGL_ALWAYS_SOFTWARE", raising=False)
    before = dict(os.environ)
    with pytest.raises(ZeroDivisionError), pin_driver().apply():
        assert os.environ["GALLIUM_DRIVER"] == "llvmpipe" and "LP_DEBUG" not in os.environ
        raise ZeroDivisionError
    assert dict(os.environ) == before


def test_times_are_those_of_a_clock(monkeypatch, tmp_path) -> None:
    """A case takes as long as its renders, skipped ones nothing, and the suite as long as all of it."""
    clock = FakeClock(monkeypatch, case_runner, crew)
    case = Case(tmp_path / "s.toml", "a", tmp_path / "g.json")
    renders = {"a": (7.5, "passed"), "b": (0.25, "failed")}

    def render(case, renderer, options):
        seconds, status = renders[case.name]
        clock.spend(seconds)
        return Outcome(case, status)

    monkeypatch.setattr(case_runner, "_run_rendering", render)
    monkeypatch.setattr(crew, "_open_renderer", lambda *_: clock.spend(100.0))
    monkeypatch.setattr(crew, "_run_and_describe", lambda case, *rest: described(case_runner.run_case(case, *rest)))
    cases = [case, replace(case, name="b"), replace(case, name="c", skip="later")]
    found = crew.run_cases(cases, case_runner.RunOptions(UNRESTRICTED))
    assert [outcome.seconds for outcome in found.outcomes] == [7.5, 0.25, 0.0]
    assert found.seconds == 107.75


def described(outcome: Outcome) -> SimpleNamespace:
    return SimpleNamespace(outcome=outcome, device="a device", software=True)
