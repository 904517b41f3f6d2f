"""How far work is: lines of JSON, and bars, whose numbers are counted by hand."""

from __future__ import annotations

import io
import json
import sys
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from halation.cli import cluster_progress, fit_progress, gallery, progress
from halation.cli.batch import open_batch
from halation.cli.cluster_progress import ClusterProgress, list_written
from halation.cli.progress import ProgressBar, progress_reporter
from halation.cluster.campaign_report import CampaignReport
from halation.media.comparison import contact_sheet
from halation.renderer.jobs.render_entry import RenderEntry
from halation.renderer.jobs.render_job import RenderJob
from halation.resources.sandbox import UNRESTRICTED


class Terminal(io.StringIO):
    """A stream that says that it is a terminal."""

    def isatty(self) -> bool:
        return True


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    clock = SimpleNamespace(now=10.0)
    monkeypatch.setattr(progress, "time", SimpleNamespace(perf_counter=lambda: clock.now))
    return clock


def make_report(frame: int, **facts: Any) -> Any:
    return SimpleNamespace(**{"frame": frame, "written": (Path("a.exr"),), "is_kept": False, "passes": 4, **facts})


def test_each_event_is_a_line_of_json(capsys: pytest.CaptureFixture[str]) -> None:
    with progress_reporter("json", 3) as reporter:
        reporter.report_helpers([7, 8])
        reporter.report_pass(2, 1, 9, ["a", "b"])
        reporter.report_frame(make_report(2, is_kept=True), 1, 3)
        reporter.report_entry({"file": "a.exr"}, 2, 3)
    out, err = capsys.readouterr()
    assert out == "" and [json.loads(line) for line in err.splitlines()] == [
        {"processes": [7, 8]},
        {"frame": 2, "pass": 1, "passes": 9, "nodes": ["a", "b"]},
        {"frame": 2, "done": 1, "frames": 3, "written": ["a.exr"], "kept": True, "passes": 4},
        {"file": "a.exr", "done": 2, "files": 3},
    ]


def read_bar(bar: Any) -> tuple[str, float, float] | None:
    """What a bar shows: a word, how much is done, and how much there is."""
    if bar._progress is None:
        return None
    (task,) = bar._progress.tasks
    return task.description, task.completed, task.total


def test_a_bar_shows_frames_after_a_moment(monkeypatch: pytest.MonkeyPatch, clock: SimpleNamespace) -> None:
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())
    with progress_reporter("bar", 3) as bar:
        bar.report_helpers([1])
        clock.now += 0.29
        bar.report_frame(make_report(1), 1, 3)
        assert read_bar(bar) is None, "short work shows none"
        clock.now += 0.02
        bar.report_pass(2, 5, 9, ["noise", "blur"])
        assert read_bar(bar) == ("frame 2  blur", 0, 3)
        bar.report_frame(make_report(2), 2, 3)
        assert read_bar(bar) == ("frame 2", 2, 3)
        bar.report_pass(3, 1, 9, ["noise"])
        assert read_bar(bar) == ("frame 3  noise", 2, 3)
        assert isinstance(bar, ProgressBar) and bar._progress is not None and bar._progress.live.is_started
    assert not bar._progress.live.is_started and "2/3 frames" in terminal.getvalue() and "left" in terminal.getvalue()


def test_a_bar_of_one_frame_shows_its_passes_and_one_of_files_their_names(
    monkeypatch: pytest.MonkeyPatch, clock: SimpleNamespace
) -> None:
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())
    for unit in ("frames", "files"):
        with progress_reporter("bar", 1, unit) as bar:
            clock.now += 1.0
            if unit == "frames":
                bar.report_pass(7, 3, 8, ["noise", "blur"])
                bar.report_frame(make_report(7), 1, 1)
                assert read_bar(bar) == ("blur", 3, 8)
            else:
                bar.report_entry({"file": "show/a.exr"}, 1, 2)
                assert read_bar(bar) == ("a.exr", 1, 2)
    text = terminal.getvalue()
    assert "3/8 passes" in text and "1/2 files" in text and text.index("left") > text.index("passes")


def test_without_a_terminal_there_is_no_bar(monkeypatch: pytest.MonkeyPatch, clock: SimpleNamespace) -> None:
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    bar = ProgressBar(2)
    clock.now += 9.0
    bar.report_frame(make_report(1), 1, 2)
    bar.close()
    assert read_bar(bar) is None


def test_better_values_are_lines_at_most_five_times_a_second(capsys: pytest.CaptureFixture[str]) -> None:
    space: Any = SimpleNamespace(settings_at=lambda point: {"a.b": float(point[0])})
    lines = fit_progress.FitLines(space)
    found = [(0.0, None), (0.1, 1.0), (0.2, 2.0), (0.29, 3.0), (0.31, 3.0), (9.0, 3.0), (9.1, 4.0)]
    for count, (elapsed, best) in enumerate(found):
        point = None if best is None else np.array([best])
        meter: Any = SimpleNamespace(best=point, elapsed=elapsed, count=count, seconds=10.0, renders=10, error=0.5)
        lines.report(meter)
    printed = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert [(line["renders"], line["settings"]["a.b"]) for line in printed] == [(1, 1.0), (4, 3.0), (6, 4.0)]
    assert [line["done"] for line in printed] == [0.1, 0.4, 0.91] and printed[0]["error"] == 0.5


@pytest.mark.parametrize("prints_lines", [False, True])
def test_a_search_prints_lines_if_asked(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], prints_lines: bool
) -> None:
    def search(task: Any, is_stopped: Any, report: Any) -> str:
        assert not is_stopped()
        report(SimpleNamespace(best=np.array([2.0]), elapsed=1.0, count=4, seconds=10.0, renders=10, error=0.5))
        return "found"

    monkeypatch.setattr("halation.fit.fitting.fit_values", search)
    task: Any = SimpleNamespace(space=SimpleNamespace(settings_at=lambda point: {"a.b": float(point[0])}))
    assert fit_progress.follow_fit(task, prints_lines) == "found"
    lines = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert lines == [{"renders": 4, "done": 0.4, "error": 0.5, "settings": {"a.b": 2.0}}] * prints_lines


def test_a_batch_closes_its_renderer_whatever_happens(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    renderer = SimpleNamespace(device=SimpleNamespace(description="a device"), closed=0)
    renderer.close = lambda: setattr(renderer, "closed", renderer.closed + 1)
    monkeypatch.setattr("halation.renderer.Renderer", lambda *_, **__: renderer)
    monkeypatch.setattr("halation.renderer.open_device", lambda **_: None)
    with open_batch(tmp_path / "new", 2, sandbox=UNRESTRICTED) as batch:
        assert (batch.renderer, renderer.closed) == (renderer, 0)
    with pytest.raises(ZeroDivisionError), open_batch(tmp_path, 2, sandbox=UNRESTRICTED):
        raise ZeroDivisionError
    assert renderer.closed == 2


@pytest.mark.parametrize(
    ("frames", "with_videos", "names"),
    [
        ((1, 2), True, ["a.0001.exr", "still.png", "a.0002.exr", "all.mp4"]),
        ((1, 2), False, ["a.0001.exr", "still.png", "a.0002.exr"]),
        ((), True, []),
    ],
)
def test_files_of_frames_are_named_as_the_user_does(
    frames: tuple[int, ...], with_videos: bool, names: list[str]
) -> None:
    destinations = (("", "all.mp4"), ("x", "a.####.exr"), ("y", "still.png"))
    assert list_written(destinations, frames, with_videos=with_videos) == names


def open_cluster_progress(kind: Any, dashboard: str = "", **more: Any) -> ClusterProgress:
    job = RenderJob(sandbox=UNRESTRICTED, destinations=(("", "f.####.exr"),), **more)
    return ClusterProgress(job, 4, kind, dashboard)


def test_frames_of_a_cluster_are_lines_once(capsys: pytest.CaptureFixture[str]) -> None:
    report = CampaignReport({3: 0.5}, kept={3})
    with open_cluster_progress("json", "http://farm") as shown:
        shown.report_progress(report, 2)
        report.seconds[1] = 1.5
        shown.report_progress(report, 5)
        shown.report_progress(report, 5)
        shown.report_entry({"file": "a"}, 1, 2)
        shown.report_note("a worker has gone")
    first, *lines, last = capsys.readouterr().err.splitlines()
    assert first == "dashboard http://farm" and last == "a worker has gone"
    assert [json.loads(line) for line in lines] == [
        {"frame": 3, "done": 1, "frames": 4, "written": ["f.0003.exr"], "kept": True, "seconds": 0.5, "workers": 2},
        {"frame": 1, "done": 2, "frames": 4, "written": ["f.0001.exr"], "kept": False, "seconds": 1.5, "workers": 5},
        {"file": "a", "done": 1, "files": 2, "workers": 5},
    ]


def test_a_bar_of_a_cluster_names_the_slowest(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    entries = tuple(RenderEntry(name) for name in ("a.exr", "b.exr", "c.exr"))
    for more, done, slowest in (
        ({}, 4, "4 (9.0 s), 2 (3.0 s), 1 (2.0 s)"),
        ({"entries": entries}, 3, "b.exr (3.0 s), a.exr (2.0 s)"),
    ):
        with monkeypatch.context() as patch:
            patch.setattr(sys, "stderr", terminal := Terminal())
            with open_cluster_progress("bar", **more) as shown:
                seconds = {1: 2.0, 2: 3.0} if more else {1: 2.0, 2: 3.0, 3: 1.0, 4: 9.0}
                shown.report_progress(CampaignReport(seconds, faults={3: {}}), 1)
                assert read_bar(shown) == (f"1 worker, slowest {slowest}", done, 4)
                shown.report_note("a worker [red]has gone")
            assert "a worker [red]has gone" in terminal.getvalue()
            assert f"/4 {'files' if more else 'frames'}" in terminal.getvalue()
            assert shown._progress is not None and not shown._progress.live.is_started
    with open_cluster_progress("bar") as shown:
        shown.report_progress(CampaignReport({1: 2.0}), 1)
    assert read_bar(shown) is None and capsys.readouterr().err == ""


def test_a_file_of_a_job_with_many_is_described_as_by_one_process() -> None:
    from halation.cluster.chunk import EntryOutcome

    entry = RenderEntry("a.exr", destinations=(("", "o.####.png"), ("", "o.mp4")))
    report = CampaignReport({1: 1.0}, kept={1}, faults={2: {"message": "no"}}, entries={1: EntryOutcome((4, 5), 6)})
    describe = cluster_progress._describe_part  # pyright: ignore[reportPrivateUsage]
    names = ["o.0004.png", "o.0005.png", "o.mp4"]
    done = {"file": "a.exr", "written": names, "frames": [4, 5], "kept": True, "passes": 6}
    assert describe(1, entry, report) == done
    nothing = {"file": "a.exr", "written": [], "frames": [], "kept": False, "passes": 0}
    assert describe(2, entry, report) == {**nothing, "error": {"message": "no"}}
    report.entries[2] = EntryOutcome((4,), 3)
    assert describe(2, entry, report)["written"] == ["o.0004.png"], "a video is not complete"


def test_a_gallery_says_how_many_pictures_there_will_be(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Nothing is drawn: the steps are counted, and the frames of a row are an even part of the animation each."""
    totals, steps, frames, sheets = list[int](), list[str](), list[list[int]](), dict[str, str]()
    batch = SimpleNamespace(
        renderer=SimpleNamespace(find_frames=lambda graph: (11, 21)), step=steps.append, say=print, device="none"
    )

    @contextmanager
    def open_batch(output: Path, total: int, *, sandbox: object):
        totals.append(total)
        yield batch

    def draw(graph: object, renderer: object, numbers: Any) -> dict[int, None]:
        frames.append([*numbers])
        return dict.fromkeys(frames[-1])

    monkeypatch.setattr(gallery, "open_batch", open_batch)
    monkeypatch.setattr(gallery, "render_display_frames", draw)
    monkeypatch.setattr(gallery, "render_node", lambda *_: None)
    monkeypatch.setattr(contact_sheet, "make_grouped_sheet", lambda *_, **__: None)
    monkeypatch.setattr(
        contact_sheet, "write_sheet", lambda file, light, names, sandbox: sheets.update({file.name: names})
    )
    assert gallery.gallery(tmp_path, as_json=True) == 0
    out = capsys.readouterr().out
    rows = json.loads(out[out.index("{") :])["sheets"]
    assert totals == [len(steps)] == [sum(len(row["pictures"]) for row in rows)]
    assert {Path(row["sheet"]).name: ", ".join(row["pictures"]) for row in rows} == sheets
    assert all([*map(int, numbers)] in ([16], [11, 13, 15, 17, 19, 21]) for numbers in frames)
    assert {len(numbers) for numbers in frames} == {1, 6} and sheets.keys() <= {"presets.jpg", "time.jpg", "nodes.jpg"}
