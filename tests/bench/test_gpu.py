"""The measurement of a card, as far as it can be tried without one."""

from __future__ import annotations

from dataclasses import replace

import moderngl
import numpy as np
import pytest
from bench import gpu
from bench.gpu_copies import FORMATS, queries_against_clock, time_copies
from bench.gpu_measuring import engine, frames, take
from bench.gpu_table import FLOORS, bandwidth, compute_rows, format_results, format_table
from bench.gpu_work import DRY, FITTING, UHD, WORK, least_bytes, make_picture, select_measured
from bench.results import Results
from halation import document
from halation.compiler import Request, Target, compile_graph
from halation.inputs.provider import MediaProvider
from halation.renderer import RenderRequest, open_device
from halation.resources.sandbox import UNRESTRICTED

HALF, FLOAT = 8, 16
"""Bytes of a pixel."""


@pytest.fixture(scope="module")
def device():
    made = open_device(sandbox=UNRESTRICTED)
    yield made
    made.close()


def card(**machine):
    """Results of a card that copies a gigabyte a millisecond."""
    found = Results(
        {
            "card": "A card",
            "driver": "1.0",
            "form": "compute",
            "why": "asked for",
            "software": False,
            "dry": False,
            "nvidia": "",
            **machine,
        }
    )
    found.extras["copies"] = {
        "compute rgba16f": {"nbytes": 5 * 10**8, "seconds": [1e-3], "bandwidth": 1e12, "same": True},
        "buffer": {"nbytes": 5 * 10**8, "seconds": [2e-3], "bandwidth": 5e11, "same": True},
    }
    return found


def measured(results, task, seconds, floor):
    one = results.run("3840x2160", task, "compute half")
    one.op, one.wall = [seconds], [2.0 * seconds]
    known = {"moved": 2 * floor, "floor": floor, "passes": 2}
    results.extras.setdefault("bytes", {})[task] = {"compute half": known}
    return results


def row(results, beginning):
    return next(one for one in compute_rows(results) if one.what.startswith(beginning))


def test_copies_copy(device):
    with device.save_draw_target() as context:
        found = time_copies(context, DRY, 2, by_query=False)
        assert queries_against_clock(context, DRY) >= 0.0
    ways = {f"{form} {texel}" for form in ("fragment", "compute") for texel in FORMATS}
    assert {one.way for one in found} == {*ways, "buffer"}
    assert all(one.same and len(one.seconds) == 2 and one.bandwidth > 0.0 for one in found)
    assert {one.nbytes for one in found} == {DRY[0] * DRY[1] * each for each in (HALF, FLOAT)}


def test_a_copy_that_does_not_arrive_is_seen(device, monkeypatch):
    monkeypatch.setattr(moderngl.VertexArray, "render", lambda *_, **__: None)
    with device.save_draw_target() as context:
        found = {one.way: one.same for one in time_copies(context, DRY, 1, by_query=False)}
    assert not found["fragment rgba16f"] and not found["fragment rgba32f"] and found["buffer"]


def planned(name, precision):
    """A work as a card would be given it, its pictures 3840x2160."""
    work, pictures = WORK[name], MediaProvider(sandbox=UNRESTRICTED)
    inputs = {one: np.zeros((8, 8, 4), np.float16) for one in work.inputs}
    request = Request(bindings=pictures.bind(document.load(work.path, sandbox=UNRESTRICTED), inputs), size=UHD)
    target = Target("a card", 460, software=False, precision="half")
    return compile_graph(
        document.load(work.path, sandbox=UNRESTRICTED), request, pictures, target=target, precision=precision
    )


@pytest.mark.parametrize("precision", ["half", "float"])
@pytest.mark.parametrize("name", WORK)
def test_the_floor_is_input_and_output_once(name, precision):
    pixels, each = UHD[0] * UHD[1], HALF if precision == "half" else FLOAT
    if WORK[name].inputs:
        assert least_bytes(planned(name, precision)) == pixels * (each + each)
    else:  # color; depth, normals and velocity are data, which keeps 32 bits
        assert least_bytes(planned(name, precision)) == pixels * (each + each + 4 + FLOAT + FLOAT)


@pytest.mark.parametrize(
    ("name", "limit"),
    [
        ("chain", 1.0),
        ("T1s3", FLOORS),
        ("T1s10", FLOORS),
        ("T1s50", FLOORS),
        ("bloom", FLOORS),
    ],
)
def test_plans_leave_room_for_what_is_wanted(name, limit):
    """No card can move fewer bytes than the plan says, but for those that its caches hold."""
    plan = planned(name, "half")
    moved = sum(
        plan.surfaces[number].nbytes
        for one in plan.passes
        if not FITTING.issuperset(one.functions)
        for number in (*one.textures, *one.targets)
    )
    assert moved <= limit * least_bytes(plan)


def test_the_chain_is_one_pass_that_moves_no_byte_too_many(device):
    results, renderer = Results(), engine(device, "compute")
    work = replace(WORK["chain"], size=DRY)
    wanted = RenderRequest({"a": make_picture(DRY)}, precision="half")
    take(results, work, "compute half", renderer, document.load(work.path, sandbox=UNRESTRICTED), wanted, 2)
    known = results.extras["bytes"]["chain"]["compute half"]
    assert known["passes"] == 1 and known["moved"] == known["floor"] == 2 * HALF * DRY[0] * DRY[1]
    assert len(results.runs[0].op) == len(results.runs[0].wall) == 2
    assert all(seconds > 0.0 for seconds in frames(renderer, document.load(work.path, sandbox=UNRESTRICTED), wanted, 1))
    renderer.close()


def test_bringing_the_sample_to_size_does_not_count(device):
    results, renderer, work = Results(), engine(device, "fragment"), replace(WORK["stack"], size=DRY)
    graph, wanted = document.load(work.path, sandbox=UNRESTRICTED), RenderRequest(size=DRY, precision="float")
    plan = renderer.compile(graph, wanted)
    take(results, work, "fragment float", renderer, graph, wanted, 1)
    known = results.extras["bytes"]["stack"]["fragment float"]
    fitting = [one for one in plan.passes if not select_measured((one,))]
    assert fitting and known["passes"] == len(plan.passes) - len(fitting)
    assert not any("fit" in name.split("_") for one in known["each"] for name in one["functions"])
    renderer.close()


def test_pictures_have_the_size_asked_for():
    assert make_picture(DRY).shape == (54, 96, 4) and make_picture((2000, 1100)).shape == (1100, 2000, 4)
    assert make_picture(DRY).dtype == np.float16


@pytest.mark.parametrize(("seconds", "verdict"), [(2.9e-4, "yes"), (3.1e-4, "no")])
def test_times_are_held_against_the_fastest_copy(seconds, verdict):
    found = measured(card(), "T1s3", seconds, 10**8)
    assert bandwidth(found) == 1e12
    figure = row(found, "Gaussian").figures[0]
    assert figure.number == pytest.approx(seconds / 1e-4) and row(found, "Gaussian").verdict == verdict
    assert "| 200% |" not in format_results(found) and f"| {2e8 / seconds / 1e9:.0f} |" in format_results(found)


@pytest.mark.parametrize(("seconds", "verdict"), [(1.4e-3, "yes"), (1.5e-3, "no")])
def test_seventy_percent_of_a_copy(seconds, verdict):
    assert row(measured(card(), "chain", seconds, 10**9), "ten fused").verdict == verdict


@pytest.mark.parametrize(
    ("half", "rounding", "verdict"),
    [
        (1.9e-2, 1e-2, "yes"),
        (2.1e-2, 1e-2, "no"),
        (9e-4, 0.0, "yes"),
        (1.1e-3, 0.0, "no"),
    ],
)
def test_presets_may_be_as_far_off_as_rounding(half, rounding, verdict):
    found = card()
    found.extras["presets"] = {"one": {"half": half, "float": 0.0, "rounding": rounding}}
    assert row(found, "presets").verdict == verdict


@pytest.mark.parametrize(
    ("machine", "said"),
    [
        ({"software": True, "dry": True}, "A card is a software rasterizer: these figures mean nothing"),
        ({"dry": True}, "A dry run, of pictures far too small: these figures mean nothing"),
    ],
)
def test_figures_that_mean_nothing_are_not_judged(machine, said):
    found = measured(card(**machine), "T1s3", 1.0, 10**8)
    assert said in format_results(found)
    assert (
        "| yes |" not in format_table(found)
        and "| no |" not in format_table(found)
        and "(!)" not in format_table(found)
    )


def test_a_dry_run_goes_through(tmp_path):
    file = tmp_path / "card.json"
    what = ["--work", "chain,bloom", "--presets", "agx_look,neon_edges", "--rounds", "1", "--repeat", "1"]
    results = gpu.measure(gpu.read_options(["--json", str(file), *what]), lambda text: None)
    assert Results.load(file) == results and results.machine["software"]
    assert {one.program for one in results.runs} == {
        f"{form} {precision}" for form in ("compute", "fragment") for precision in ("half", "float")
    }
    assert not any(one.error for one in results.runs)
    for one in results.extras["presets"].values():
        assert 0.0 <= one["float"] < 1e-3 and one["half"] < 2.0 * one["rounding"] + 1e-3
    assert "not measured" not in format_table(results).replace(
        "post_stack at 3840x2160, all passes | 4 ms | not measured", ""
    )
