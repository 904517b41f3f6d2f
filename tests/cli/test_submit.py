"""`halation submit`: files for render farms, run by the tools that they are for."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
from exr_files import write_exr
from halation.cli import submit as submit_module
from halation.cli.farm_files import MAX_TASKS, FarmFile, divide_frames
from halation.graph.frames import parse_frames
from halation.presets import paths

BIN = Path(sys.executable).parent
POSIX = pytest.mark.skipif(os.name == "nt", reason="POSIX")
FRAMES = range(1, 5)


@pytest.fixture
def shot_folder(tmp_path, monkeypatch, graphs) -> Path:
    """A graph over four frames; names are relative to the current folder."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "in").mkdir()
    for frame in FRAMES:
        picture = np.full((8, 12, 4), frame / 4.0, np.float32)
        write_exr(tmp_path / "in" / f"a b.{frame:04d}.exr", {"Combined": picture}, {"Combined": "half"})
    graphs("look.json", inputs={"beauty": {"type": "Image"}})
    return tmp_path


def submit(cli, *words: object):
    return cli("submit", "look.json", "-i", "beauty=in/a b.####.exr", "--set", "light.stops=1.5", "--chunk=3", *words)


def run(*words: str, **variables: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PATH": f"{BIN}{os.pathsep}{os.environ['PATH']}", **variables}
    return subprocess.run(words, env=environment, capture_output=True, text=True, timeout=240, check=False)


def check_frames(cli, folder: Path) -> None:
    """The frames of the farm are those of one local render, to the byte."""
    words = ("-i", "beauty=in/a b.####.exr", "--set", "light.stops=1.5", "-o", "local.####.exr")
    assert cli("render", "look.json", *words).code == 0
    for frame in FRAMES:
        assert (folder / f"f.{frame:04d}.exr").read_bytes() == Path(f"local.{frame:04d}.exr").read_bytes()


@POSIX
def test_open_job_description_is_valid_and_runs(cli, shot_folder):
    result = submit(cli, "-o", "out/f.####.exr", "--openjd", "job.yaml", "--json")
    assert result.code == 0 and result.json == {"written": ["job.yaml"], "frames": 4, "tasks": {"job.yaml": 2}}
    checked = run(str(BIN / "openjd"), "check", "job.yaml")
    assert checked.returncode == 0 and "passes validation" in checked.stdout, checked.stdout + checked.stderr
    ran = run(str(BIN / "openjd"), "run", "job.yaml", "--step", "Render")
    assert ran.returncode == 0 and "Chunks run: 2" in ran.stdout, ran.stdout + ran.stderr
    check_frames(cli, shot_folder / "out")


@POSIX
def test_no_shell_runs_the_names_of_folders(cli, shot_folder):
    folder = "o'\"$(touch pwned)`touch pwned`; touch pwned\nx"
    assert submit(cli, "-o", f"{folder}/f.####.exr", "--openjd", "job.yaml", "--slurm", "job.sh").code == 0
    ran = run(str(BIN / "openjd"), "run", "job.yaml", "--step", "Render")
    assert ran.returncode == 0, ran.stdout + ran.stderr
    frames = sorted((shot_folder / folder).iterdir())
    assert run("bash", "job.sh", SLURM_ARRAY_TASK_ID="0").returncode == 0
    assert len(frames) == 4 and sorted((shot_folder / folder).iterdir()) == frames
    assert not [*shot_folder.rglob("pwned")]


@POSIX
def test_a_farm_maps_paths_and_asks_for_machines(cli, shot_folder):
    (shot_folder / "farm").mkdir()
    words = ("-o", "elsewhere/f.####.exr", "--openjd", "farm/job.yaml", "--gpu", "--memory", "2G")
    assert submit(cli, *words).code == 0
    template = (shot_folder / "farm" / "job.yaml").read_text()
    assert 'name: "amount.worker.gpu"' in template and "min: 2048" in template
    assert "default" not in template  # nothing lies below the folder of the template
    assert run(str(BIN / "openjd"), "check", "farm/job.yaml").returncode == 0
    places = [f"File1={shot_folder / 'look.json'}", f"File2={shot_folder / 'in'}", f"File3={shot_folder / 'mapped'}"]
    options = [word for place in places for word in ("-p", place)]
    ran = run(str(BIN / "openjd"), "run", "farm/job.yaml", "--step", "Render", *options, "--maximum-tasks", "1")
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert sorted(path.name for path in (shot_folder / "mapped").iterdir()) == [
        f"f.000{frame}.exr" for frame in (1, 2, 3)
    ]


@POSIX
def test_a_script_of_slurm_is_clean_and_renders(cli, shot_folder):
    assert submit(cli, "-o", "out dir/f.####.exr", "--slurm", "job.sh", "--gpu", "--memory", "1G").code == 0
    script = (shot_folder / "job.sh").read_text()
    assert "#SBATCH --array=0-1\n" in script and "#SBATCH --gres=gpu:1\n" in script and "--mem=1024M\n" in script
    checked = run(str(BIN / "shellcheck"), "--severity=style", "job.sh")
    assert checked.returncode == 0, checked.stdout
    for task in range(2):
        ran = run("bash", "job.sh", SLURM_ARRAY_TASK_ID=str(task))
        assert ran.returncode == 0, ran.stderr
    words = ("-i", "beauty=in/a b.####.exr", "--set", "light.stops=1.5", "-o", "local.####.exr", "--memory", "1G")
    assert cli("render", "look.json", *words).code == 0
    for frame in FRAMES:
        farm, local = (shot_folder / name for name in (f"out dir/f.{frame:04d}.exr", f"local.{frame:04d}.exr"))
        assert farm.read_bytes() == local.read_bytes()


def test_a_workflow_is_valid_by_the_schema_of_github(cli, shot_folder):
    pytest.importorskip("check_jsonschema", reason="check-jsonschema is not installed")
    assert submit(cli, "-o", "out/f.####.exr", "--actions", "flow.yml").code == 0
    words = (str(BIN / "check-jsonschema"), "--builtin-schema", "vendor.github-workflows")
    checked = run(*words, "flow.yml")
    assert checked.returncode == 0, checked.stdout
    if linter := shutil.which("actionlint"):
        linted = run(linter, "flow.yml")
        assert linted.returncode == 0, linted.stdout
    flow = shot_folder / "flow.yml"
    flow.write_text(flow.read_text().replace("runs-on", "run-on"))
    assert run(*words, "flow.yml").returncode == 1


@POSIX
def test_the_command_of_a_workflow_renders(cli, shot_folder):
    assert submit(cli, "-o", "out/f.####.exr", "--actions", "flow.yml").code == 0
    text = (shot_folder / "flow.yml").read_text()
    workflow = import_module("yaml").safe_load(text)  # which has no types
    (job,) = workflow["jobs"].values()
    assert workflow[True if True in workflow else "on"] == ["workflow_dispatch"]
    assert job["strategy"]["matrix"]["frames"] == ["1-3", "4"]
    folder_step, render_step = [step for step in job["steps"] if re.match("mkdir|halation", step.get("run", ""))]
    for chunk in job["strategy"]["matrix"]["frames"]:
        assert render_step["env"] == {"FRAMES": "${{ matrix.frames }}"}
        ran = run("bash", "-e", "-c", f"{folder_step['run']}\n{render_step['run']}", FRAMES=chunk)
        assert ran.returncode == 0, ran.stderr
    check_frames(cli, shot_folder / "out")
    assert job["steps"][-1]["with"]["path"] == "out"


def test_frames_that_need_others_are_one_task(cli, shot_folder, graphs):
    trail = {"light": {"type": "exposure"}, "trail": {"type": "frame_blend"}}
    links = {"trail.image": "light.out", "outputs.image": "trail.out"}
    graphs("look.json", inputs={"beauty": {"type": "Image"}}, nodes=trail, links=links)
    result = cli("submit", "look.json", "-i", "beauty=in/a b.####.exr", "-o", "f.####.exr", "--slurm", "job.sh")
    assert result.code == 0 and "node 'trail' needs the frame before each" in result.err
    assert "--array=0-0\n" in (shot_folder / "job.sh").read_text()


def test_a_graph_whose_name_looks_like_an_option_stays_a_file(cli, shot_folder):
    (shot_folder / "look.json").rename(shot_folder / "-look.json")
    words = ("./-look.json", "-i", "beauty=in/a b.####.exr", "-o", "f.####.exr", "--slurm", "job.sh")
    assert cli("submit", *words, "--frames", "1-4").code == 0
    assert "halation render ./-look.json" in (shot_folder / "job.sh").read_text()


def test_a_preset_goes_by_its_name(cli, shot_folder):
    words = ("-i", "beauty=in/a b.####.exr", "-o", "f.####.png", "--frames", "1-9", "--slurm", "job.sh")
    assert cli("submit", "dreamy_glow", *words).code == 0
    assert "halation render dreamy_glow " in (shot_folder / "job.sh").read_text()


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (("-o", "f.####.exr"), "no file is named: write --openjd job.yaml"),
        (("-o", "f.exr", "--frames", "1-4", "--slurm", "job.sh"), "4 frames cannot go into one file"),
        (("-o", "f.####.exr", "--set", "light.stopps=1", "--slurm", "job.sh"), "light.stopps"),
        (("-o", "{{f}}.####.exr", "--openjd", "job.yaml"), "replaces what is in double braces"),
        (("-o", "f.####.exr", "--slurm", "no/job.sh"), "there is no such folder"),
    ],
)
def test_what_cannot_be_submitted_is_refused(cli, shot_folder, words, reason):
    result = cli("submit", "look.json", "-i", "beauty=in/a b.####.exr", *words)
    assert result.code in (1, 2) and reason in result.err and result.err.count("\n") == 1
    assert not list(shot_folder.glob("job.*"))


@pytest.mark.parametrize(("count", "size"), [(1, 10), (10, 10), (11, 10), (2400, 1), (100_000, 7)])
def test_chunks_hold_each_frame_once(count, size):
    chunks = divide_frames(tuple(range(1, count + 1)), size, MAX_TASKS)
    assert len(chunks) <= MAX_TASKS
    assert [frame for chunk in chunks for frame in parse_frames(chunk)] == list(range(1, count + 1))


def test_what_the_farm_files_hold_is_json_in_yaml(cli, shot_folder):
    """Scalars are those of JSON, so that no reader of YAML takes a text for a number or a date."""
    assert submit(cli, "-o", "f.####.exr", "--openjd", "job.yaml").code == 0
    for line in (shot_folder / "job.yaml").read_text().splitlines():
        scalar = re.sub(r"^ *(- )?(\w+:)? ?", "", line)
        assert not scalar or json.loads(scalar) is not None, line


def test_the_words_of_a_task_and_the_files_in_them(tmp_path):
    """What a farm copies: files by themselves, and folders where a name has a place for the frame."""

    def list_words(path, **more):
        options = {"inputs": None, "sets": None, "node": "", "size": None, "scale": 1.0, "precision": None}
        options |= {"memory": None, "view": ""}
        return [*submit_module._list_words(path, **{"output": ["o/f.####.exr"], **options, **more})]

    target = FarmFile("--output=", "o", "/f.####.exr", "the folder of the frames", True, True)
    graph = FarmFile("", "a.json", about="the graph")
    assert list_words(Path("a.json")) == ["render", graph, target, "--resume"]
    inputs = ["plate=in/p.%04d.exr:Depth", "still.png:R"]
    words = list_words(
        Path("-a.json"), inputs=inputs, sets=["b.c=1"], output=["x=o/f.png"], node="n", size="8x6", scale=0.5,
        precision="half", memory="2G", view="sRGB",
    )  # fmt: skip
    assert words == [
        "render",
        FarmFile("", "./-a.json", about="the graph"),
        FarmFile("--input=plate=", "in", "/p.%04d.exr:Depth", "the folder of input plate", True),
        FarmFile("--input=", "still.png", ":R", "input"),
        FarmFile("--output=x=", "o", "/f.png", "the folder of the frames", True, True),
        "--set=b.c=1", "--node=n", "--size=8x6", "--scale=0.5", "--precision=half", "--memory=2G", "--view=sRGB",
        "--resume",
    ]  # fmt: skip
    preset = paths()[0]
    assert list_words(preset)[1] == preset.stem
