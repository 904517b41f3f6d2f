"""Frames of videos by number, against decoding them one after the other."""

from __future__ import annotations

import random
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from halation.resources.sandbox import UNRESTRICTED

av: Any = pytest.importorskip("av", reason="PyAV is not installed: pip install halation[video]")

from halation import media  # noqa: E402
from halation.errors import InputError  # noqa: E402
from halation.media.video.index import survey_video  # noqa: E402
from halation.media.video.reader import VideoReader, read_frame  # noqa: E402
from halation.nodes import Kind  # noqa: E402
from halation.resources.input_files import fingerprint  # noqa: E402
from videos import bars, decode_frames, number_in, write_frames, write_numbers  # noqa: E402

COUNT = 45
LATE = [sum(1 + 7 * n * n % 97 for n in range(at)) for at in range(COUNT)]
"""Times in milliseconds that lie at uneven distances."""

KINDS: dict[str, tuple[str, str, dict[str, Any]]] = {
    "long.mp4": ("libx264", "yuv420p", {"options": {"g": "250", "bf": "3"}}),
    "open.mp4": ("libx264", "yuv420p", {"options": {"g": "9", "bf": "3", "x264-params": "open-gop=1"}}),
    "uneven.mkv": ("libx264", "yuv420p", {"options": {"g": "12", "bf": "2"}, "times": LATE}),
    "refresh.mp4": ("libx264", "yuv420p", {"options": {"intra-refresh": "1", "g": "15", "bf": "0"}}),
    "open.mov": ("libx265", "yuv420p10le", {"options": {"x265-params": "open-gop=1:keyint=12:log-level=none"}}),
    "tape.mpg": ("mpeg2video", "yuv420p", {"options": {"g": "12", "bf": "2"}}),
    "stream.ts": ("libx264", "yuv420p", {"options": {"g": "10", "bf": "3"}}),
    "web.webm": ("libvpx-vp9", "yuv420p", {"options": {"g": "20", "crf": "20", "b": "0", "cpu-used": "8"}}),
    "hidden.webm": ("libvpx", "yuv420p", {"options": {"auto-alt-ref": "1", "lag-in-frames": "12", "g": "20"}}),
    "old.avi": ("mpeg4", "yuv420p", {"options": {"g": "12", "bf": "2", "q": "2"}}),
    "no_times.avi": ("libx264", "yuv420p", {"options": {"g": "12", "bf": "2"}}),
    "intra.mov": ("prores_ks", "yuv422p10le", {}),
    "runs.mov": ("qtrle", "rgb24", {}),
    "lossless.mkv": ("ffv1", "bgr0", {}),
}


@pytest.fixture(scope="module", params=KINDS)
def video(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    codec, pixels, rest = KINDS[request.param]
    if codec not in av.codecs_available:
        pytest.skip(f"this PyAV has no encoder {codec}")
    return write_numbers(tmp_path_factory.mktemp("videos") / request.param, codec, pixels, COUNT, **rest)


def shown(frame: Any) -> np.ndarray:
    return frame.to_ndarray(format="rgb24")


def test_frames_are_those_of_decoding_from_the_start_in_any_order(video: Path) -> None:
    expected, mark = decode_frames(video), fingerprint(video, sandbox=UNRESTRICTED)
    assert survey_video(str(video), mark, sandbox=UNRESTRICTED)[0].count == len(expected) == COUNT
    order = [*range(1, COUNT + 1)] * 2
    random.Random(7).shuffle(order)
    forgetful = VideoReader(str(video), mark, sandbox=UNRESTRICTED)
    for place, number in enumerate([1, 2, 3, *order]):
        if place % 3:
            forgetful._cache.clear()  # so that it must look for it
            forgetful._cached_bytes = 0
        assert np.array_equal(shown(forgetful.read_frame(number)), expected[number - 1]), number
        assert np.array_equal(
            shown(read_frame(str(video), mark, number, sandbox=UNRESTRICTED)), expected[number - 1]
        ), number


def test_frame_n_shows_n(video: Path) -> None:
    for number in (1, 2, 13, 30, COUNT):
        assert number_in(media.read_layer(video, "", Kind.VECTOR, 3, number, sandbox=UNRESTRICTED).array) == number


def test_a_video_stands_where_a_sequence_does(video: Path) -> None:
    found = media.find_sequence(str(video), sandbox=UNRESTRICTED)
    assert found is not None and found.frames == tuple(range(1, COUNT + 1)) and not found.gaps
    assert found.path(5) == str(video)
    assert media.find_frame_file(str(video), 7, sandbox=UNRESTRICTED).number == 7
    assert [media.find_frame_file(str(video), at, "hold", sandbox=UNRESTRICTED).number for at in (-3, COUNT + 9)] == [
        1,
        COUNT,
    ]
    assert media.find_frame_file(str(video), COUNT + 1, "black", sandbox=UNRESTRICTED).black
    with pytest.raises(InputError, match=f"has no frame {COUNT + 1}, only 1-{COUNT}"):
        media.find_frame_file(str(video), COUNT + 1, sandbox=UNRESTRICTED)
    with pytest.raises(InputError, match="has no frame 0"):
        media.read_layer(video, "", Kind.IMAGE, frame=0, sandbox=UNRESTRICTED)


def test_reading_in_order_decodes_every_frame_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write_numbers(tmp_path / "a.mp4", "libx264", "yuv420p", COUNT, options={"g": "10", "bf": "2"})
    reader, fed = VideoReader(str(path), fingerprint(path, sandbox=UNRESTRICTED), sandbox=UNRESTRICTED), 0
    survey_video(str(path), fingerprint(path, sandbox=UNRESTRICTED), sandbox=UNRESTRICTED)
    real = reader._decode_from

    def counting(index: Any, key: Any) -> Any:
        nonlocal fed
        fed += 1
        return real(index, key)

    monkeypatch.setattr(reader, "_decode_from", counting)
    for number in range(1, COUNT + 1):
        reader.read_frame(number)
    assert fed == 1


def test_what_an_edit_list_cuts_off_is_no_frame(tmp_path: Path) -> None:
    whole = write_numbers(tmp_path / "whole.mp4", "libx264", "yuv420p", COUNT, options={"g": "30", "bf": "0"})
    cut = tmp_path / "cut.mp4"
    with av.open(str(whole)) as source, av.open(str(cut), "w", options={"avoid_negative_ts": "disabled"}) as target:
        stream = target.add_stream_from_template(source.streams.video[0])
        step = round(1 / (24 * source.streams.video[0].time_base))
        for packet in source.demux(video=0):
            if packet.dts is not None:
                packet.pts, packet.dts, packet.stream = packet.pts - 7 * step, packet.dts - 7 * step, stream
                target.mux(packet)
    expected = decode_frames(cut)
    assert len(expected) < COUNT
    facts, index = survey_video(str(cut), fingerprint(cut, sandbox=UNRESTRICTED), sandbox=UNRESTRICTED)
    assert facts.count == len(expected) and index.times
    for number in (len(expected), 1, 20, 2):
        assert np.array_equal(
            shown(read_frame(str(cut), fingerprint(cut, sandbox=UNRESTRICTED), number, sandbox=UNRESTRICTED)),
            expected[number - 1],
        )
    assert number_in(expected[0]) == 8


def test_facts_are_those_of_the_file(tmp_path: Path) -> None:
    color = {"colorspace": 9, "color_range": 1, "color_primaries": 9, "color_trc": 16}
    path = write_numbers(tmp_path / "a.mkv", "ffv1", "yuv420p10le", 10, rate=25, color=color)
    facts, _ = survey_video(str(path), fingerprint(path, sandbox=UNRESTRICTED), sandbox=UNRESTRICTED)
    assert (facts.size, facts.count, facts.rate, facts.seconds) == ((80, 32), 10, Fraction(25), 0.4)
    assert (facts.codec, facts.pixels, facts.bits, facts.alpha) == ("ffv1", "yuv420p10le", 10, False)
    assert (facts.matrix, facts.range, facts.primaries, facts.transfer) == (9, 1, 9, 16)
    info = media.read_info(path, sandbox=UNRESTRICTED)
    assert info.size == (80, 32) and info.layers[0].channels == ("R", "G", "B")


@pytest.mark.parametrize("turn", [90, 180, 270])
def test_a_picture_that_was_filmed_upright_is_upright(tmp_path: Path, turn: int) -> None:
    import cv2

    path = write_numbers(tmp_path / "phone.mp4", "libx264", "yuv420p", 3, rotation=turn, options={"crf": "1"})
    other = cv2.VideoCapture(str(path))
    other.set(cv2.CAP_PROP_ORIENTATION_AUTO, 1)
    _, expected = other.read()
    found = media.read_layer(path, "", Kind.VECTOR, 3, 1, sandbox=UNRESTRICTED).array
    assert media.read_info(path, sandbox=UNRESTRICTED).size == found.shape[1::-1]
    assert found.shape == expected.shape
    assert np.abs(found - expected[..., ::-1] / 255.0).max() < 0.05


@pytest.mark.parametrize(
    ("name", "codec", "pixels"),
    [
        ("a.mov", "prores_ks", "yuva444p10le"),
        ("a.mov", "qtrle", "argb"),
        ("a.mkv", "ffv1", "bgra"),
        ("a.webm", "libvpx-vp9", "yuva420p"),
    ],
)
def test_transparency_is_kept(tmp_path: Path, name: str, codec: str, pixels: str) -> None:
    straight = np.full((32, 64, 4), 200, np.uint8)
    straight[..., 3] = np.linspace(0, 255, 64).astype(np.uint8)
    frame = av.VideoFrame.from_ndarray(straight, "rgba").reformat(format=pixels)
    tags = {"alpha_mode": "1"} if name.endswith("webm") else {}
    options = {"profile": "4"} if codec == "prores_ks" else {"crf": "4", "b": "0"} if "vp9" in codec else {}
    path = write_frames(tmp_path / name, [frame, frame], codec, options=options, tags=tags)
    assert media.read_info(path, sandbox=UNRESTRICTED).layers[0].channels == ("R", "G", "B", "A")
    found = media.read_layer(path, "", Kind.IMAGE, frame=2, sandbox=UNRESTRICTED).array
    assert np.abs(found[..., 3] - straight[..., 3] / 255.0).max() < 0.02
    solid = found[:, 32:]
    light = ((200 / 255 + 0.055) / 1.055) ** 2.4
    assert np.abs(solid[..., :3] / solid[..., 3:] - light).max() < 0.02  # premultiplied in here, straight in there


def test_what_is_no_video_says_so(tmp_path: Path) -> None:
    path = tmp_path / "a.mp4"
    with pytest.raises(InputError, match="there is no such file"):
        media.read_info(path, sandbox=UNRESTRICTED)
    path.write_bytes(b"")
    with pytest.raises(InputError, match="is empty"):
        media.read_info(path, sandbox=UNRESTRICTED)
    path.write_bytes(random.Random(1).randbytes(3000))
    with pytest.raises(InputError, match="is no video, or is cut short"):
        media.read_info(path, sandbox=UNRESTRICTED)
    good = write_numbers(tmp_path / "good.mp4", "libx264", "yuv420p", 20)
    path.write_bytes(good.read_bytes()[: good.stat().st_size // 2])
    with pytest.raises(InputError, match="is no video, or is cut short"):
        media.find_sequence(str(path), sandbox=UNRESTRICTED)


def test_without_pyav_there_is_a_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from halation.media.video import index

    path = write_numbers(tmp_path / "a.mkv", "ffv1", "bgr0", 2)
    monkeypatch.setattr(index, "load_pyav", lambda: None)
    with pytest.raises(InputError, match=r"a\.mkv: videos need PyAV: pip install halation\[video\]"):
        media.read_info(path, sandbox=UNRESTRICTED)


def test_pictures_are_what_was_drawn(tmp_path: Path) -> None:
    path = write_numbers(tmp_path / "a.mkv", "ffv1", "bgr0", 3)
    read = media.read_layer(path, "", Kind.VECTOR, 3, 3, sandbox=UNRESTRICTED).array
    assert np.array_equal(np.rint(read * 255.0), bars(3))
