"""`halation watch`, as a process of its own: it renders again when what the picture is made of changes."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
import time
from contextlib import contextmanager
from queue import Empty, Queue

import numpy as np
import pytest
from exr_files import read, write_exr

PATIENCE = 60.0
BODY = {
    "halation": 1,
    "inputs": {"image": {"type": "Image"}},
    "outputs": {"image": {"type": "Image"}},
    "nodes": {"more": {"type": "exposure", "values": {"stops": 1.0}}},
    "links": {"more.image": "inputs.image", "outputs.image": "more.out"},
}
CODE = "vec4 twice(vec4 image) { return image * 2.0; }\n"

pytestmark = pytest.mark.skipif(os.name == "nt", reason="POSIX signals")


class Watching:
    """What a process says, line by line."""

    def __init__(self, process):
        self.process, self._lines = process, Queue()
        self.thread = threading.Thread(target=self._follow, daemon=True)
        self.thread.start()

    def _follow(self):
        for line in self.process.stdout:
            self._lines.put(json.loads(line))

    def turn(self):
        return self._lines.get(timeout=PATIENCE)

    def until(self, good):
        """The first turn that is good: a change may be seen in two parts."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            if good(found := self.turn()):
                return found
        raise AssertionError("no such turn came")

    def quiet(self, seconds=1.0):
        with pytest.raises(Empty):
            self._lines.get(timeout=seconds)


@contextmanager
def watching(graph, *words, end=signal.SIGINT):
    command = [sys.executable, "-m", "halation.cli", "watch", graph, *words, "--json"]
    with subprocess.Popen(
        [str(word) for word in command],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "LP_NUM_THREADS": "1"},
    ) as process:
        watch = Watching(process)
        try:
            yield watch
            process.send_signal(end)
            said = process.stderr.read()
            assert process.wait(PATIENCE) == 130 and said.endswith("interrupted; no unfinished file is left\n")
        finally:
            process.kill()
            watch.thread.join()


def changed(path, text):
    """Written as editors do: whole, under another name, then renamed."""
    part = path.with_name(f"{path.name}.part")
    part.write_text(text)
    part.replace(path)


def red(path):
    return float(read(path)[3, 47, 0])


def test_everything_that_a_picture_is_made_of(graphs, shot, tmp_path):
    """The graph, a group that was missing, code, an input that comes and goes; what is broken is waited for."""
    out, body, code = tmp_path / "out.exr", tmp_path / "body.json", tmp_path / "twice.glsl"
    nodes = {"group": {"type": "group", "path": "body.json"}, "code": {"type": "glsl", "file": "twice.glsl"}}
    links = {"group.image": "light.out", "code.image": "group.image", "outputs.image": "code.out"}
    path = graphs(nodes=nodes, links=links)
    code.write_text(CODE)
    tree = json.loads(path.read_text())
    with watching(path, "-o", out) as watch:
        assert "body.json" in watch.turn()["error"]["message"], "the group's file is not there yet"
        body.write_text(json.dumps(BODY))
        assert watch.until(lambda turn: "written" in turn)["changed"] == [str(body)]
        assert red(out) == 8.0

        tree["nodes"]["light"]["values"]["stops"] = 0.0
        changed(path, json.dumps(tree))
        assert watch.turn()["written"] == [str(out)] and red(out) == 4.0

        changed(path, '{"halation": 1,')
        assert "not valid JSON" in watch.turn()["error"]["message"] and red(out) == 4.0
        changed(path, json.dumps(tree))
        assert "written" in watch.turn()

        changed(body, json.dumps({**BODY, "nodes": {"more": {"type": "exposure", "values": {"stops": 2.0}}}}))
        assert watch.turn()["changed"] == [str(body)] and red(out) == 8.0

        changed(code, CODE.replace("2.0", "3.0"))
        assert watch.turn()["changed"] == [str(code)] and red(out) == 12.0
        changed(code, CODE.replace("2.0", "nothing"))
        assert "twice.glsl" in watch.turn()["error"]["message"] and red(out) == 12.0
        changed(code, CODE)
        assert "written" in watch.turn() and red(out) == 8.0

        away = shot.rename(tmp_path / "away.exr")
        assert watch.turn()["error"]["exit_code"] == 4
        away.rename(shot)
        assert "written" in watch.turn()
        write_exr(shot, {"Combined": np.full((32, 48, 4), 0.25, np.float32)}, {"Combined": "half"})
        watch.until(lambda turn: "written" in turn and red(out) == 2.0)
        watch.quiet()


def test_a_burst_of_changes_is_one_turn(graphs, tmp_path):
    out, path = tmp_path / "out.exr", graphs()
    tree = json.loads(path.read_text())
    with watching(path, "-o", out, end=signal.SIGTERM) as watch:
        assert "written" in watch.turn()
        for stops in range(20):
            tree["nodes"]["light"]["values"]["stops"] = stops / 10.0
            changed(path, json.dumps(tree))
            time.sleep(0.02)
        turns = 1
        while abs(red(out) - 2.0**1.9) > 1e-2:
            assert "written" in watch.turn()
            turns += 1
        watch.quiet()
        assert turns < 8


def test_options_that_make_no_sense_end_it(fails, graphs, tmp_path):
    out = tmp_path / "fresh.exr"
    assert "standard input cannot be watched" in fails(2, "watch", "-", "-o", out)
    assert "no value 'stosp'" in fails(2, "watch", graphs(), "-o", out, "--set", "light.stosp=1")
    assert "cannot write '.xyz'" in fails(2, "watch", graphs(), "-o", tmp_path / "out.xyz")
    assert "this file is read by 'beauty'" in fails(2, "watch", graphs(), "-o", tmp_path / "shot.exr")
