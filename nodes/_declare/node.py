"""`Node` and its kinds: reads the declaration in a class body."""

from __future__ import annotations

import builtins
import copy
import dataclasses
import re
import sys
from collections.abc import Mapping
from types import SimpleNamespace
from typing import Annotated, Any, ClassVar, Self, dataclass_transform, get_type_hints

from .camera import CameraModel
from .checks import check_aliases, check_names
from .draw import Affine, Draw, Drawn
from .lengths import WORKING_UNITS, LengthUnits, declare_in_unit, is_length, resolve_length_unit, unit_factor
from .listed_names import declare_choice
from .masking import INVERT_MASK, MASK, MIX, is_maskable, list_mask_values, list_own_names, make_mask
from .sockets import Image, OutputSocket, Size, Socket
from .traits import ProxyNote, Trait
from .values import Doc, Missing, Value, read_value


def _fields(cls: Any) -> tuple[dataclasses.Field[Any], ...]:
    return dataclasses.fields(cls)


def _evaluate_annotations(cls: type[Node]) -> dict[str, Any]:
    """The annotations of a class and its bases as objects, but for class variables, which are no values.

    `get_type_hints(cls)` would compile the text of each annotation of `Node` again for each of its subclasses, which
    takes longer than all else about a declaration.
    """
    annotations: dict[str, Any] = {}
    for base in reversed(cls.__mro__):
        texts: dict[str, Any] = {} if base in (object, Node) else vars(base).get("__annotations__", {})
        values = {
            name: text for name, text in texts.items() if not str(text).startswith(("ClassVar", "typing.ClassVar"))
        }
        module = vars(sys.modules.get(base.__module__, builtins))
        names = dict(vars(base))
        annotations |= get_type_hints(SimpleNamespace(__annotations__=values), names, module, include_extras=True)
    return annotations


def _namespace(module: str) -> str:
    """The package of a plug-in that a module is part of: those are laid out as `<package>.nodes.<menu>.<file>`."""
    match module.split("."):
        case [package, "nodes", _, _] if package != "halation":
            return package
        case _:
            return ""


@dataclass_transform(frozen_default=True, kw_only_default=True)
@dataclasses.dataclass(frozen=True, kw_only=True)
class Node:
    """One effect. The class body is the declaration; an instance is one set of values."""

    id: ClassVar[str] = ""
    """The file's name; in a plug-in its namespace comes first: `acme_glow.soft_glow`."""
    title: ClassVar[str] = ""
    """The name that users see: the id with spaces, `soft glow (acme glow)` for a node of a plug-in."""
    category: ClassVar[str] = ""
    """The folder's name, which is the menu."""
    required_package: ClassVar[str] = ""
    """The plug-in that brings it, as pip installs it: `acme-glow==1.2.0`."""
    version: ClassVar[int] = 1
    """The version of the values in graph files: raise it when a saved value changes its meaning."""
    function: ClassVar[str] = ""
    """The GLSL function of a pointwise node: the id, with `_` for the dot."""
    shader: ClassVar[str] = ""
    """The file of the node's GLSL, such as `color/exposure`; in a plug-in `acme_glow/glow/soft_glow`."""
    inputs: ClassVar[Mapping[str, Socket]] = {}
    outputs: ClassVar[Mapping[str, OutputSocket]] = {}
    values: ClassVar[Mapping[str, Value]] = {}
    item_values: ClassVar[tuple[str, ...]] = ()
    """The values that hold named items."""
    order: ClassVar[tuple[str, ...]] = ()
    """Names of inputs and values in declared order: the parameters of a pointwise GLSL function."""
    aliases: ClassVar[tuple[str, ...]] = ()
    """Names that other programs give such a node, in lower case: the search finds it by them."""
    has_mix: ClassVar[bool] = False
    """True if it has the value `mix`, as all have that change `image` at its size: the first output is mixed with
    `image`, after the node."""
    has_mask: ClassVar[bool] = False
    """True if it also has the input `mask` and the value `invert_mask`, which say where it is mixed."""
    own_mask_names: ClassVar[tuple[str, ...]] = ()
    """Which of `mask`, `mix` and `invert_mask` the class body declares, and with them what they mean."""
    traits: ClassVar[tuple[Trait, ...]] = ()
    """What rules and tests need to know besides sockets and values."""
    proxy_notes: ClassVar[tuple[ProxyNote, ...]] = ()
    """Why a proxy of half the size does not look like the full picture made smaller."""

    length_units: LengthUnits = dataclasses.field(default=(), repr=False)
    """The units of lengths, by name, where they differ from what the graph says: `(("sigma", "height"),)`."""

    def __init_subclass__(cls, abstract: bool = False, **kwargs: Any) -> None:
        """Read the declaration; that of an `abstract` class, which has no instances, is left to its subclasses.

        Values come in the order of the class body, with inherited ones after them: that is the order of the parameters
        of its GLSL function. The names of the body are noted before the mask is added: its values are no parameters.
        The dataclass is made after that, so that they are fields like all others.
        """
        super().__init_subclass__(**kwargs)
        if abstract:
            return
        body = vars(cls)
        name = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", cls.__name__).lower()
        cls.category = cls.__module__.rpartition(".")[0].rpartition(".")[2]
        cls.id, cls.function, cls.shader = name, name, f"{cls.category}/{name}"
        cls.title = name.replace("_", " ")
        if namespace := _namespace(cls.__module__):
            cls.id, cls.function = f"{namespace}.{name}", f"{namespace}_{name}"
            cls.shader, cls.title = f"{namespace}/{cls.shader}", f"{cls.title} ({namespace.replace('_', ' ')})"
        cls.inputs = {name: item for name, item in body.items() if isinstance(item, Socket)}
        outputs = {name: item for name, item in body.items() if isinstance(item, OutputSocket)}
        own_names = tuple(body)
        check_aliases(cls.aliases)
        may_have_mask = is_maskable(cls, cls.inputs, outputs, Node)
        cls.own_mask_names = list_own_names(cls, cls.inputs, outputs) if may_have_mask else ()
        cls.has_mix = may_have_mask and MIX not in cls.own_mask_names
        cls.has_mask = cls.has_mix and not cls.own_mask_names
        if cls.has_mix:
            cls._add_mix()
        dataclasses.dataclass(frozen=True, kw_only=True)(cls)
        if not outputs:
            implied = OutputSocket()
            implied.__set_name__(cls, "out")
            outputs = {"out": implied}
        for output in outputs.values():
            if output.follows and not isinstance(cls.inputs.get(output.follows), Image):
                raise TypeError(f"output '{output.name}': it follows '{output.follows}', which is no Image input")
        cls.outputs = outputs
        annotations = _evaluate_annotations(cls)
        cls.values = {
            field.name: read_value(field.name, annotations[field.name], field.default)
            for field in sorted(_fields(cls), key=lambda field: field.name not in own_names)
            if field.name != "length_units"
        }
        check_names({*cls.inputs, *outputs, *cls.values}, vars(Node).keys() - {"length_units"})
        cls.item_values = tuple(name for name, value in cls.values.items() if value.items)
        cls.order = tuple(name for name in own_names if name in cls.inputs or name in cls.values)

    @classmethod
    def _add_mix(cls) -> None:
        """Declare the values of a mix, and the input of a mask unless it has its own, as if the class body had them."""
        additions = list_mask_values()
        if cls.has_mask:
            cls.inputs = {**cls.inputs, MASK: make_mask()}
        else:
            del additions[INVERT_MASK]
        annotations = {name: annotation for name, (annotation, _) in additions.items()}
        cls.__annotations__ = vars(cls).get("__annotations__", {}) | annotations
        for name, (_, default) in additions.items():
            setattr(cls, name, default)

    @property
    def settings(self) -> Mapping[str, Any]:
        """What all values are set to, by name, in the order of `values`."""
        fields = vars(self)
        return {name: fields[name] for name in self.values}

    def setting(self, name: str) -> Any:
        """What the value of this name is set to."""
        return getattr(self, name)

    def identity(self) -> str | None:
        """The input that passes through unchanged at these values, or None. Not called while a value is linked."""
        return None

    def output_size(self, inputs: Mapping[str, Size], canvas: Size) -> Size:
        """The size of the outputs: that of the first linked input, else that of the graph."""
        return next(iter(inputs.values()), canvas)

    def with_pixel_aspect(self, aspect: float) -> Self:
        """The node as it is for a first picture whose pixels are `aspect` times as wide as high; mostly itself."""
        return self

    def times(self, frame: int) -> Mapping[str, tuple[int, ...]]:
        """The frames of each input that are needed for a frame; of inputs that are not named only `frame` is.

        For filters, which read them by `draw.at`.
        """
        return {}

    def place_spline(self, name: str, size: Size) -> Affine | None:
        """The map from the points of a spline value to pixels of a picture, or None if it has no effect now.

        Asked with lengths in working units. Points are fractions of the picture, unless a class says otherwise.
        """
        return (size[0], 0.0, 0.0, 0.0, size[1], 0.0)

    @classmethod
    def upgrade(cls, version: int, values: dict[str, Any]) -> dict[str, Any]:
        """Values saved by an older `version` of this node, as the next version would have saved them."""
        return values

    def declaration(self, name: str, reference_height: int | None = None) -> Value:
        """A value as it is declared, in the unit of its number. Its default is that of the class.

        A text that is one of the names in another one is a choice among these.
        """
        value = self.values[name]
        if value.listed_in:
            return declare_choice(value, self.setting(value.listed_in))
        if not is_length(value):
            return value
        chosen_unit = dict(self.length_units).get(name)
        unit = chosen_unit or resolve_length_unit(value.unit, reference_height)
        return declare_in_unit(value, unit) if unit else value

    def to_working_units(self, scale: float, height: float, reference_height: int | None = None) -> Self:
        """The same values in working units, as `passes` and GLSL see them: see `Unit`."""
        converted: dict[str, Any] = {}
        chosen_units = dict(self.length_units)
        for name, value in self.values.items():
            if value.items:
                converted[name] = value.items.to_working_units(
                    self.setting(name),
                    lambda field: unit_factor(resolve_length_unit(field.unit, reference_height), scale, height),
                )
                continue
            if value.unit in WORKING_UNITS:
                continue
            unit = chosen_units.get(name) or resolve_length_unit(value.unit, reference_height)
            factor = unit_factor(unit, scale, height)
            if factor != 1.0:
                stored: float | tuple[float, ...] = self.setting(name)
                converted[name] = (
                    tuple(part * factor for part in stored) if isinstance(stored, tuple) else stored * factor
                )
        return self.with_values(**converted) if converted else self

    def with_values(self, /, **values: Any) -> Self:
        """The same node with other values."""
        return type(self)(**{**self.settings, **values}).with_length_units(self.length_units)

    def with_length_units(self, length_units: LengthUnits) -> Self:
        """The same numbers of lengths in other units."""
        if length_units == self.length_units:
            return self
        node = copy.copy(self)
        object.__setattr__(node, "length_units", tuple(sorted(length_units)))
        return node


class Pointwise(Node, abstract=True):
    """An output pixel depends only on the same pixel of each input, so that neighbors fuse into one pass.

    `shaders/<category>/<id>.glsl` has a function with the name of the node. Its parameters are the sockets and values
    in declared order. It returns the output; several outputs are `out` parameters at the end.

    A node that some of its values ask for more than that has `passes` too, and says by `takes_passes` when they count.
    Meanwhile a picture cannot drive its values.
    """

    def takes_passes(self) -> bool:
        """True if `passes` draws the node at these values, in place of its function."""
        return False

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        """Record the draws, and return all outputs by name."""
        raise NotImplementedError


class Filter(Node, abstract=True):
    """A node that reads other pixels, or takes several passes."""

    def passes(self, draw: Draw) -> Drawn | Mapping[str, Drawn | CameraModel]:
        """Record the draws, and return the output; several outputs by name. A camera is returned as it is."""
        raise NotImplementedError


class Source(Filter, abstract=True):
    """A node that makes pixels without an input: from files, formulas or meshes."""


class Reader(Source):
    """A source that reads picture files. In their names `####`, `%04d` or `$F4` stands for the frame.

    A folder is the sequence in it.
    """

    missing: Annotated[
        Missing, Doc("What a frame shows that has no file: an error, the last one before, the nearest one, or black.")
    ] = "error"


class Temporal(Filter, abstract=True):
    """A filter that remembers pictures: `draw.history` returns what `draw.remember` kept in the previous frame.

    The first frame of the graph has no history. Such a node is never skipped as neutral: its values may be animated,
    and frames that they do not change are remembered too.
    """
