"""The files of render farms: one job of `halation render` in tasks of some frames each.

Three writers take the same `FarmJob`: a template of Open Job Description (openjd, version 2023-09), a script for arrays
of Slurm, and a workflow of GitHub Actions. Each task is a call of `halation render --frames`, so a farm needs nothing
of Halation but the program. Tasks write whole files or none, and `--resume` keeps what a task that was run before has
written.
"""

from __future__ import annotations

import json
import re
import shlex
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from msgspec import Struct

from ..errors import UsageError
from ..version import VERSION

MAX_TASKS = 1000
"""Tasks of a job: Slurm allows 1001 by default (MaxArraySize), and a list of Open Job Description has at most 1024."""

MAX_MATRIX_TASKS = 256
"""Jobs of a matrix of GitHub Actions, by its documentation."""

_INSTALL = """\
#!/usr/bin/env bash
set -euo pipefail
mkdir -p "$@"
if [ "$(halation --version 2>/dev/null)" = "halation {version}" ]; then exit 0; fi
python3 -m venv "{{{{Session.WorkingDirectory}}}}/halation"
"{{{{Session.WorkingDirectory}}}}/halation/bin/pip" install --quiet "halation=={version}"
echo "openjd_env: PATH={{{{Session.WorkingDirectory}}}}/halation/bin:$PATH"
"""
"""Creates the folders of the frames, which are its arguments, so that no shell reads them as text. Installs the version
that has written the job, for one session, where another one or none is installed."""


class FarmFile(Struct, frozen=True):
    """A file or a folder that a job names: the words around it, its path, and what it is for."""

    before: str
    path: str
    after: str = ""
    about: str = ""
    is_folder: bool = False
    is_output: bool = False


class FarmJob(Struct, frozen=True):
    """A job for a farm: the words of `halation render` without frames, and the frames of each task as texts."""

    name: str
    words: tuple[str | FarmFile, ...]
    chunks: tuple[str, ...]
    gpu: bool = False
    memory: int = 0
    """Bytes that a machine must have; 0 for any number."""


def divide_frames(frames: Sequence[int], size: int, most: int) -> tuple[str, ...]:
    """The frames of each task as texts: `size` frames per task, more where there would be more than `most` tasks."""
    from ..graph.frames import format_frames

    size = max(size, -(-len(frames) // most))
    return tuple(format_frames(frames[start : start + size]) for start in range(0, len(frames), size))


# --- Open Job Description --------------------------------------------------------------------------------------------


def write_openjd(job: FarmJob, folder: Path) -> str:
    """A job template of Open Job Description 2023-09 in YAML, for a file in `folder`.

    Every file is a parameter of type PATH, so that farms map it to their own folders. A path below `folder` is its
    default; for another one the farm asks.
    """
    parameters: list[dict[str, Any]] = []
    arguments: list[str] = []
    folders: list[str] = []
    for word in job.words:
        if isinstance(word, str):
            arguments.append(_refuse_places(word))
            continue
        name = f"File{len(parameters) + 1}"
        parameters.append(_describe_path(name, word, folder))
        folders += [f"{{{{Param.{name}}}}}"] if word.is_output else []
        arguments.append(f"{_refuse_places(word.before)}{{{{Param.{name}}}}}{_refuse_places(word.after)}")
    arguments += ["--frames={{Task.Param.Frames}}"]
    amounts = [{"name": "amount.worker.gpu", "min": 1}] if job.gpu else []
    amounts += [{"name": "amount.worker.memory", "min": -(-job.memory // 2**20)}] if job.memory else []
    step: dict[str, Any] = {
        "name": "Render",
        "parameterSpace": {
            "taskParameterDefinitions": [{"name": "Frames", "type": "STRING", "range": list(job.chunks)}]
        },
        "script": {"actions": {"onRun": {"command": "halation", "args": arguments}}},
    }
    if amounts:
        step["hostRequirements"] = {"amounts": amounts}
    script = _INSTALL.format(version=VERSION)
    install = {
        "name": "Halation",
        "script": {
            "actions": {"onEnter": {"command": "bash", "args": ["{{Env.File.Install}}", *folders]}},
            "embeddedFiles": [{"name": "Install", "type": "TEXT", "filename": "install.sh", "data": script}],
        },
    }
    template = {
        "specificationVersion": "jobtemplate-2023-09",
        "name": job.name[:64],
        "parameterDefinitions": parameters,
        "jobEnvironments": [install],
        "steps": [step],
    }
    return "\n".join(_list_yaml_lines(template, "")) + "\n"


def _describe_path(name: str, file: FarmFile, folder: Path) -> dict[str, Any]:
    """The definition of the parameter of a file."""
    path = Path(file.path).resolve()
    default = {"default": str(path.relative_to(folder.resolve()))} if path.is_relative_to(folder.resolve()) else {}
    return {
        "name": name,
        "type": "PATH",
        "description": file.about,
        "objectType": "DIRECTORY" if file.is_folder else "FILE",
        "dataFlow": "OUT" if file.is_output else "IN",
        **default,
    }


def _refuse_places(text: str) -> str:
    """The text. Raises UsageError where Open Job Description would read it as a place for a parameter."""
    if "{{" in text:
        raise UsageError(f"{text}: Open Job Description replaces what is in double braces: write it without them")
    return text


def _list_yaml_lines(part: Any, indent: str) -> Iterator[str]:
    """The lines of a value in YAML. Its scalars are those of JSON, which YAML includes; so nothing depends on words
    that YAML takes for something else, such as `no` or `1-10`."""
    if isinstance(part, dict):
        for key, entry in part.items():  # pyright: ignore[reportUnknownVariableType]
            if isinstance(entry, dict | list) and entry:
                yield f"{indent}{key}:"
                yield from _list_yaml_lines(entry, f"{indent}  ")
            else:
                yield f"{indent}{key}: {json.dumps(entry)}"
    else:
        for entry in part:
            if isinstance(entry, dict):
                first, *rest = _list_yaml_lines(entry, f"{indent}  ")
                yield f"{indent}- {first.lstrip()}"
                yield from rest
            else:
                yield f"{indent}- {json.dumps(entry)}"


# --- Slurm and GitHub Actions ----------------------------------------------------------------------------------------


def write_slurm(job: FarmJob) -> str:
    """A script for `sbatch` that renders one chunk of frames in each task of an array."""
    lines = [
        "#!/bin/bash",
        f"#SBATCH --job-name={_name_safely(job.name)}",
        f"#SBATCH --array=0-{len(job.chunks) - 1}",
        f"#SBATCH --output={_name_safely(job.name)}-%A_%a.log",
    ]
    lines += ["#SBATCH --gres=gpu:1"] if job.gpu else []
    lines += [f"#SBATCH --mem={-(-job.memory // 2**20)}M"] if job.memory else []
    lines += [
        f"# Written by Halation {VERSION}; submit it with sbatch, in the folder where relative paths start.",
        "set -euo pipefail",
        f"mkdir -p {shlex.join(_list_folders(job))}",
        f"chunks=({' '.join(shlex.quote(chunk) for chunk in job.chunks)})",
        f'halation {shlex.join(_list_words(job))} --frames="${{chunks[SLURM_ARRAY_TASK_ID]}}"',
    ]
    return "\n".join(lines) + "\n"


def write_actions(job: FarmJob) -> str:
    """A workflow of GitHub Actions with one job for each chunk of frames, and the frames as artifacts."""
    if len(job.chunks) > MAX_MATRIX_TASKS:
        raise UsageError(f"GitHub Actions runs at most {MAX_MATRIX_TASKS} jobs of a matrix: raise --chunk")
    folders = _list_folders(job)
    command = f'halation {shlex.join(_list_words(job))} --frames="$FRAMES"'
    if "${{" in command:
        raise UsageError("GitHub Actions replaces what is in ${{ }}: write the command without them")
    packages = "sudo apt-get update && sudo apt-get install -y --no-install-recommends libegl1 libgl1"
    steps: list[dict[str, Any]] = [
        {"uses": "actions/checkout@v4"},
        {"uses": "actions/setup-python@v5", "with": {"python-version": "3.12"}},
        {"run": packages},
        {"run": f"pip install halation=={VERSION}"},
        {"run": f"mkdir -p {shlex.join(folders)}"},
        {"run": command, "env": {"FRAMES": "${{ matrix.frames }}"}},
        {
            "uses": "actions/upload-artifact@v4",
            "with": {"name": "frames-${{ strategy.job-index }}", "path": "\n".join(folders)},
        },
    ]
    strategy = {"fail-fast": False, "matrix": {"frames": list(job.chunks)}}
    render = {"runs-on": "ubuntu-24.04", "strategy": strategy, "steps": steps}
    workflow = {"name": job.name, "on": ["workflow_dispatch"], "jobs": {"render": render}}
    return "\n".join(_list_yaml_lines(workflow, "")) + "\n"


def _list_words(job: FarmJob) -> list[str]:
    """The words of the command, with all files by their own paths."""
    return [word if isinstance(word, str) else f"{word.before}{word.path}{word.after}" for word in job.words]


def _list_folders(job: FarmJob) -> list[str]:
    """The folders that frames are written to, each once."""
    return list(dict.fromkeys(word.path for word in job.words if isinstance(word, FarmFile) and word.is_output))


def _name_safely(name: str) -> str:
    return re.sub(r"[^\w.-]+", "_", name)
