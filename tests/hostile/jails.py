"""Every way in which a graph can name a file, tried from inside of `--root`: none may open a file outside of it.

What can name a file is found from the declarations of the nodes, so a new one is covered by itself. What is opened is
watched by the system (inotify), not guessed from what comes out.
"""

from __future__ import annotations

import json
import os
import stat
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random

import images
from cases import Case
from halation.document import records
from halation.nodes import Node, catalogue
from msgspec import Struct, structs

Tree = dict[str, object]
WAYS = (
    "../secret/",
    "link/",
    "./../secret/",
    "inner/../../secret/",
    "{absolute}/",
    "file://{absolute}/",
    "LINK/../link/",
    "chain/",
    "..%2Fsecret/",
    "%2e%2e/secret/",
    "..\\\\secret\\\\",
    "file:../secret/",
)
"""How a path leads out: up, by links, by links to links, whole, and as libraries may spell it that decode addresses."""

SPECIAL = ("fifo", "socket", "device", "fifolink", "devicelink")
"""What lies in the jail in place of a file of each ending, and would be waited for or never end: see `make_special`."""

LISTED = frozenset({"InputRecord.file", "GroupRecord.path", "CodeRecord.file", "ColorRecord.config"})
"""The fields of the format that name files, beside values of nodes. `fields` has graphs for each of them."""


def find_path_fields() -> frozenset[str]:
    """The fields of records of the format that name files, by their names: a new one has to be listed above."""
    return frozenset(
        f"{name}.{field.name}"
        for name, record in vars(records).items()
        if isinstance(record, type) and issubclass(record, Struct)
        for field in structs.fields(record)
        if field.name in ("file", "path", "config")
    )


def path_values() -> Iterator[tuple[type[Node], str]]:
    """Every value of every node that names a file."""
    for kind in catalogue().values():
        for name, value in kind.values.items():
            if value.type == "path":
                yield kind, name


def wrap_node(node: Tree, output: str, **parts: object) -> Tree:
    return {
        "halation": 1,
        "settings": {"size": [16, 16]},
        "outputs": {"image": {"type": "Image"}},
        "nodes": {"n": node, "s": {"type": "noise"}},
        "links": {"outputs.image": f"n.{output}"},
        **parts,
    }


def fields(name: str) -> Iterator[tuple[str, str, Tree]]:
    """Label, ending and graph of every field of the format that names a file, here `name` plus that ending."""
    for kind, value in path_values():
        for ending in ("exr", "cube", "clf", "obj", "gltf", "ply", "mov"):
            path = f"{name}.{ending}"
            values: Tree = {value: path} if kind.id != "scene" else {"scene": "file", value: path}
            tree = wrap_node({"type": kind.id, "values": values}, next(iter(kind.outputs), "out"))
            links = tree["links"]
            assert isinstance(links, dict)
            links |= {f"n.{socket}": "s.out" for socket in kind.inputs if not kind.inputs[socket].optional}
            yield f"{kind.id}.{value}", ending, tree
    for ending in ("exr", "####.exr", "mov"):
        inputs = {"b": {"type": "Image", "file": f"{name}.{ending}"}}
        yield (
            "inputs.file",
            ending,
            {
                "halation": 1,
                "inputs": inputs,
                "outputs": {"image": {"type": "Image"}},
                "links": {"outputs.image": "inputs.b"},
            },
        )
    yield "group.path", "json", wrap_node({"type": "group", "path": f"{name}.json"}, "image")
    yield "glsl.file", "glsl", wrap_node({"type": "glsl", "file": f"{name}.glsl"}, "out")
    yield "isf.file", "fs", wrap_node({"type": "isf", "file": f"{name}.fs"}, "out")
    yield (
        "settings.color.config",
        "ocio",
        wrap_node({"type": "noise"}, "out", settings={"size": [16, 16], "color": {"config": f"{name}.ocio"}}),
    )


def inner_files(name: str) -> Iterator[tuple[str, dict[str, str], Tree]]:
    """Label, files inside the jail that name others outside by `name` in turn, and the graph that names them."""
    clf = (
        '<?xml version="1.0"?><ProcessList id="a" compCLFversion="3">'
        '<Reference path="{}" inBitDepth="32f" outBitDepth="32f"/></ProcessList>'
    )
    lut = wrap_node({"type": "lut_file", "values": {"file": "a.clf"}}, "out")
    lut["links"] = {"n.image": "s.out", "outputs.image": "n.out"}
    for ending in ("clf", "ctf", "cube"):
        yield f"reference in a CLF to {ending}", {"a.clf": clf.format(f"{name}.{ending}")}, lut
        other = json.loads(json.dumps(lut).replace("a.clf", "a.ctf"))
        text = clf.format(f"{name}.{ending}").replace('compCLFversion="3"', 'version="1.3"')
        yield f"reference in a CTF to {ending}", {"a.ctf": text}, other
        chained = {"a.clf": clf.format("b.clf"), "b.clf": clf.format(f"{name}.{ending}")}
        yield f"reference by way of another CLF to {ending}", chained, lut
    scene = {"type": "scene", "values": {"scene": "file", "file": "a.obj"}}
    obj = f"mtllib {name}.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n"
    yield "material of an OBJ", {"a.obj": obj}, wrap_node(scene, "color")
    textured = {"a.obj": obj.replace(f"{name}.mtl", "a.mtl"), "a.mtl": f"newmtl m\nmap_Kd {name}.png\n"}
    yield "texture of a material", textured, wrap_node(scene, "color")
    ply = "ply\nformat ascii 1.0\ncomment TextureFile {}.png\nelement vertex 3\n"
    ply += "".join(f"property float {axis}\n" for axis in "xyzst") + "element face 1\n"
    ply += "property list uchar int vertex_indices\nend_header\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n"
    scene = {"type": "scene", "values": {"scene": "file", "file": "a.ply"}}
    yield "texture of a PLY", {"a.ply": ply.format(name)}, wrap_node(scene, "color")
    shader = {"IMPORTED": {"t": {"PATH": f"{name}.png"}}, "INPUTS": [{"NAME": "inputImage", "TYPE": "image"}]}
    text = f"/*{json.dumps(shader)}*/\nvoid main() {{ gl_FragColor = IMG_NORM_PIXEL(t, isf_FragNormCoord); }}\n"
    yield "picture of a shader", {"a.fs": text}, wrap_node({"type": "isf", "file": "a.fs"}, "out")
    gltf = json.loads(images.TEXTS["gltf"])
    gltf["buffers"][0]["uri"] = f"{name}.bin"
    gltf["images"] = [{"uri": f"{name}.png"}]
    scene = {"type": "scene", "values": {"scene": "file", "file": "a.gltf"}}
    yield "buffer of a glTF", {"a.gltf": json.dumps(gltf)}, wrap_node(scene, "color")
    for transform in (f"!<FileTransform> {{src: {name}.cube}}", f"!<FileTransform> {{src: {name}.clf}}"):
        config = CONFIG.replace("TRANSFORM", transform)
        settings = {"size": [16, 16], "color": {"config": "a.ocio", "working": "looked"}}
        yield "table of a config", {"a.ocio": config}, wrap_node({"type": "noise"}, "out", settings=settings)
    for part in CONFIG_PARTS:
        settings = {"size": [16, 16], "color": {"config": "a.ocio"}}
        tree = wrap_node({"type": "noise"}, "out", settings=settings, outputs={"image": {"type": "Image", "view": "v"}})
        yield "table of another part of a config", {"a.ocio": part.replace("NAME", name)}, tree
    moved = CONFIG.replace("search_path: .", f"search_path: {name.rpartition('/')[0] or '.'}").replace(
        "TRANSFORM", "!<FileTransform> {src: secret.cube}"
    )
    yield (
        "search path of a config",
        {"a.ocio": moved},
        wrap_node(
            {"type": "noise"}, "out", settings={"size": [16, 16], "color": {"config": "a.ocio", "working": "looked"}}
        ),
    )
    yield (
        "include of code",
        {},
        wrap_node({"type": "glsl", "code": [f'#include "{name}.glsl"', "vec4 f(vec4 image) { return image; }"]}, "out"),
    )
    group = wrap_node({"type": "read_image", "values": {"path": f"{name}.exr"}}, "out")
    yield "picture of a group", {"g.json": json.dumps(group)}, wrap_node({"type": "group", "path": "g.json"}, "image")


CONFIG = """ocio_profile_version: 2
search_path: .
strictparsing: true
roles:
  default: raw
  scene_linear: raw
file_rules:
  - !<Rule> {name: Default, colorspace: default}
displays:
  d:
    - !<View> {name: v, colorspace: looked}
active_displays: []
active_views: []
colorspaces:
  - !<ColorSpace>
    name: raw
    isdata: true
  - !<ColorSpace>
    name: looked
    isdata: false
    to_scene_reference: TRANSFORM
"""


_LOOK = "looks:\n  - !<Look> {name: l, process_space: looked, transform: TABLE}\ndisplays:"
_NAMED = "named_transforms:\n  - !<NamedTransform> {name: t, transform: TABLE}\ncolorspaces:"
_DEEP = "!<GroupTransform> {children: [!<GroupTransform> {children: [TABLE]}]}"
_PARTS = (
    CONFIG.replace("displays:", _LOOK).replace("colorspace: looked}", "colorspace: looked, looks: l}"),
    CONFIG.replace("roles:", "environment: {WHERE: NAME.cube}\nroles:").replace("TRANSFORM", "TABLE_BY_VARIABLE"),
    CONFIG.replace("colorspaces:", _NAMED).replace("{name: v, colorspace: looked}", "{name: v, colorspace: t}"),
    CONFIG.replace("TRANSFORM", _DEEP),
)
CONFIG_PARTS = tuple(
    part.replace("TRANSFORM", "!<CDLTransform> {slope: [2, 2, 2]}")
    .replace("TABLE_BY_VARIABLE", "!<FileTransform> {src: $WHERE}")
    .replace("TABLE", "!<FileTransform> {src: NAME.cube}")
    for part in _PARTS
)
"""Configs that name a table in a look, by a variable, in a named transform and deep inside of groups."""


ENDINGS = (
    *("exr", "0001.exr", "png", "mov", "cube", "clf", "ctf", "ocio"),
    *("obj", "mtl", "gltf", "bin", "ply", "json", "glsl", "fs"),
)
"""Of everything that a field or a file of the jail names."""


def make_special(jail: Path) -> None:
    """FIFOs, sockets and devices of every ending, and links to them."""
    os.mkfifo(jail / "pipe")
    for ending in ENDINGS:
        os.mkfifo(jail / f"fifo.{ending}")
        os.mknod(jail / f"socket.{ending}", stat.S_IFSOCK | 0o600)
        (jail / f"device.{ending}").symlink_to("/dev/zero")
        (jail / f"fifolink.{ending}").symlink_to("pipe")
        (jail / f"devicelink.{ending}").symlink_to(f"device.{ending}")


def make_yard(folder: Path) -> None:
    """jail/ with links that lead out, and secret/ beside it with a file of every kind."""
    jail, secret = folder / "jail", folder / "secret"
    (jail / "inner").mkdir(parents=True)
    secret.mkdir()
    for path in images.write_corpus(secret):
        path.rename(path.with_name(f"secret{path.suffix}"))
    (secret / "secret.0001.exr").write_bytes((secret / "secret.exr").read_bytes())
    (secret / "secret.ctf").write_text(images.TEXTS["clf"].replace('compCLFversion="3"', 'version="1.3"'))
    (secret / "secret.mtl").write_text("newmtl m\nKd 1 0 0\n")
    (secret / "secret.bin").write_bytes(bytes(36))
    (secret / "secret.glsl").write_text("vec4 pixel(vec4 image) { return image; }\n")
    (secret / "secret.json").write_text(json.dumps(wrap_node({"type": "noise"}, "out")))
    (secret / "secret.ocio").write_text(CONFIG.replace("TRANSFORM", "!<CDLTransform> {slope: [2, 2, 2]}"))
    (jail / "link").symlink_to(secret)
    (jail / "LINK").symlink_to(secret)
    (jail / "chain").symlink_to("link")


COMMANDS = (
    ("render", "jail/graph.json", "-o", "jail/out.exr", "--root", "jail", "--timeout", "8"),
    ("check", "jail/graph.json", "--root", "jail"),
    ("explain", "jail/graph.json", "--root", "jail"),
    ("export", "jail/graph.json", "--to", "web", "-o", "jail/page.html", "--root", "jail"),
    ("submit", "jail/graph.json", "-o", "jail/o.####.exr", "--slurm", "jail/job.sh", "--root", "jail"),
)
INFO = ("exr", "mov")
"""Endings of what `info` looks at."""


def build_cases(seed: int, count: int) -> Iterator[Case]:
    """All fields in all ways by all commands, in an order by the seed; `count` of them, 0 for all."""
    assert find_path_fields() == LISTED, f"path fields that no case covers: {find_path_fields() ^ LISTED}"
    plans: list[tuple[str, str, Callable[[Path], None], tuple[str, ...]]] = []
    for way in WAYS:
        for ending in INFO:
            path = f"jail/{way}secret.{ending}" if "{" not in way else f"secret/secret.{ending}"
            plans.append((f"info ({ending})", way, make_yard, ("info", path, "--root", "jail")))
    for name in SPECIAL:
        for ending in INFO:
            plans.append((f"info ({ending})", name, _make_special_yard, ("info", f"jail/{name}.{ending}")))
        for words in COMMANDS:
            place = words.index("--root")
            for root in (words, words[:place] + words[place + 2 :]):
                for label, ending, _ in fields("x"):
                    plans.append((f"{label} ({ending})", name, _write_special(name, label, ending), root))
                for number, (label, _, _) in enumerate(inner_files("x")):
                    plans.append((label, name, _write_special_inner(name, number), root))
    for way in WAYS:
        for words in COMMANDS:
            for label, ending, _ in fields("x"):
                plans.append((f"{label} ({ending})", way, _write_field(way, label, ending), words))
            for number, (label, _, _) in enumerate(inner_files("x")):
                plans.append((label, way, _write_inner(way, number), words))
    Random(f"jails {seed}").shuffle(plans)
    for number, (label, way, prepare, words) in enumerate(plans[: count or None]):
        yield Case(f"jail-{seed}-{number} {label} by {way} {words[0]}", prepare, words, forbidden="secret")


def _make_special_yard(folder: Path) -> None:
    make_yard(folder)
    make_special(folder / "jail")


def _write_special(name: str, label: str, ending: str) -> Callable[[Path], None]:
    def prepare(folder: Path) -> None:
        _make_special_yard(folder)
        tree = next(tree for its, end, tree in fields(name) if (its, end) == (label, ending))
        (folder / "jail" / "graph.json").write_text(json.dumps(tree))

    return prepare


def _write_special_inner(name: str, number: int) -> Callable[[Path], None]:
    def prepare(folder: Path) -> None:
        _make_special_yard(folder)
        _, files, tree = list(inner_files(str(folder / "jail" / name)))[number]
        for file, text in files.items():
            (folder / "jail" / file).write_text(text)
        (folder / "jail" / "graph.json").write_text(json.dumps(tree))

    return prepare


def _named(way: str, folder: Path) -> str:
    return way.replace("{absolute}", str(folder / "secret")) + "secret"


def _write_field(way: str, label: str, ending: str) -> Callable[[Path], None]:
    def prepare(folder: Path) -> None:
        make_yard(folder)
        tree = next(tree for its, end, tree in fields(_named(way, folder)) if (its, end) == (label, ending))
        (folder / "jail" / "graph.json").write_text(json.dumps(tree))

    return prepare


def _write_inner(way: str, number: int) -> Callable[[Path], None]:
    def prepare(folder: Path) -> None:
        make_yard(folder)
        _, files, tree = list(inner_files(_named(way, folder)))[number]
        for name, text in files.items():
            (folder / "jail" / name).write_text(text)
        (folder / "jail" / "graph.json").write_text(json.dumps(tree))

    return prepare
