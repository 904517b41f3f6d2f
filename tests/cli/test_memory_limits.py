"""Little memory (`ulimit -v`): one sentence and a documented exit code, whatever the libraries do then."""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from oiio_pictures import write_picture

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux keeps to it")


def limit(mebibytes: int) -> Callable[[], None]:
    return lambda: resource.setrlimit(resource.RLIMIT_AS, (mebibytes << 20, mebibytes << 20))


@pytest.mark.parametrize("mebibytes", [100, 170, 250, 400, 600, 800, 1000, 1150, 1400, 1700])
@pytest.mark.parametrize(
    "words", [("render", "g.json", "-o", "b.exr"), ("info", "a.exr"), ("check", "g.json")], ids=" ".join
)
def test_every_limit(tmp_path: Path, words, mebibytes):
    write_picture(tmp_path / "a.exr", np.full((8, 8, 4), 0.5, np.float32))
    nodes = {"r": {"type": "read_image", "values": {"path": "a.exr"}}, "n": {"type": "gaussian_blur"}}
    graph = {"halation": 1, "outputs": {"image": {"type": "Image"}}, "nodes": nodes}
    graph["links"] = {"outputs.image": "n.out", "n.image": "r.out"}
    (tmp_path / "g.json").write_text(json.dumps(graph))
    ended = subprocess.run(
        [sys.executable, "-P", "-m", "halation.cli", *words],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        errors="replace",
        timeout=60,
        preexec_fn=limit(mebibytes),
        env={**os.environ, "LP_NUM_THREADS": "1", "OPENIMAGEIO_THREADS": "1"},
    )
    assert ended.returncode in (0, 1, 5), (ended.returncode, ended.stderr)
    assert "Traceback" not in ended.stderr and "bug in Halation" not in ended.stderr
    if ended.returncode:
        assert sum(line.startswith("halation: ") for line in ended.stderr.splitlines()) == 1, ended.stderr
    assert not [path for path in tmp_path.iterdir() if ".halation-" in path.name]
