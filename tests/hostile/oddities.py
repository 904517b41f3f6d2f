"""Files that no mutation makes: bombs, heads that promise gigabytes, odd names; each by each command.

A row is a name, what lies in the folder, and a graph that reads it. All that fits into a line stands here in full.
"""

from __future__ import annotations

import json
import struct
import zlib
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from random import Random

from cases import Case
from halation.nodes import catalogue
from jails import Tree, make_special, wrap_node

Files = dict[str, bytes]
Row = tuple[str, Files, Tree | bytes]

MANY = 2_000_000_000
CLF = '<?xml version="1.0"?>{}<ProcessList id="a" compCLFversion="3">{}'
NAMES = (
    "a\0b.exr", "\u202egnp.exr", "a\nb.exr", "\ud800x.exr", "\x1b[31mred.exr", "~/x.exr", "$HOME/x.exr", "%n%s.exr",
    "http://127.0.0.1:1/x.exr", "file:///etc/passwd", "a" * 5000 + ".exr", "//etc/passwd", "./" * 2000 + "x.exr",
    "x.#########.exr", "x.%999999999d.exr", "{0}.exr", "-.exr", "con.exr", "'\"><script>.exr", "fifo.exr", "socket.exr",
    "device.exr", "fifolink.exr", "folder.exr", "loop.exr", "/proc/self/environ", "/proc/self/mem", "/dev/stdin",
)  # fmt: skip
"""Names of pictures: what a shell, a terminal, a page or a system reads as something else."""

IDS = ("\u202eabc", "a\0b", "x" * 999, "\U0001f600", "e\u0301", "__class__", "%s%n", "{0}", "</script>", "'", '"', "\n")

TABLES: dict[str, bytes] = {
    "nan.cube": b"LUT_3D_SIZE 2\n" + b"nan nan nan\n" * 8,
    "infinite.cube": b"LUT_1D_SIZE 2\n1e999 0 0\n-1e999 1 1\n",
    "huge.cube": b"LUT_3D_SIZE 100000\n0 0 0\n",
    "negative.cube": b"LUT_3D_SIZE -2\n0 0 0\n",
    "long.cube": b"LUT_1D_SIZE 2000000000\n0 0 0\n",
    "line.cube": b"TITLE " + b"a" * 2_000_000,
    "deep.clf": CLF.format("", '<ProcessList id="a" compCLFversion="3">' * 20_000).encode(),
    "doubling.clf": CLF.format(
        '<!DOCTYPE l [<!ENTITY a0 "aaaaaaaaaa">'
        + "".join(f'<!ENTITY a{n} "{f"&a{n - 1};" * 10}">' for n in range(1, 12))
        + "]>",
        "<Description>&a11;</Description></ProcessList>",
    ).encode(),
    "entity.clf": CLF.format(
        '<!DOCTYPE l [<!ENTITY x SYSTEM "file:///etc/passwd">]>', "<Description>&x;</Description></ProcessList>"
    ).encode(),
    "itself.ctf": b'<ProcessList version="1.3" id="x"><Reference path="itself.ctf"/></ProcessList>',
    "many.clf": CLF.format(
        "", '<Matrix inBitDepth="32f" outBitDepth="32f"><Array dim="3 3">1</Array></Matrix>' * 9000
    ).encode(),
    "long.spi1d": b"Version 1\nFrom 0 1\nLength 2000000000\nComponents 3\n{\n",
    "huge.spi3d": b"SPILUT 1.0\n3 3\n60000 60000 60000\n0 0 0 0 0 0\n",
    "rows.3dl": b"0 1\n" * 100_000,
    "begun.csp": b"CSPLUTV100\n3D\n\nBEGIN METADATA\n",
    "empty.cube": b"",
    "zeros.lut": b"\0" * 100_000,
}

CONFIGS: dict[str, bytes] = {
    "outside.ocio": b"ocio_profile_version: 2\nsearch_path: /etc:..\nroles: {default: a}\n"
    b"displays: {d: [!<View> {name: v, colorspace: a}]}\ncolorspaces:\n"
    b"  - !<ColorSpace> {name: a, from_scene_reference: !<FileTransform> {src: ../secret.txt}}\n",
    "doubling.ocio": b"a0: &a0 [x,x,x,x,x,x,x,x,x]\n"
    + b"".join(b"a%d: &a%d [%s]\n" % (n, n, b",".join([b"*a%d" % (n - 1)] * 9)) for n in range(1, 9))
    + b"ocio_profile_version: 2\n",
    "deep.ocio": b"ocio_profile_version: 2\nx: " + b"[" * 100_000,
    "roles.ocio": b"ocio_profile_version: 2\nroles: {default: a}\ncolorspaces:\n"
    + b"".join(b"  - !<ColorSpace> {name: s%d}\n" % n for n in range(20_000)),
    "itself.ocio": b"ocio_profile_version: 2\nroles: {default: a}\ncolorspaces:\n"
    b"  - !<ColorSpace> {name: a, from_scene_reference: !<ColorSpaceTransform> {src: a, dst: a}}\n",
    "empty.ocio": b"",
    "zip.ocioz": b"PK\3\4" + b"\0" * 60,
}

GLTF = {"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "children": [0]}]}
MESHES: dict[str, bytes] = {
    "index.obj": b"v 0 0 0\nf 1 2 99999999\n",
    "negative.obj": b"v 0 0 0\nf -1 -2 -3\n",
    "nan.obj": b"v nan inf 1e400\nv 0 0 0\nv 1 1 1\nf 1 2 3\n",
    "material.obj": b"mtllib ../secret.txt\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl x\nf 1 2 3\n",
    "fan.obj": b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf " + b"1 2 3 " * 100_000 + b"\n",
    "count.stl": b"\0" * 80 + struct.pack("<I", 0xFFFFFFFF),
    "count.ply": b"ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n",
    "list.ply": b"ply\nformat binary_little_endian 1.0\nelement face 1\n"
    b"property list uint int vertex_indices\nend_header\n" + struct.pack("<I", 0xFFFFFFFF),
    "loop.gltf": json.dumps(
        GLTF
        | {
            "buffers": [{"uri": "../secret.txt", "byteLength": 10**12}],
            "bufferViews": [{"buffer": 0, "byteLength": 10**12}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 10**10, "type": "VEC3"}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        }
    ).encode(),
    "data.gltf": json.dumps(
        GLTF | {"buffers": [{"uri": "data:;base64," + "A" * 100, "byteLength": -5}], "meshes": [{"primitives": []}]}
    ).encode(),
    "length.glb": b"glTF" + struct.pack("<II", 2, 0xFFFFFFFF),
    "layers.usda": b"#usda 1.0\n(\n subLayers = [@/etc/passwd@]\n)\n",
    "empty.obj": b"",
}

FUNCTION = "vec4 f(vec4 image) {{ {} }}"
CODES: dict[str, str] = {
    "line": "#line 999999999999999999999\n" + FUNCTION.format("return image;"),
    "swizzles": FUNCTION.format(f"return image{'.rgba' * 5000};"),
    "matrices": FUNCTION.format("mat4 m = mat4(1.0); for (int i = 0; i < 60000; i++) { m = m * m; } return m * image;"),
    "macro of itself": "#define f(x) f(f(x))\n" + FUNCTION.format("return image;"),
    "blocks": FUNCTION.format("{" * 99 + "}" * 99 + " return image;"),
    "members": f"struct S {{ {''.join(f'float a{n}; ' for n in range(20_000))} }};\n"
    + FUNCTION.format("S s; return image * s.a5;"),
    "shared": "shared float big[100000];\n" + FUNCTION.format("return image * big[3];"),
    "group": "layout(local_size_x = 99999) in;\n" + FUNCTION.format("return image;"),
    "barrier": FUNCTION.format("barrier(); discard; return image;"),
    "fetch": FUNCTION.format("return texelFetch(image_tex, ivec2(2147483647), 0);"),
    "itself": FUNCTION.format("return f(image);"),
    "each other": "vec4 a(vec4 x);\nvec4 b(vec4 x) { return a(x); }\nvec4 a(vec4 x) { return b(x); }\n"
    + FUNCTION.format("return a(image);"),
    "cases": FUNCTION.format("switch (int(image.r)) { default: case 0: case 0: return image; }"),
    "continued": "\\\n" * 3000 + FUNCTION.format("return image;"),
    "letters": "// " + "é\u202e" * 1000 + "\n" + FUNCTION.format("return image;"),
    "infinite default": "vec4 f(vec4 image, float k /* = 1e999 */) { return image * k; }",
    "long default": "vec4 f(vec4 image, int k /* = 99999999999999999999 */) { return image * float(k); }",
    "closed comment": "vec4 f(vec4 image) { /* </script><img src=x onerror=alert(1)> */ return image; }",
}

ISF_HEADS: dict[str, str] = {
    "passes": json.dumps({"PASSES": [{"TARGET": f"a{n}", "WIDTH": "99999999", "HEIGHT": "1e30"} for n in range(50)]}),
    "import": json.dumps({"IMPORTED": {"x": {"PATH": "../secret.txt"}}}),
    "inputs": json.dumps({"INPUTS": [{"NAME": f"a{n}", "TYPE": "float"} for n in range(5000)]}),
    "brackets": "[" * 5000,
    "main": json.dumps({"INPUTS": [{"NAME": "main", "TYPE": "float"}]}),
    "by zero": json.dumps({"PASSES": [{"WIDTH": "1/0"}]}),
    "formula": json.dumps({"PASSES": [{"WIDTH": "(" * 5000}]}),
    "infinite": '{"INPUTS": [{"NAME": "x", "TYPE": "float", "DEFAULT": 1e999}]}',
}


def write_png(width: int, height: int, pixels: bytes, extra: bytes = b"") -> bytes:
    """A PNG of 8-bit RGBA with these compressed rows, which may be too many or too few, and other chunks."""
    head = _chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0))
    return b"\x89PNG\r\n\x1a\n" + head + extra + _chunk(b"IDAT", pixels) + _chunk(b"IEND", b"")


def _chunk(kind: bytes, content: bytes) -> bytes:
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def _deflate_zeros(count: int, letter: bytes = b"\0") -> bytes:
    packer = zlib.compressobj(9)
    return b"".join([*(packer.compress(letter * (1 << 20)) for _ in range(count >> 20)), packer.flush()])


def list_pictures() -> Iterator[tuple[str, bytes]]:
    """Pictures that promise, or unpack to, far more than they hold."""
    rows, bomb = zlib.compress(b"\0" * 264), _deflate_zeros(200 << 20)
    yield "bomb.png", write_png(60_000, 60_000, bomb)
    yield "profile.png", write_png(8, 8, rows, _chunk(b"iCCP", b"x\0\0" + bomb))
    yield "text.png", write_png(8, 8, rows, _chunk(b"zTXt", b"x\0\0" + _deflate_zeros(200 << 20, b"a")))
    yield "huge.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 99999999 +X 99999999\n"
    yield "negative.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y -5 +X 5\n"
    yield "line.hdr", b"#?RADIANCE\n" + b"A" * 2_000_000 + b"\n\n-Y 4 +X 4\n"
    yield "loop.tif", b"II*\0\x08\0\0\0" + struct.pack("<HI", 0, 8)
    yield "count.tif", b"II*\0\x08\0\0\0" + struct.pack("<HHHIII", 1, 256, 4, 0xFFFFFFFF, 8, 0)
    yield "window.exr", _exr_head((-(2**31), -(2**31), 2**31 - 1, 2**31 - 1))
    yield "turned.exr", _exr_head((5, 5, 0, 0))
    yield "huge.pfm", b"PF\n2000000000 2000000000\n-1.0\n"
    yield "negative.pfm", b"PF\n-5 -5\n-1.0\n"
    yield "huge.ppm", b"P6\n999999999 999999999\n255\n"
    yield "empty.exr", b""


def _exr_head(window: tuple[int, int, int, int]) -> bytes:
    attributes = (
        (b"channels", b"chlist", b"R\0" + struct.pack("<iiii", 1, 0, 1, 1) + b"\0"),
        (b"compression", b"compression", b"\3"),
        (b"dataWindow", b"box2i", struct.pack("<iiii", *window)),
        (b"displayWindow", b"box2i", struct.pack("<iiii", 0, 0, 7, 7)),
        (b"lineOrder", b"lineOrder", b"\0"),
        (b"pixelAspectRatio", b"float", struct.pack("<f", 1.0)),
        (b"screenWindowCenter", b"v2f", struct.pack("<ff", 0.0, 0.0)),
        (b"screenWindowWidth", b"float", struct.pack("<f", 1.0)),
    )
    parts = (name + b"\0" + kind + b"\0" + struct.pack("<I", len(value)) + value for name, kind, value in attributes)
    return bytes.fromhex("762f310102000000") + b"".join(parts) + b"\0"


def _wrap_code(kind: str, code: str) -> Tree:
    links = {"n.image": "s.out", "outputs.image": "n.out"} if kind == "glsl" else {"outputs.image": "n.out"}
    return wrap_node({"type": kind, "code": code.split("\n")}, "out", links=links)


def list_rows() -> Iterator[Row]:
    """Every row."""
    for name, content in list_pictures():
        yield name, {name: content}, wrap_node({"type": "read_image", "values": {"path": name}}, "out")
    for number, name in enumerate(NAMES):
        yield f"name {number}", {}, wrap_node({"type": "read_image", "values": {"path": name}}, "out")
    for number, id in enumerate(IDS):
        graph = wrap_node({"type": "noise"}, "out", nodes={id: {"type": "noise"}}, links={"outputs.image": f"{id}.out"})
        yield f"id {number}", {}, graph
        graph = wrap_node({"type": "noise"}, "out", inputs={id: {"type": "Image", "doc": id, "default": 0.5}})
        yield f"input {number}", {}, graph
        yield f"note {number}", {}, wrap_node({"type": "noise"}, "out", ui={"notes": {id: {"text": id}}, id: id})
    for name, content in TABLES.items():
        links = {"n.image": "s.out", "outputs.image": "n.out"}
        yield name, {name: content}, wrap_node({"type": "lut_file", "values": {"file": name}}, "out", links=links)
    for name, content in CONFIGS.items():
        settings = {"size": [8, 8], "color": {"config": name, "working": "a"}}
        yield name, {name: content}, wrap_node({"type": "noise"}, "out", settings=settings)
    for name, content in MESHES.items():
        scene = {"type": "scene", "values": {"scene": "file", "file": name}}
        yield name, {name: content}, wrap_node(scene, "color")
    for name, code in CODES.items():
        yield f"glsl {name}", {}, _wrap_code("glsl", code)
    for name, head in ISF_HEADS.items():
        yield f"isf {name}", {}, _wrap_code("isf", f"/*{head}*/\nvoid main() {{ gl_FragColor = vec4(1.0); }}")
    for frames in ([1, 10**9], [-(10**18), 10**18], [5, 1]):
        image = {"type": "read_image", "values": {"path": "x.####.exr"}}
        yield f"frames {frames}", {}, wrap_node(image, "out", settings={"size": [4, 4], "frames": frames})
    points = [[0.5, 0.001 * (number % 997), 0, 0, 0, 0, 0] for number in range(100_000)]
    yield "roto", {}, _make_items("roto", "shapes", {"a": {"kind": "spline", "points": points}})
    yield "roto of one place", {}, _make_items("roto", "shapes", {"a": {"kind": "spline", "points": [[0] * 7] * 9000}})
    lights: Tree = {f"l{number}": {"kind": "point"} for number in range(10_000)}
    yield "lights", {}, _make_items("deferred_lighting", "lights", lights)
    groups: Tree = {f"g{number}": {"kind": "group"} for number in range(5000)}
    yield "light groups", {}, _make_items("light_groups", "groups", groups)


def _make_items(type: str, value: str, items: Tree) -> Tree:
    """A node whose value holds these named items, with its inputs linked."""
    sockets = catalogue()[type].inputs
    links = {f"n.{name}": "s.out" for name, socket in sockets.items() if not socket.optional}
    output = next(iter(catalogue()[type].outputs))
    node = {"type": type, "version": catalogue()[type].version, "values": {value: items}}
    return wrap_node(node, output, links={**links, "outputs.image": f"n.{output}"})


RENDERS = ("--size", "24x16", "--timeout", "8")
COMMANDS: tuple[tuple[str, ...], ...] = (
    ("check", "graph.json"),
    ("check", "--root", ".", "--json", "graph.json"),
    ("explain", "graph.json", "--size", "24x16"),
    ("render", "graph.json", "-o", "out.exr", *RENDERS),
    ("render", "graph.json", "-o", "out.png", "--root", ".", *RENDERS),
    ("render", "graph.json", "-o", "out.####.exr", "--frames", "1-2", "--memory", "64M", *RENDERS),
    ("test", "cases.suite.toml", "--timeout", "8"),
    ("sweep", "graph.json", "-o", "sheet.png", "--set", "n.seed=1,2", *RENDERS),
    ("bench", "graph.json", "--size", "24x16", "--timeout", "8"),
    ("export", "graph.json", "-o", "page.html", "--size", "24x16"),
    ("export", "graph.json", "-o", "shader.fs", "--size", "24x16"),
    ("export", "graph.json", "-o", "node.glsl", "--to", "glsl"),
    ("submit", "graph.json", "-o", "a '\"\n.####.exr", "--frames", "1-4", "--slurm", "job.sh"),
    ("fmt", "graph.json"),
    ("diff", "graph.json", "graph.json"),
    ("merge", "graph.json", "graph.json", "graph.json"),
    ("info", "graph.json"),
    ("api", "graph.json"),
)
"""Every command that reads a graph."""


def build_cases(seed: int, count: int) -> Iterator[Case]:
    """Every row by every command, in an order of the seed; 0 is all of them."""
    cases = [
        Case(
            f"oddity-{name}-{number}-{words[0]}".replace("/", "_"),
            partial(_write_files, files, graph),
            words,
            seconds=30.0,
            codes=frozenset({0, 1, 2, 3, 4, 5}),
        )
        for name, files, graph in list_rows()
        for number, words in enumerate((*COMMANDS, *(("info", file) for file in files)))
    ]
    Random(f"oddities {seed}").shuffle(cases)
    yield from cases[:count] if count else cases


def _write_files(files: Files, graph: Tree | bytes, folder: Path) -> None:
    text = graph if isinstance(graph, bytes) else json.dumps(graph).encode()
    (folder / "graph.json").write_bytes(text)
    (folder / "cases.suite.toml").write_text('[cases.odd]\ngraph = "graph.json"\ngolden = ""\n', "utf-8")
    (folder / "folder.exr").mkdir()
    (folder / "loop.exr").symlink_to("loop.exr")
    make_special(folder)
    for name, content in files.items():
        (folder / name).write_bytes(content)
