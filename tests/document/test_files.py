"""Saving is whole or not at all; groups come from files of their own."""

from __future__ import annotations

import errno
import json
import os
import stat
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from halation.document import FORMAT, dumps, limits, load, loads, save
from halation.errors import DocumentError, OutputError
from halation.graph import Graph, Group
from halation.graph.model import MAX_GROUP_DEPTH
from halation.resources.sandbox import UNRESTRICTED
from toy_nodes import TOYS, Gain, small


def write(path: Path, **sections: Any) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps({"halation": FORMAT, **sections}))
    return path


def group(path: str, **values: float) -> dict[str, Any]:
    return {"type": "group", "path": path} | ({"values": values} if values else {})


class TestSave:
    def test_and_load(self, tmp_path: Path) -> None:
        path = tmp_path / "a b ü.json"
        save(small(), path, sandbox=UNRESTRICTED)
        assert path.read_text("utf-8") == dumps(small())
        assert load(path, TOYS, sandbox=UNRESTRICTED) == small()
        assert load(str(path), TOYS, sandbox=UNRESTRICTED).folder == str(tmp_path)
        assert [*tmp_path.iterdir()] == [path]

    @pytest.mark.parametrize("step", ["fsync", "replace"])
    @pytest.mark.parametrize("error", [OSError(errno.ENOSPC, "No space left on device"), KeyboardInterrupt()])
    def test_a_failure_leaves_the_old_file(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, step: str, error: BaseException
    ) -> None:
        path = tmp_path / "x.json"
        path.write_text("old")

        def fail(*_: Any, **__: Any) -> None:
            raise error

        monkeypatch.setattr(os, step, fail)
        wanted = OutputError if isinstance(error, OSError) else KeyboardInterrupt
        with pytest.raises(wanted) as caught:
            save(small(), path, sandbox=UNRESTRICTED)
        if isinstance(error, OSError):
            assert str(caught.value) == (
                f"{path}: cannot be written: the disk is full: make room or write elsewhere; the old file is unchanged"
            )
        assert path.read_text() == "old"
        assert [*tmp_path.iterdir()] == [path]

    def test_a_killed_process_leaves_the_old_file(self, tmp_path: Path) -> None:
        path = tmp_path / "x.json"
        path.write_text("old")
        code = (
            "import os, sys; from halation.document import save; from halation.graph import Graph\n"
            "from halation.resources.sandbox import UNRESTRICTED\n"
            "os.fsync = lambda handle: os._exit(9)\nsave(Graph(), sys.argv[1], sandbox=UNRESTRICTED)"
        )
        assert subprocess.run([sys.executable, "-c", code, str(path)]).returncode == 9
        assert path.read_text() == "old"

    def test_where_nothing_can_be_written(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        with pytest.raises(OutputError, match=r"x\.json: cannot be written: there is no such folder"):
            save(small(), tmp_path / "no" / "x.json", sandbox=UNRESTRICTED)
        with pytest.raises(OutputError, match=r"cannot be written: no file can have such a name"):
            save(small(), tmp_path / "a\0b", sandbox=UNRESTRICTED)

        def read_only(*_: Any) -> None:
            raise PermissionError(errno.EACCES, "Permission denied")

        monkeypatch.setattr(Path, "open", read_only)
        with pytest.raises(OutputError, match=r"x\.json: cannot be written: the folder may not be written"):
            save(small(), tmp_path / "x.json", sandbox=UNRESTRICTED)

    def test_over_a_folder(self, tmp_path: Path) -> None:
        (tmp_path / "x.json").mkdir()
        with pytest.raises(OutputError, match="is a folder"):
            save(small(), tmp_path / "x.json", sandbox=UNRESTRICTED)
        assert [path.name for path in tmp_path.iterdir()] == ["x.json"]

    def test_a_graph_that_cannot_be_written_touches_nothing(self, tmp_path: Path) -> None:
        path = tmp_path / "x.json"
        path.write_text("old")
        with pytest.raises(Exception, match="nan cannot be saved"):
            save(Graph({"a": Gain(gain=float("nan"))}), path, sandbox=UNRESTRICTED)
        with pytest.raises(OutputError, match="it could not be read again"):
            save(Graph(ui={"x": "y" * limits.MAX_BYTES}), path, sandbox=UNRESTRICTED)
        assert path.read_text() == "old"

    def test_permissions_and_links_stay(self, tmp_path: Path) -> None:
        path, link = tmp_path / "x.json", tmp_path / "link.json"
        path.write_text("old")
        path.chmod(0o640)
        link.symlink_to(path)
        save(small(), link, sandbox=UNRESTRICTED)
        assert link.is_symlink()
        assert load(path, TOYS, sandbox=UNRESTRICTED) == small()
        assert stat.S_IMODE(path.stat().st_mode) == 0o640
        save(small(), tmp_path / "new.json", sandbox=UNRESTRICTED)
        mask = os.umask(0)
        os.umask(mask)
        assert stat.S_IMODE((tmp_path / "new.json").stat().st_mode) == 0o666 & ~mask


class TestGroupFiles:
    def test_paths_start_at_the_file_that_names_them(self, tmp_path: Path) -> None:
        (tmp_path / "lib" / "deep").mkdir(parents=True)
        save(small(), tmp_path / "lib" / "deep" / "small.json", sandbox=UNRESTRICTED)
        write(tmp_path / "lib" / "middle.json", nodes={"s": group("deep/small.json", glow=5.0)})
        top = write(tmp_path / "top.json", nodes={"m": group("lib/middle.json")})
        graph = load(top, TOYS, sandbox=UNRESTRICTED)
        middle = graph.nodes["m"]
        assert isinstance(middle, Group)
        inner = middle.graph.nodes["s"]
        assert isinstance(inner, Group)
        assert inner.graph == small()
        assert inner.body().nodes["gain"] == Gain(gain=5.0)
        assert Path(inner.graph.folder) == tmp_path / "lib" / "deep"
        assert json.loads(dumps(graph)) == {"halation": FORMAT, "nodes": {"m": group("lib/middle.json")}}
        assert loads(top.read_text(), "top.json", str(tmp_path), TOYS, sandbox=UNRESTRICTED) == graph

    def test_a_missing_file_names_both(self, tmp_path: Path) -> None:
        write(tmp_path / "glow.json")
        top = write(tmp_path / "top.json", nodes={"g": group("glwo.json")})
        with pytest.raises(DocumentError) as caught:
            load(top, TOYS, sandbox=UNRESTRICTED)
        assert str(caught.value) == (
            f"{top}: nodes.g.path: the group file '{tmp_path / 'glwo.json'}' does not exist; did you mean 'glow.json'?"
        )

    @pytest.mark.parametrize("path", [".", "a\0b", "x" * 5000])
    def test_a_path_that_is_no_file(self, tmp_path: Path, path: str) -> None:
        with pytest.raises(DocumentError, match=r"nodes\.g\.path: the group file .* does not exist"):
            load(write(tmp_path / "top.json", nodes={"g": group(path)}), TOYS, sandbox=UNRESTRICTED)

    def test_a_fault_inside_names_the_inner_file(self, tmp_path: Path) -> None:
        write(tmp_path / "in.json", nodes={"a": {"type": "gain", "values": {"gain": "x"}}})
        with pytest.raises(DocumentError, match=r"in\.json: nodes\.a\.values\.gain: expected a number"):
            load(write(tmp_path / "top.json", nodes={"g": group("in.json")}), TOYS, sandbox=UNRESTRICTED)

    @pytest.mark.parametrize("through", [["a"], ["a", "b"], ["a", "b", "c"]])
    def test_a_group_cannot_hold_itself(self, tmp_path: Path, through: list[str]) -> None:
        for name, after in zip(through, [*through[1:], through[0]], strict=True):
            inner = {"nodes": {"h": group(f"./{after}.json")}}
            write(tmp_path / f"{name}.json", nodes={"g": {"type": "group", "graph": inner}})
        where = r"nodes\.g\.graph\.nodes\.h\.path"
        with pytest.raises(DocumentError, match=rf"{where}: a group cannot hold itself: a\.json -> .*a\.json"):
            load(tmp_path / "a.json", TOYS, sandbox=UNRESTRICTED)
        top = write(tmp_path / "top.json", nodes={"g": group("a.json")})
        with pytest.raises(DocumentError, match=r"cannot hold itself: a.json -> .*a.json"):
            load(top, TOYS, sandbox=UNRESTRICTED)

    def test_depth_is_limited(self, tmp_path: Path) -> None:
        def files(count: int) -> Path:
            write(tmp_path / "0.json")
            for number in range(1, count + 1):
                write(tmp_path / f"{number}.json", nodes={"g": group(f"{number - 1}.json")})
            return tmp_path / f"{count}.json"

        load(files(MAX_GROUP_DEPTH), TOYS, sandbox=UNRESTRICTED)
        with pytest.raises(DocumentError, match="groups nest deeper than 32"):
            load(files(MAX_GROUP_DEPTH + 1), TOYS, sandbox=UNRESTRICTED)

    def test_a_file_is_read_once_and_bombs_are_refused(self, tmp_path: Path) -> None:
        """Twenty files that each hold the one before twice stand for a million nodes."""
        write(tmp_path / "0.json", nodes={"a": {"type": "gain"}})
        for number in range(1, 21):
            twice = {name: group(f"{number - 1}.json") for name in ("g", "h")}
            write(tmp_path / f"{number}.json", nodes=twice)
        graph = load(tmp_path / "8.json", TOYS, sandbox=UNRESTRICTED)
        assert graph.nodes["g"].graph is graph.nodes["h"].graph
        with pytest.raises(DocumentError, match="more than 100000 nodes"):
            load(tmp_path / "20.json", TOYS, sandbox=UNRESTRICTED)

    def test_what_could_not_be_read_again_is_not_saved(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        """Groups of files are counted as they are now: the file may be missing when the graph is saved."""
        path = tmp_path / "x.json"
        path.write_text("old")
        bodies = Graph({"a": Gain()})
        for _ in range(3):
            bodies = Graph({"g": Group(bodies, "other.json"), "h": Group(bodies, "other.json")})
        monkeypatch.setattr(limits, "MAX_NODES", 14 * limits.GROUP_COST + 8)
        save(bodies, path, sandbox=UNRESTRICTED)
        path.write_text("old")
        monkeypatch.setattr(limits, "MAX_NODES", 14 * limits.GROUP_COST + 7)
        with pytest.raises(OutputError, match="it could not be read again: with all groups"):
            save(bodies, path, sandbox=UNRESTRICTED)
        with pytest.raises(
            OutputError, match=r"it could not be read again: nodes: the key 'k+'\.\.\. has 1,001 characters"
        ):
            save(Graph({"k" * (limits.MAX_KEY + 1): Gain()}), path, sandbox=UNRESTRICTED)
        monkeypatch.setattr(limits, "MAX_LAYOUT", 4)
        with pytest.raises(OutputError, match="it could not be read again: ui: "):
            save(Graph(ui={"nodes": {"a": [1, 2, 3, 4]}}), path, sandbox=UNRESTRICTED)
        assert path.read_text() == "old"

    def test_values_of_a_group_are_typed(self, tmp_path: Path) -> None:
        save(small(), tmp_path / "small.json", sandbox=UNRESTRICTED)
        with pytest.raises(DocumentError, match=r"nodes\.g\.values\.glow: expected a number, got the string"):
            load(
                write(tmp_path / "x.json", nodes={"g": {**group("small.json"), "values": {"glow": "a lot"}}}),
                TOYS,
                sandbox=UNRESTRICTED,
            )
        top = write(tmp_path / "y.json", nodes={"g": group("small.json", glow=3, gone=1)})
        assert load(top, TOYS, sandbox=UNRESTRICTED).nodes["g"].values == {"glow": 3.0}
        assert json.loads(dumps(load(top, TOYS, sandbox=UNRESTRICTED)))["nodes"]["g"] == group(
            "small.json", glow=3.0, gone=1
        )


def test_what_a_killed_process_left_goes_with_the_next_save_of_the_same_file(tmp_path: Path) -> None:
    path = tmp_path / "a[1].json"
    old, fresh, other = (
        tmp_path / f".halation-1-{name}.tmp" for name in ("01-a[1].json", "02-a[1].json", "03-a1.json")
    )
    for left in (old, fresh, other):
        left.write_text("half")
    for left in (old, other):
        os.utime(left, (1.0, 1.0))
    save(small(), path, sandbox=UNRESTRICTED)
    assert sorted(tmp_path.iterdir()) == sorted([path, fresh, other])


def test_a_read_only_file_is_not_replaced(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    save(small(), path, sandbox=UNRESTRICTED)
    path.chmod(0o444)
    with pytest.raises(OutputError, match="read-only"):
        save(Graph(), path, sandbox=UNRESTRICTED)
    assert load(path, TOYS, sandbox=UNRESTRICTED) == small()
