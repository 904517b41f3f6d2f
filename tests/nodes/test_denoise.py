"""Denoising against the library called directly, and as a pass that runs on the processor."""

from __future__ import annotations

import threading
import time
from typing import Any

import numpy as np
import pytest
from halation.errors import RenderError
from halation.graph import Graph, Input, Output, Port
from halation.media import denoising
from halation.nodes import HostProgram, Kind
from halation.nodes.color.exposure import Exposure
from halation.nodes.filter.denoise import Denoise
from halation.renderer import Renderer, RenderRequest
from halation.renderer.execution import host_jobs
from halation.renderer.execution.host_jobs import HostJobs

oidn: Any = pytest.importorskip("pyoidn", reason="pyoidn is not installed: pip install halation[denoise]")

Array = np.ndarray
SIZE = (80, 60)


def noisy_render(seed: int = 1) -> dict[str, Array]:
    """A floor of tiles below a wall in soft light, with the noise of few samples, and what it is without noise."""
    width, height = SIZE
    random = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(width), np.arange(height))
    tiles = ((x // 10 + y // 10) % 2)[..., None] * np.array([0.5, 0.3, 0.1]) + 0.2
    wall = (y < 25)[..., None]
    albedo = np.where(wall, 0.6, tiles)
    light = (0.4 + 2.0 * np.exp(-((x - 50) ** 2 + (y - 40) ** 2) / 400.0))[..., None]
    clean = albedo * light
    noisy = clean * random.gamma(2.0, 0.5, clean.shape)
    normal = np.where(wall, [0.0, -1.0, 0.0], [0.0, 0.0, 1.0])
    opaque = np.ones((height, width, 1))
    pictures = {"image": np.dstack([noisy, opaque]), "albedo": np.dstack([albedo, opaque]), "normal": normal}
    return {name: pixels.astype(np.float32) for name, pixels in (pictures | {"clean": clean}).items()}


def rms(pixels: Array, clean: Array) -> float:
    return float(np.sqrt(((pixels[..., :3] - clean) ** 2).mean()))


def direct(guides: tuple[str, ...], pictures: dict[str, Array], **values: Any) -> Array:
    images = {name: np.ascontiguousarray(pictures[name][..., :3]) for name in guides}
    return oidn.denoise(np.ascontiguousarray(pictures["image"][..., :3]), **images, **values)


@pytest.mark.parametrize("guides", [(), ("albedo",), ("albedo", "normal")], ids="-".join)
def test_it_is_the_library(run, guides):
    pictures = noisy_render()
    given = {name: pictures[name] for name in ("image", *guides)}
    found = run(Denoise(guides="clean"), given)
    expected = direct(guides, pictures, hdr=True, clean_aux=bool(guides))
    np.testing.assert_allclose(found[..., :3], expected, atol=1e-5)
    assert (found[..., 3] == 1.0).all()


def test_guides_keep_textures_and_noise_goes(run):
    pictures = noisy_render()
    clean, image = pictures["clean"], {"image": pictures["image"]}
    guided = run(Denoise(), image | {name: pictures[name] for name in ("albedo", "normal")})
    assert rms(guided, clean) < 0.2 * rms(pictures["image"], clean)
    assert rms(guided, clean) < rms(run(Denoise(), image), clean)


def test_noisy_guides_are_denoised_first(run):
    pictures, random = noisy_render(), np.random.default_rng(4)
    for name in ("albedo", "normal"):
        pictures[name] = pictures[name] + random.normal(0.0, 0.15, pictures[name].shape).astype(np.float32)
    given = {name: pictures[name] for name in ("image", "albedo", "normal")}
    noisy, clean = (rms(run(Denoise(guides=guides), given), pictures["clean"]) for guides in ("noisy", "clean"))
    assert noisy < clean


def test_normals_alone_and_bad_pixels_are_no_fault(run):
    pictures = noisy_render()
    pictures["image"][10, 10], pictures["image"][20, 20, :3] = np.nan, -3.0
    found = run(Denoise(), {name: pictures[name] for name in ("image", "normal")})
    assert np.isfinite(found).all() and (found >= 0.0).all()
    assert np.isfinite(run(Denoise(), {"image": pictures["image"][:1, :1]})).all()


def test_display_colors_stay_within_their_range(run):
    image = np.clip(noisy_render()["image"], 0.0, 1.0)
    expected = direct((), {"image": image}, hdr=False)
    np.testing.assert_allclose(run(Denoise(hdr=False), {"image": image})[..., :3], expected, atol=1e-5)


def denoised_graph(stops: float) -> Graph:
    graph = Graph().add("denoise", Denoise()).add("exposure", Exposure(stops=stops))
    graph = graph.add_input("image", Input(Kind.IMAGE)).add_output("out", Output())
    links = ((Port("inputs", "image"), Port("denoise", "image")), (Port("denoise", "out"), Port("exposure", "image")))
    for source, target in (*links, (Port("exposure", "out"), Port("outputs", "out"))):
        graph = graph.connect(source, target)
    return graph


def test_it_runs_once_while_what_follows_changes(renderer: Renderer, monkeypatch: pytest.MonkeyPatch):
    calls: list[str] = []

    def count(pictures: Any, settings: Any, report: Any) -> Array:
        calls.append(threading.current_thread().name)
        return denoising.denoise(pictures, settings, report)

    monkeypatch.setattr(host_jobs, "HOST_PROGRAMS", {"open_image_denoise": count})
    image = noisy_render(7)["image"]
    for stops in (0.0, 1.0, 2.0):
        renderer.render(denoised_graph(stops), RenderRequest({"image": image}))
    assert len(calls) == 1 and calls[0].startswith("host")


def test_without_the_library_a_sentence_says_what_to_install(run, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(denoising, "load_oidn", lambda: None)
    with pytest.raises(RenderError, match=r"^node 'node': denoising needs .* pip install 'halation\[denoise\]'$"):
        run(Denoise(), {"image": noisy_render(9)["image"]})


def test_an_abandoned_job_goes_on_until_another_one_is_asked_for(monkeypatch: pytest.MonkeyPatch):
    stopped, started = threading.Event(), threading.Event()

    def wait(pictures: Any, settings: Any, report: Any) -> Array:
        started.set()
        while settings["slow"] and report(0.5):
            time.sleep(0.001)
        if settings["slow"]:
            stopped.set()
        return np.zeros((1, 1, 4), np.float32)

    monkeypatch.setattr(host_jobs, "HOST_PROGRAMS", {"wait": wait})
    jobs = HostJobs()
    slow = jobs.start("slow", HostProgram("wait", (("slow", True),)), {})
    assert started.wait(20.0)
    jobs.abandon("slow")
    assert jobs.find("slow") is slow and not slow.is_done and slow.progress == 0.5
    jobs.abandon("slow")
    jobs.start("quick", HostProgram("wait", (("slow", False),)), {})
    assert jobs.finish("quick").shape == (1, 1, 4) and stopped.is_set() and "slow" not in jobs
    jobs.close()


def test_the_library_stops_when_it_is_told_to():
    image = np.tile(noisy_render()["image"], (4, 4, 1))
    settings, reports = {"guides": "clean", "hdr": True, "quality": "high"}, list[float]()

    def stop(progress: float) -> bool:
        reports.append(progress)
        return False

    with pytest.raises(RenderError, match="did not finish: execution was cancelled"):
        denoising.denoise({"color": image}, settings, stop)
    assert reports
