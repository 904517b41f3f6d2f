"""What follows from the trial of a program, and what the process is told that tries it, decided without a device.

The references are arithmetic of pixels, and the declarations in the text of the program.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from concurrent.futures import Future
from typing import Any

import numpy as np
import pytest
from halation.compiler import NULL, Pass, Plan
from halation.custom_nodes import Code, node_type
from halation.errors import DeviceError
from halation.graph import Graph, Input, Output, Port
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.renderer import Renderer, RenderRequest
from halation.renderer.execution import trials
from halation.renderer.execution.trials import Trial, TrialProcess, Trials
from halation.resources.sandbox import UNRESTRICTED
from msgspec.structs import replace
from null_device import NullDevice

CODE = "vec4 f(vec4 image) {\n    return image * 0.3125;\n}"
CORES = 3


@pytest.fixture(autouse=True)
def machine(monkeypatch: pytest.MonkeyPatch) -> None:
    """A machine of three cores."""
    monkeypatch.setattr(trials, "available_cores", lambda: CORES)


class Answering(TrialProcess):
    """Tries nothing: it answers that each program takes so many seconds on few pixels."""

    def __init__(self, seconds: float, timeout: float) -> None:
        super().__init__(timeout)
        self.seconds, self.told = seconds, list[Mapping[str, Any]]()

    def submit(self, program: Mapping[str, Any], nodes: str, *, may_yield: bool) -> Future[Trial]:
        self.told.append(program)
        future = Future[Trial]()
        future.set_result(Trial(seconds=self.seconds))
        return future


def compile_user_pass(
    form: str, size: tuple[int, int], is_blurred: bool = False, code: str = CODE
) -> tuple[Plan, Pass]:
    """The plan of code after a picture, or after a blur of it, and the pass that has the code."""
    graph, last = Graph().add_input("image", Input()).add_output("out", Output()), Port("inputs", "image")
    if is_blurred:
        graph = graph.add("blur", GaussianBlur(sigma=3.0)).connect(last, Port("blur", "image"))
        last = Port("blur", "out")
    graph = graph.add("user", node_type(Code("glsl", code))()).connect(last, Port("user", "image"))
    graph = graph.connect(Port("user", "out"), Port("outputs", "out"))
    device = NullDevice(replace(NULL, form=form))
    engine = Renderer(device, budget=0, sandbox=UNRESTRICTED)
    picture = np.zeros((size[1], size[0], 4), np.float32)
    plan = engine.compile(graph, RenderRequest({"image": picture}, precision="float"))
    engine.close()
    (user_pass,) = (each for each in plan.passes if each.writers)
    return plan, user_pass


@pytest.mark.parametrize(
    ("size", "shrunk"), [((256, 64), (16, 16)), ((200, 64), (24, 16)), ((33, 48), (24, 24)), ((1, 1), (16, 16))]
)
@pytest.mark.parametrize("form", ["compute", "fragment"])
@pytest.mark.parametrize("software", [True, False])
def test_a_picture_takes_as_many_trials_as_it_has_pixels_of_one(
    form: str, size: tuple[int, int], shrunk: tuple[int, int], software: bool
) -> None:
    """A core does one group of 64 pixels of a row, or one picture of a trial, at a time, a GPU 16,384 pixels.

    Refused is what takes more than four times the limit.
    """
    plan, user_pass = compile_user_pass(form, size)
    pixels = size[0] * size[1]
    if form == "compute":
        groups = math.ceil(size[0] / 64) * size[1]  # the last one of a row is not full
        rounds = groups / CORES if software else groups * 64 / 16384
    else:
        rounds = pixels / (shrunk[0] * shrunk[1]) / CORES if software else pixels / 16384
    timeout = 100.0 * rounds / 4.0  # with 100 seconds each the picture takes just four times as long
    for seconds, is_slow in ((99.999, False), (100.001, True)):
        tried = Trials(Answering(seconds, timeout))
        assert tried.find_slowness(plan, user_pass, software) is None, "nothing was tried yet"
        tried.begin(plan, user_pass)
        fault = tried.find_slowness(plan, user_pass, software)
        assert (fault is not None) is is_slow
        if fault is not None:
            minutes = f"{rounds * seconds / 60.0:.0f} minutes on {size[0]}x{size[1]} pixels"
            assert f"node 'user': its code would run for about {minutes}" in str(fault) and fault.node == "user"
    endless = Trials(Answering(1e9, 0.0))
    endless.begin(plan, user_pass)
    assert endless.find_slowness(plan, user_pass, software) is None, "no limit was wanted"


@pytest.mark.parametrize("is_blurred", [True, False])
@pytest.mark.parametrize("size", [(256, 64), (200, 64), (31, 33)])
@pytest.mark.parametrize("form", ["compute", "fragment"])
def test_the_process_is_told_what_the_program_declares(form: str, size: tuple[int, int], is_blurred: bool) -> None:
    plan, user_pass = compile_user_pass(form, size, is_blurred)
    process = Answering(0.0, 1.0)
    Trials(process).begin(plan, user_pass)
    (told,) = process.told
    source = told["source"]
    assert told["form"] == form and ("local_size_x" in source) == (form == "compute") and "0.3125" in source
    assert ("Weights" in source) == (told["weights"] > 0)
    outputs = re.findall(r"writeonly|\bout vec4\b", source)
    images = re.findall(r"readonly|\buniform \w*sampler2D\b", source)
    assert len(told["targets"]) == len(outputs) == 1 and len(told["textures"]) == len(images) == 1
    for width, height, components, depth, is_linear in (*told["textures"], *told["targets"]):
        assert components == 4 and depth == "f4" and not is_linear
        for short, long in ((width, size[0]), (height, size[1])):
            assert 16 <= short <= 32 and (short.bit_count() == 1) == (long.bit_count() == 1)
    assert {name for name, _ in told["uniforms"]} <= {*re.findall(r"\buniform \w+ (\w+)", source)}


def test_programs_are_tried_once_and_the_oldest_is_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(trials, "MAX_TRIALS", 2)
    passes = [compile_user_pass("fragment", (8, 8)), compile_user_pass("compute", (8, 8)),
              compile_user_pass("compute", (8, 8), code=CODE.replace("0.3125", "0.625"))]  # fmt: skip
    shaders = [user_pass.shader for _, user_pass in passes]
    assert len({*shaders}) == 3
    process = Answering(0.0, 1.0)
    tried, forms = Trials(process), list[int]()
    for number in (0, 1, 0, 2, 1, 2, 0):
        before = len(process.told)
        tried.begin(*passes[number])
        forms.append(len(process.told) - before)
    assert forms == [1, 1, 0, 1, 0, 0, 1], "room for two: the third one drives out the first"


def test_what_has_made_way_or_failed_is_not_slow() -> None:
    plan, user_pass = compile_user_pass("fragment", (8, 8))
    process = Answering(1e9, 1.0)
    tried = Trials(process)
    future = Future[Trial]()
    process.submit = lambda *_, **__: future
    assert tried.begin(plan, user_pass) is future
    assert tried.find_slowness(plan, user_pass, software=True) is None, "it is still tried"
    future.cancel()
    assert tried.find_slowness(plan, user_pass, software=True) is None
    del process.submit
    tried.begin(plan, user_pass)
    assert isinstance(tried.find_slowness(plan, user_pass, software=True), DeviceError)
