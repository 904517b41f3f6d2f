"""`halation serve` and `hal.connect`: a warm process that answers other programs."""

from __future__ import annotations

import json
import os
import socket
import stat
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import halation as hal
import numpy as np
import OpenImageIO as oiio
import pytest
from exr_files import write_exr
from halation import document
from halation.errors import RenderError
from halation.resources.sandbox import UNRESTRICTED
from halation.scripting.packed_arrays import pack_array, read_pictures, unpack_array, write_message

POSIX = pytest.mark.skipif(not hasattr(socket, "AF_UNIX"), reason="this system has no local sockets")
BLUR = {
    "nodes": {"light": {"type": "exposure"}, "blur": {"type": "gaussian_blur"}},
    "links": {"blur.image": "light.out", "outputs.image": "blur.out"},
}
ENDLESS = {
    "nodes": {"light": {"type": "exposure"}, "trail": {"type": "frame_blend"}},
    "links": {"trail.image": "light.out", "outputs.image": "trail.out"},
    "settings": {"frames": [1, 90_000]},
}
"""Its last frame needs 90,000 frames before it, which take minutes."""


@contextmanager
def started(folder: Path, *words: str) -> Iterator[tuple[Path, subprocess.Popen[str]]]:
    """A server at a socket."""
    path = folder / "server"
    command = [sys.executable, "-m", "halation.cli", "serve", "--socket", str(path), *words]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        line = process.stderr.readline()
        assert line.endswith(f"ready at {path}\n"), line
        try:
            yield path, process
        finally:
            process.terminate()
            process.wait(30)


@pytest.fixture
def server(tmp_path) -> Iterator[Path]:
    with started(tmp_path, "--limit", "20", "--max-pixels", "1000000") as (path, _):
        yield path


class Wire:
    """A client that speaks lines."""

    def __init__(self, path: Path) -> None:
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.settimeout(60)
        self.socket.connect(str(path))
        self.replies = self.socket.makefile("rb")

    def send(self, *requests: object) -> None:
        for request in requests:
            line = request if isinstance(request, bytes) else json.dumps(request).encode()
            self.socket.sendall(line + b"\n")

    def read(self) -> dict:
        return json.loads(self.replies.readline())

    def close(self) -> None:
        self.replies.close()
        self.socket.close()


@pytest.fixture
def wire(server) -> Iterator[Wire]:
    wire = Wire(server)
    yield wire
    wire.close()


@POSIX
def test_pixels_are_those_of_render(server, graphs):
    path, values = graphs(**BLUR), {"blur.sigma": 3.0, "light.stops": 1.5}
    with hal.connect(server) as connection:
        for options in ({}, {"size": (24, 16)}, {"scale": 0.5}, {"node": "light"}, {"precision": "float"}):
            pictures = connection.render(path, values=values, **options)
            wanted = hal.render(hal.load(path), values=values, **options)
            assert set(pictures) == set(wanted)
            for name, picture in pictures.items():
                np.testing.assert_array_equal(picture, wanted[name])


@POSIX
def test_arrays_graphs_and_presets_are_sent(server, graphs):
    graph, picture = hal.load(graphs(**BLUR)), np.random.default_rng(1).random((9, 14, 4), np.float32)
    with hal.connect(server) as connection:
        for whole in (graph, "dreamy_glow"):
            loaded = hal.load(whole) if isinstance(whole, str) else whole
            name = next(iter(loaded.inputs))
            received = connection.render(whole, {name: picture})["image"]
            np.testing.assert_array_equal(received, hal.render(loaded, {name: picture})["image"])


@POSIX
def test_files_are_those_of_the_command(server, cli, graphs, tmp_path):
    path = graphs(**BLUR)
    with hal.connect(server) as connection:
        assert connection.render(path, output=tmp_path / "served.png", values={"light.stops": 0.5}) == {}
    assert cli("render", path, "-o", tmp_path / "single.png", "--set", "light.stops=0.5").code == 0
    assert (tmp_path / "served.png").read_bytes() == (tmp_path / "single.png").read_bytes()


@POSIX
def test_a_thumbnail_is_a_small_picture_of_the_render(server, graphs, tmp_path):
    path = graphs(**BLUR)
    with hal.connect(server) as connection:
        (tmp_path / "small.png").write_bytes(connection.make_thumbnail(path, width=12, view="none"))
    small = oiio.ImageBuf(str(tmp_path / "small.png")).get_pixels(oiio.FLOAT)
    assert small.shape[:2] == (8, 12)
    light = np.where(small <= 0.04045, small / 12.92, ((small + 0.055) / 1.055) ** 2.4)[..., :3]
    full = hal.render(hal.load(path))["image"][..., :3].reshape(8, 4, 12, 4, 3).mean((1, 3))
    assert np.abs(light - np.clip(full, 0.0, 1.0)).mean() < 0.02


@POSIX
def test_explain_and_check_say_what_the_commands_say(server, cli, graphs):
    path = graphs(nodes={"light": {"type": "exposure", "values": {"stopps": 1.0}}})
    with hal.connect(server) as connection:
        plan = connection.ask("explain", graphs("plain.json", **BLUR))["plan"]
        problems = connection.ask("check", path)["problems"]
        inside = connection.ask("check", document.loads(path.read_text(), sandbox=UNRESTRICTED))["problems"]
    wanted = cli("explain", graphs("plain.json", **BLUR), "--json").json
    assert len(plan["passes"]) == len(wanted["passes"]) and plan["outputs"] == wanted["outputs"]
    assert problems == cli("check", path, "--json").json["graphs"][0]["problems"]
    assert {problem["rule"] for problem in problems} >= {"unknown-key"} and inside


WRONG = (
    (b"{", "UsageError", "the line is not a request"),
    (b"[1, 2]", "UsageError", "the line is not a request"),
    ({"do": "dance", "id": 4}, "UsageError", "the line is not a request"),
    ({"do": "render", "id": 4}, "UsageError", "name a graph file or a preset"),
    ({"do": "render", "id": 4, "graph": "none.json"}, "DocumentError", "there is no such file"),
    ({"do": "render", "id": 4, "graph": {"halation": 1, "nodes": 3}}, "DocumentError", "nodes"),
    ({"do": "render", "id": 4, "graph": "PATH", "scale": 2.0}, "UsageError", "above 0 and up to 1"),
    ({"do": "render", "id": 4, "graph": "PATH", "size": [4000, 4000]}, "UsageError", "more than the 1,000,000"),
    ({"do": "render", "id": 4, "graph": "PATH", "set": {"no.value": 1}}, "GraphError", "no"),
    ({"do": "render", "id": 4, "graph": "PATH", "input": {"beauty": {"shape": [1]}}}, "UsageError", "not an array"),
    ({"do": "thumbnail", "id": 4, "graph": "PATH", "width": 9000}, "UsageError", "1 to 2048 pixels"),
    ({"do": "render", "id": 4, "graph": "PATH", "output": {"": "no/such/a.png"}}, "OutputError", "create it first"),
)


@POSIX
def test_what_is_wrong_is_said_and_the_server_goes_on(wire, graphs):
    path = str(graphs())
    for request, kind, words in WRONG:
        if isinstance(request, dict) and request.get("graph") == "PATH":
            request = {**request, "graph": path}
        wire.send(request, {"do": "check", "id": "after", "graph": path})
        replies = {reply["id"]: reply for reply in (wire.read(), wire.read())}
        error = replies[4 if isinstance(request, dict) else None]["error"]
        assert error["kind"] == kind and words in error["message"] and "\n" not in error["message"], request
        assert "problems" in replies["after"]


@POSIX
def test_a_request_that_takes_too_long_is_ended(tmp_path, graphs):
    with started(tmp_path, "--limit", "2") as (path, _), hal.connect(path) as connection:
        with pytest.raises(RenderError, match=r"takes more than 2 seconds: render a smaller picture"):
            connection.render(graphs(**ENDLESS), frame=90_000)
        assert connection.render(graphs(**ENDLESS), frame=1)["image"].shape == (32, 48, 4)


def slow_graph() -> dict:
    """A graph whose code does not end in time."""
    loops = "for (int i = 0; i < 100000; i++) for (int j = 0; j < 100000; j++)"
    code = ["vec4 f(vec4 image) {", f"float x = image.r; {loops} x = fract(sin(x + i) * j);", "return image * x;", "}"]
    nodes = {"light": {"type": "exposure"}, "slow": {"type": "glsl", "code": code}}
    return {"nodes": nodes, "links": {"slow.image": "light.out", "outputs.image": "slow.out"}}


@POSIX
@pytest.mark.skipif(sys.platform != "linux", reason="fork and SIGKILL")
def test_a_server_begins_again_after_code_that_does_not_end(tmp_path, graphs):
    """It is the code of one client; others connect again and go on."""
    slow = slow_graph()
    with started(tmp_path, "--timeout", "1") as (path, process):
        assert process.stderr is not None
        for _ in range(2):
            hostile = Wire(path)
            hostile.send({"do": "render", "id": 1, "graph": str(graphs(**slow)), "size": [512, 512]})
            assert hostile.replies.readline() == b""
            hostile.close()
            lines = [process.stderr.readline(), process.stderr.readline()]
            assert "its code has not ended after 1 seconds" in lines[0] and "the server begins again" in lines[0], lines
            assert lines[1].endswith(f"ready at {path}\n"), lines
            with hal.connect(path) as connection:
                assert connection.render(graphs(**BLUR))["image"].shape == (32, 48, 4)


@POSIX
def test_a_request_is_cancelled(wire, graphs):
    path = str(graphs(**ENDLESS))
    wire.send(
        {"do": "render", "id": "long", "graph": path, "frame": 90_000},
        {"do": "check", "id": "waits", "graph": path},
        {"do": "cancel", "request": "waits"},
        {"do": "cancel", "request": "long"},
        {"do": "check", "id": "last", "graph": path},
    )
    replies = [wire.read() for _ in range(3)]
    assert {reply["id"] for reply in replies if reply.get("cancelled")} == {"long", "waits"}
    assert "problems" in replies[-1]


@POSIX
def test_a_client_that_goes_away_cancels_its_work(server, graphs):
    gone = Wire(server)
    path = str(graphs(**ENDLESS))
    gone.send(*({"do": "render", "id": number, "graph": path, "frame": 90_000} for number in range(50)))
    gone.close()
    stays = Wire(server)
    stays.send({"do": "check", "id": 1, "graph": path})
    assert "problems" in stays.read()  # fifty requests of twenty seconds would be longer than it waits
    stays.close()


@POSIX
def test_many_clients_get_their_own_replies(server, graphs):
    path = str(graphs())
    wires = [Wire(server) for _ in range(8)]
    for number, wire in enumerate(wires):
        wire.send(*({"do": "render", "id": f"{number}.{turn}", "graph": path, "set": {"light.stops": number}}
                    for turn in range(3)))  # fmt: skip
    for number, wire in enumerate(wires):
        for turn in range(3):
            reply = wire.read()
            assert reply["id"] == f"{number}.{turn}"
            assert unpack_array("image", reply["pictures"]["image"])[0, 0, 1] == 0.25 * 2.0**number
        wire.close()


@POSIX
def test_nothing_outside_of_the_root_is_read(tmp_path, graphs):
    (tmp_path / "fence").mkdir()
    outside = graphs()
    inside = graphs("fence/inside.json", inputs={"beauty": {"type": "Image", "file": "../shot.exr"}})
    with started(tmp_path / "fence", "--root", str(tmp_path / "fence")) as (path, _), hal.connect(path) as connection:
        for graph in (outside, inside):
            with pytest.raises(hal.HalationError, match="lies outside of"):
                connection.render(graph)
        # Nor may the server write into the file of the client, so that pixels come as text.
        graph, picture = hal.load(outside), np.random.default_rng(4).random((9, 14, 4), np.float32)
        received = connection.render(graph, {"beauty": picture})["image"]
        np.testing.assert_array_equal(received, hal.render(graph, {"beauty": picture})["image"])
        picture = write_exr(
            tmp_path / "fence" / "a.exr", {"Combined": np.ones((4, 4, 4), np.float32)}, {"Combined": "half"}
        )
        assert connection.render(inside, {"beauty": picture})["image"].shape == (4, 4, 4)
        with pytest.raises(hal.HalationError, match="lies outside of"):
            connection.render(inside, {"beauty": picture}, output=tmp_path / "out.exr")


@POSIX
def test_only_the_user_connects_and_one_server_listens(tmp_path):
    with started(tmp_path) as (path, _):
        assert stat.S_IMODE(path.stat().st_mode) == 0o600
        command = [sys.executable, "-m", "halation.cli", "serve", "--socket", str(path)]
        refused = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
        assert refused.returncode == 1 and "another process listens here" in refused.stderr
        with hal.connect(path) as connection:  # the refused one leaves the socket where it is
            assert connection.ask("check", "soft_bloom")["exit_code"] == 0
    with started(tmp_path) as (path, process):
        process.kill()
        process.wait(30)
        assert path.is_socket()
        with pytest.raises(RenderError, match="start one with halation serve"):
            while True:  # the process that rendered ends a moment after the one that was killed
                hal.connect(path).close()
    with started(tmp_path) as (path, process):  # what a killed server has left is replaced
        process.terminate()
        assert process.wait(30) == 0 and not path.exists()


@POSIX
@pytest.mark.parametrize("kind", ["file", "FIFO", "folder", "link"])
def test_what_is_there_is_not_lost_for_a_socket(tmp_path, kind):
    path, other = tmp_path / "server", tmp_path / "other"
    other.write_text("precious")
    {
        "file": lambda: path.write_text("precious"),
        "FIFO": lambda: os.mkfifo(path),
        "folder": path.mkdir,
        "link": lambda: path.symlink_to(other),
    }[kind]()
    before = path.lstat()
    command = [sys.executable, "-m", "halation.cli", "serve", "--socket", str(path)]
    refused = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert refused.returncode == 1 and "the socket cannot be created" in refused.stderr
    after = path.lstat()
    assert (after.st_mode, after.st_ino, after.st_size) == (before.st_mode, before.st_ino, before.st_size)
    assert other.read_text() == "precious"


def test_lines_on_standard_input_are_answered_on_standard_output(graphs):
    path = str(graphs())
    requests = [{"do": name, "id": name, "graph": path} for name in ("check", "render", "explain")]
    result = subprocess.run(
        [sys.executable, "-m", "halation.cli", "serve", "--form", "fragment", "--memory", "32K"],
        input="\n".join(map(json.dumps, requests)).encode(),
        capture_output=True,
        check=True,
        timeout=120,
    )
    replies = {reply["id"]: reply for reply in map(json.loads, result.stdout.splitlines())}
    assert {problem["rule"] for problem in replies["check"]["problems"]} == {"not-canonical"}
    assert unpack_array("image", replies["render"]["pictures"]["image"]).shape == (32, 48, 4)
    plan = replies["explain"]["plan"]
    assert (plan["form"], plan["why"]) == ("fragment", "asked for") and plan["tiles"]


@pytest.mark.skipif(sys.platform != "linux", reason="fork and SIGKILL")
def test_code_that_does_not_end_costs_one_request_of_a_stream(graphs):
    """The process that answers is replaced, and what waits is answered by the next."""
    fast, slow = str(graphs()), str(graphs("slow.json", **slow_graph()))
    requests = [
        {"do": "render", "id": "a", "graph": slow, "size": [512, 512]},
        {"do": "render", "id": "b", "graph": fast},
        {"do": "render", "id": "c", "graph": slow, "size": [512, 512]},
        {"do": "check", "id": "d", "graph": slow},
        {"do": "render", "id": "e", "graph": fast},
        {"do": "cancel", "request": "e"},
        {"do": "dance", "id": "f"},
    ]
    result = subprocess.run(
        [sys.executable, "-m", "halation.cli", "serve", "--timeout", "1"],
        input="\n".join(map(json.dumps, requests)).encode(),
        capture_output=True,
        check=True,
        timeout=200,
    )
    replies = {reply["id"]: reply for reply in map(json.loads, result.stdout.splitlines())}
    assert sorted(replies) == ["a", "b", "c", "d", "e", "f"]
    for name in "ac":
        error = replies[name]["error"]
        assert (error["kind"], error["exit_code"]) == ("DeviceError", 5)
        assert "node 'slow'" in error["message"] and "has not ended after 1 seconds" in error["message"]
    assert unpack_array("image", replies["b"]["pictures"]["image"]).shape == (32, 48, 4)
    assert "problems" in replies["d"] and replies["e"]["cancelled"] is True
    assert "not a request" in replies["f"]["error"]["message"]
    assert result.stderr.decode().count("the server begins again") == 2


def test_a_request_of_many_megabytes_arrives_whole(graphs):
    """It is more than a pipe holds, so it is passed on in parts, as its reply is."""
    picture = np.random.default_rng(1).random((512, 1024, 4), np.float32)
    with hal.connect() as connection:
        graph = hal.load(graphs())
        for _ in range(2):
            reply = connection.ask("render", graph, {"beauty": picture}, values={"light.stops": 1.0}, precision="float")
            received = unpack_array("image", reply["pictures"]["image"])
            np.testing.assert_allclose(received[..., :3], 2.0 * picture[..., :3], rtol=1e-5)


def test_a_process_of_its_own_ends_with_the_connection(graphs):
    with hal.connect() as connection:
        assert connection.render(graphs())["image"].shape == (32, 48, 4)
    with pytest.raises(RenderError, match="has ended the connection"):
        connection.render(graphs())


def test_an_array_comes_back_as_it_was_sent():
    for dtype in (np.float16, np.float32):
        array = np.random.default_rng(2).normal(size=(3, 5, 4)).astype(dtype)
        line = write_message({"pictures": {"a": pack_array(array[:, ::-1])}})
        packed = json.loads(line)["pictures"]["a"]
        received = unpack_array("a", packed)
        assert received.dtype == dtype and (received == array[:, ::-1]).all()
        pictures = read_pictures(line)
        assert pictures is not None and pictures["a"].dtype == dtype and (pictures["a"] == received).all()
    # A name that is not UTF-8 is written by the other way, to the same text.
    assert json.loads(
        write_message({"id": "\udcff", "pictures": {"a": pack_array(array)}}).decode("utf-8", "surrogateescape")
    )["pictures"] == {"a": json.loads(write_message({"pictures": {"a": pack_array(array)}}))["pictures"]["a"]}
    assert read_pictures(b'{"id": 1, "error": {}}') is None
