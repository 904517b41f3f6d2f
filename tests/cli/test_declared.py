"""`pip install halation` alone runs all that it offers: nothing but declared libraries, and theirs, can be imported."""

from __future__ import annotations

import ast
import json
import os
import re
import subprocess
import sys
from functools import cache
from importlib.metadata import distribution, packages_distributions, requires
from pathlib import Path

import numpy as np
import trimesh
from halation.presets import paths
from oiio_pictures import write_picture

EXTRAS = ("scipy", "cv2", "av", "hypothesis", "jsonschema")
"""Modules of the extras: if one of them can be imported below, the test tests nothing."""

BLOCKER = """
import json, sys
class Blocker:
    def find_spec(self, name, path=None, target=None):
        top = name.partition(".")[0]
        if path is None and top in blocked:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
blocked = set(json.loads(sys.argv[1]))
sys.meta_path.insert(0, Blocker())
for extra in json.loads(sys.argv[2]):
    try:
        __import__(extra)
    except ModuleNotFoundError:
        continue
    sys.exit(f"{extra} can be imported")
import halation.presets
paths = halation.presets.paths()
halation.presets.paths = lambda: paths[::20]  # those of the demo
from halation.cli.program import run
for words in json.loads(sys.stdin.read()):
    code = run(words)
    sys.stdout.flush()
    print("\\n@@", code, *words, file=sys.stderr, flush=True)
"""


@cache
def find_blocked() -> tuple[str, ...]:
    """Top modules of all distributions here that Halation does not declare, directly or through those it declares."""
    names, waiting = set[str](), ["halation"]
    while waiting:
        name = re.sub(r"[-_.]+", "-", waiting.pop()).lower()
        if name in names:
            continue
        names.add(name)
        try:
            needs = requires(name) or []
        except ModuleNotFoundError:
            continue  # of another platform
        waiting += [re.split(r"[ ;<>=!~\[(]", need)[0] for need in needs if "extra ==" not in need]
    blocked = []
    for module, owners in packages_distributions().items():
        if not {re.sub(r"[-_.]+", "-", owner).lower() for owner in owners} & names:
            blocked.append(module)
    return tuple(sorted(blocked))


def run_alone(folder: Path, commands: list[list[str]]) -> str:
    """Standard error of these commands, all in one process that has the declared libraries only."""
    arguments = [json.dumps(find_blocked()), json.dumps(EXTRAS)]
    ended = subprocess.run(
        [sys.executable, "-P", "-c", BLOCKER, *arguments],
        cwd=folder,
        input=json.dumps(commands),
        capture_output=True,
        text=True,
        timeout=600,
        env={**os.environ, "LP_NUM_THREADS": "1", "PYTHONWARNINGS": "error"},
    )
    assert ended.returncode == 0, ended.stderr
    codes = re.findall(r"^@@ (\d+) (.*)$", ended.stderr, re.MULTILINE)
    assert [line for code, line in codes if code != "0"] == [], ended.stderr
    assert len(codes) == len(commands)
    assert "Traceback" not in ended.stderr and "scipy" not in ended.stderr
    return ended.stderr


def test_the_extras_are_blocked():
    assert {"scipy", "cv2", "pytest"} <= set(find_blocked()) and distribution("halation")
    assert not {"halation", "numpy", "trimesh", "OpenImageIO", "PyOpenColorIO", "typer"} & set(find_blocked())


def scene(name: str) -> dict[str, object]:
    return {
        "halation": 1,
        "settings": {"size": [24, 16]},
        "outputs": {"image": {"type": "Image"}},
        "nodes": {"n": {"type": "scene", "values": {"scene": "file", "file": name}}},
        "links": {"outputs.image": "n.color"},
    }


def test_meshes_of_every_format(tmp_path):
    commands = []
    for ending in ("obj", "ply", "stl", "glb", "gltf"):
        shape = trimesh.creation.icosphere(2)
        exported = trimesh.Scene(shape).export(
            file_type=ending, **({"include_normals": False} if ending == "obj" else {})
        )
        for file, content in (exported if isinstance(exported, dict) else {"": exported}).items():
            path = tmp_path / (f"mesh.{ending}" if not file or file.endswith(ending) else file)
            path.write_bytes(content if isinstance(content, bytes) else content.encode())
        (tmp_path / f"{ending}.json").write_text(json.dumps(scene(f"mesh.{ending}")))
        commands += [["check", f"{ending}.json"], ["render", f"{ending}.json", "-o", f"{ending}.exr"]]
    run_alone(tmp_path, commands)


def test_the_demo_and_every_command(tmp_path):
    """All presets are planned, which reads their files and runs the Python of their nodes, and a few rendered."""
    write_picture(tmp_path / "a.exr", np.full((8, 8, 4), 0.5, np.float32))
    (tmp_path / "g.json").write_text(json.dumps({
        "halation": 1, "nodes": {"n": {"type": "read_image", "values": {"path": "a.exr"}},
            "b": {"type": "gaussian_blur"}},
        "outputs": {"image": {"type": "Image"}}, "links": {"outputs.image": "b.out", "b.image": "n.out"},
    }))  # fmt: skip
    (tmp_path / "s.suite.toml").write_text('[cases.blur]\ngraph = "g.json"\n')
    commands = [
        ["demo", "-o", "demo"],
        *(["explain", str(path)] for path in paths()),
        *(
            ["render", str(path), "-o", f"{path.stem}.png", "--scale", "0.25"]
            for path in paths()
            if path.stem in ("slate", "still_life")  # letters, and what is lit
        ),
        ["info", "a.exr"],
        ["info", "a.exr", "--json"],
        ["check", "g.json"],
        ["explain", "g.json"],
        ["render", "g.json", "-o", "o.exr"],
        ["render", "g.json", "-o", "o.png", "--view", "ACES"],
        ["fmt", "g.json"],
        ["schema"],
        ["nodes"],
        ["diff", "g.json", "g.json"],
        ["reproduce", "o.exr"],
        ["test", "s.suite.toml", "--update"],
        ["test", "s.suite.toml"],
    ]
    run_alone(tmp_path, commands)


OPTIONAL = {
    "av": "the extra 'video'",
    "cma": "the extra 'fit'",
    "scipy": "the extra 'fit'",
    "dask": "the extra 'cluster'",
    "distributed": "the extra 'cluster'",
    "pyoidn": "the extra 'denoise'",
    "pytest": "the plug-in of pytest, which loads it",
}


def test_every_import_is_declared():
    """Also those that no command above reaches."""
    undeclared: dict[str, str] = {}
    for folder in ("app", "nodes", "shaders", "presets"):
        for path in Path(folder).rglob("*.py"):
            for node in ast.walk(ast.parse(path.read_text("utf-8"))):
                names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
                names += [node.module or ""] if isinstance(node, ast.ImportFrom) and not node.level else []
                for top in {name.partition(".")[0] for name in names}:
                    if top in find_blocked() and top not in OPTIONAL:
                        undeclared[top] = str(path)
    assert not undeclared
