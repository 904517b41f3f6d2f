"""Small node types for tests that need no pixels, and random graphs of them."""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import Annotated, Any, Literal

from halation.errors import GraphError
from halation.graph import Control, Graph, Group, Input, Item, Output, Port, Settings, Unknown, signature
from halation.nodes import (
    RGBA,
    Field,
    FilePath,
    Filter,
    Image,
    Kernel3x3,
    Kind,
    Light,
    LightKind,
    LightSet,
    Node,
    Number,
    Points,
    Pointwise,
    Position,
    Slider,
    Source,
    Stops,
    Vector,
    name_lights,
    number_lights,
)
from halation.nodes import OutputSocket as Made


class Gain(Pointwise):
    """Pointwise with a value of every type."""

    image = Image()
    gain: Annotated[float, Slider(0.0, 4.0, unit="ratio", minimum=0.0, maximum=16.0)] = 1.0
    steps: Annotated[int, Slider(1, 8, unit="count", minimum=1)] = 3
    clamp: bool = False
    mode: Literal["add", "soft light"] = "add"
    tint: RGBA = (1.0, 1.0, 1.0, 1.0)
    center: Position = (0.5, 0.5)
    note: str = ""


class Soften(Filter):
    """A filter whose value cannot be wired."""

    image = Image()
    sigma: Annotated[float, Slider(0.0, 50.0, unit="px", minimum=0.0)] = 2.0
    kernel: Kernel3x3 = (0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0)


class Blend(Pointwise):
    """Two images and an optional mask."""

    first = Image()
    second = Image()
    mask = Field(1.0)
    gain: Annotated[float, Slider(0.0, 1.0, unit="ratio")] = 0.5


class Split(Pointwise):
    """Two outputs of different kinds."""

    image = Image()
    grey = Made(Field())
    rest = Made(Image())


class Slope(Filter):
    """Data in, data out."""

    depth = Field()
    normal = Made(Vector(width=3))
    flow = Made(Vector(width=2))


class Flow(Filter):
    """Takes a vector of two channels."""

    image = Image()
    by = Vector(width=2)


class Meter(Filter):
    """One number."""

    image = Image()
    mean = Made(Number())


class Photo(Source):
    """No inputs."""

    path: FilePath = ""


class Tint(Filter):
    """A curve and a color ramp."""

    image = Image()
    curve: Points = (0.0, 0.0, 1.0, 1.0)
    ramp: Stops = (0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0)


class Lamps(Filter):
    """A list of lights."""

    image = Image()
    lights: LightSet = name_lights(lamp_1=Light())


TOYS: dict[str, type[Node]] = {
    kind.id: kind for kind in (Gain, Soften, Blend, Split, Slope, Flow, Meter, Photo, Tint, Lamps)
}


def chain(length: int) -> Graph:
    """`inputs.beauty` through `length` nodes n0, n1, ... to `outputs.image`."""
    nodes = {f"n{index}": Gain(gain=1.5) for index in range(length)}
    links = {Port(f"n{index}", "image"): Port(f"n{index - 1}", "out") for index in range(1, length)}
    links[Port("n0", "image")] = Port("inputs", "beauty")
    links[Port("outputs", "image")] = Port(f"n{length - 1}", "out")
    return Graph(nodes, links, {"beauty": Input()}, {"image": Output()})


def small() -> Graph:
    """beauty -> gain -> soften -> image, with a control, a layout and a mute."""
    return Graph(
        nodes={"gain": Gain(gain=2.0), "soften": Soften(sigma=4.0)},
        links={
            Port("gain", "image"): Port("inputs", "beauty"),
            Port("soften", "image"): Port("gain", "out"),
            Port("outputs", "image"): Port("soften", "out"),
        },
        inputs={"beauty": Input(file="shot.exr", layer="Combined")},
        outputs={"image": Output()},
        controls={"glow": Control(Port("gain", "gain"), "Glow")},
        ui={"nodes": {"gain": [10, 20.5], "soften": [200, 20]}, "zoom": 1.5},
    )


def random_item(rng: Random, depth: int = 0) -> Item:
    """A node with random values, a group of some, or one of unknown type."""
    if depth < 2 and rng.random() < 0.15:
        body = random_graph(rng, 6, depth + 1)
        values = {name: value.default for name, value in signature(Group(body)).values.items() if rng.random() < 0.5}
        return Group(body, values=values)
    if rng.random() < 0.1:
        return Unknown(rng.choice(["lens", "gain9"]), {"version": rng.randint(1, 9), "values": {"a": [1, {"b": None}]}})
    kind = rng.choice(list(TOYS.values()))
    return kind(**{name: random_value(rng, kind, name) for name in kind.values if rng.random() < 0.5})


def random_value(rng: Random, kind: type[Node], name: str) -> Any:
    """A legal setting."""
    value = kind.values[name]
    if value.type == "choice":
        return rng.choice(value.choices)
    if value.type in ("text", "path"):
        return rng.choice(["", "a b", "über\n\u2028", '"quoted"\\'])
    if value.type == "bool":
        return rng.random() < 0.5
    if value.type == "int":
        return rng.randint(1, 8)
    if value.type == "float":
        return rng.choice([0.0, 1.0, rng.uniform(0.0, 4.0), 1e-7])
    if value.type in ("curve", "ramp"):
        places = sorted(rng.sample(range(9), rng.randint(2, 5)))
        return tuple(
            part for place in places for part in (place / 8, *(rng.uniform(-9.0, 9.0) for _ in range(value.length - 1)))
        )
    if value.items:
        return number_lights(
            tuple(
                Light(rng.choice([*LightKind]), intensity=rng.uniform(-9.0, 9.0), on=rng.random() < 0.5)
                for _ in range(rng.randint(0, 3))
            )
        )
    return tuple(rng.uniform(-1e3, 1e3) for _ in range(value.length))


def random_edit(rng: Random, graph: Graph, depth: int = 0) -> Graph:
    """One edit, or the same graph where it was refused."""
    ids = [*graph.nodes] or [""]
    id, name, fresh = rng.choice(ids), rng.choice("abcdef"), graph.fresh_id(rng.choice("nm"))
    edits: list[tuple[int, Callable[[], Graph]]] = [
        (10, lambda: graph.add(fresh, random_item(rng, depth))),
        (40, lambda: graph.connect(rng.choice(_starts(graph)), rng.choice(_ends(graph)))),
        (1, lambda: graph.disconnect(rng.choice([*graph.links]))),
        (1, lambda: graph.remove(id, heal=rng.random() < 0.7)),
        (1, lambda: graph.rename(id, fresh)),
        (2, lambda: graph.replace(id, random_item(rng, depth))),
        (1, lambda: graph.mute(id, rng.random() < 0.7)),
        (2, lambda: _random_set(rng, graph, id)),
        (2, lambda: graph.add_input(name, Input(rng.choice([*Kind]), rng.randint(2, 4), rng.choice(["", "a.exr"])))),
        (
            2,
            lambda: graph.add_output(name, Output(rng.choice([*Kind]), rng.randint(2, 4), overscan=rng.random() < 0.3)),
        ),
        (2, lambda: graph.add_control(name, Control(Port(id, rng.choice(["gain", "sigma", "a", "b", "tint"]))))),
        (1, lambda: rng.choice([graph.remove_input, graph.remove_output, graph.remove_control])(name)),
        (1, lambda: rng.choice([graph.rename_input, graph.rename_output, graph.rename_control])(name, name + "2")),
    ]
    try:
        return rng.choices([edit for _, edit in edits], [weight for weight, _ in edits])[0]()
    except (GraphError, IndexError):
        return graph


def random_graph(rng: Random, edits: int = 25, depth: int = 0) -> Graph:
    """What is left of a number of random edits."""
    graph = Graph(
        inputs={"image": Input(), "depth": Input(Kind.FIELD)},
        outputs={"final": Output()},
        settings=Settings(rng.choice([None, (64, 48)])),
    )
    for _ in range(edits):
        graph = random_edit(rng, graph, depth)
    return graph


def _random_set(rng: Random, graph: Graph, id: str) -> Graph:
    item = graph.node(id)
    if isinstance(item, Node) and item.values:
        name = rng.choice([*item.values])
        return graph.set(Port(id, name), random_value(rng, type(item), name))
    return graph


def _starts(graph: Graph) -> list[Port]:
    ports = [Port("inputs", name) for name in graph.inputs]
    for id, item in graph.nodes.items():
        ports += [Port(id, name) for name in ("out",) if isinstance(item, Unknown)]
        ports += [Port(id, name) for name in signature(item).outputs]
    return ports


def _ends(graph: Graph) -> list[Port]:
    ports = [Port("outputs", name) for name in graph.outputs]
    for id, item in graph.nodes.items():
        ports += [Port(id, name) for name in ("in",) if isinstance(item, Unknown)]
        ports += [Port(id, name) for name in (*signature(item).inputs, *signature(item).values)]
    return ports
