"""The inspector of an input or output of the graph."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, get_args

from halation.nodes import Kind, Missing, Scalar, Value
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...authoring.commands import RenameEnd, SetInput, SetOutput
from ...authoring.edits.element_id import ElementId
from ...color.display import list_views
from ...graph import INPUTS, Input, Output, Port
from ...graph.frames import Pattern
from ...language.translation import mark, translate
from ..fields.choice_field import choose
from ..fields.color_field import color_field
from ..fields.fields import Edit, Fields
from ..fields.number_field import number_field, row_of_numbers
from ..fields.text_field import text_field
from ..shared.coloring import find_color_manager
from ..shared.declared_words import name_choice, name_choices
from ..toolkit.labels import make_label
from ..toolkit.words import tip
from .color_rows import space_field
from .file_field import PICTURE, FileField
from .heading import draw_faults, draw_heading, draw_name_field
from .value_rows import link_chip

if TYPE_CHECKING:
    from ...authoring.session import Session
    from .rows import Rows

Then = Callable[[str], object]

_TEXT = Value("text", "text", "")
_NUMBER = Value("default", "float", 0.0, low=0.0, high=1.0)
_AXES = ("x", "y", "z", "w")
DEFAULT_VIEW = mark("viewer's choice")
MISSING: tuple[Missing, ...] = get_args(Missing)


def describe_binding(session: Session, name: str) -> str:
    """What an input of the graph is bound to in this window: a path, or a picture in memory; "" for nothing."""
    if session.place or name not in session.bindings:
        return ""
    file: object = session.bindings[name]
    return file if isinstance(file, str) else translate("a picture in memory")


class EndView:
    """Shows and edits an input or output."""

    def __init__(self, fields: Fields, files: FileField) -> None:
        self._fields, self._files = fields, files

    def draw(self, rows: Rows, port: Port) -> None:
        """Draw the input or output that `port` names."""
        graph = rows.context.session.graph
        end = graph.inputs[port.socket] if port.node == INPUTS else graph.outputs[port.socket]
        width = str(end.width) if end.kind is Kind.VECTOR else ""
        word = translate("Input") if isinstance(end, Input) else translate("Output")
        draw_heading(rows, f"{translate(end.kind, 'kind')}{width} {word}", rows.palette.kinds[end.kind])
        session, element = rows.context.session, ElementId.of_port(port)
        draw_name_field(rows, self._fields, element, port.socket, lambda new: session.apply(RenameEnd(element, new)))
        draw_faults(rows, element)
        if isinstance(end, Input):
            self._input(rows, port, end)
        else:
            self._output(rows, port, end)

    # --- parts -------------------------------------------------------------------------------------------------------

    def _draw_missing_choice(self, rows: Rows, port: Port, end: Input) -> None:
        key = f"{port} missing"
        rows.name(key, translate("missing", "value"), doc=translate("What to show at a frame that has no file"))
        index = choose(self._fields, key, name_choice(end.missing), name_choices(MISSING), rows.field())
        rows.record(key)
        if index is not None:
            rows.act(lambda: rows.context.session.apply(SetInput(port.socket, missing=MISSING[index])))

    def _input(self, rows: Rows, port: Port, end: Input) -> None:
        context, name, key = rows.context, port.socket, str(port)
        session = context.session
        bound = describe_binding(session, name)
        if bound:
            rows.name(
                f"{key} bound",
                translate("bound to", "value"),
                doc=translate("A file that is bound in this window only. It is not saved"),
            )
            doc = f"{bound}\n{translate('Click to use the file below instead')}"
            if rows.chip(bound, f"{key} bound", rows.field(), rows.palette.good, doc):
                rows.act(lambda: session.bind(name, None))
        rows.name(
            f"{key} file",
            translate("file", "value"),
            doc=translate("The file to read unless another one is linked or bound"),
        )
        edit = self._files.path(
            rows, f"{key} file", end.file, PICTURE, rows.field(), lambda path: session.apply(SetInput(name, file=path))
        )
        if edit:
            rows.act(lambda: session.apply(SetInput(name, file=str(edit.value))))
        if not bound:
            self._files.about(rows, end.file, PICTURE, end.layer)
        rows.name(f"{key} layer", translate("layer", "value"), doc=translate("The layer of that file"))
        layer = self._files.layer(rows, f"{key} layer", end.file, end.layer, rows.field())
        if layer:
            rows.act(lambda: session.apply(SetInput(name, layer=str(layer.value))))
        if end.kind.is_color:
            self._space(rows, port, end, bool(bound))
        if Pattern.parse(end.file):
            self._draw_missing_choice(rows, port, end)
        rows.name(
            f"{key} default",
            translate("default", "value"),
            doc=translate("The value if nothing is linked, bound or read"),
        )
        edit_of_default = self._default(rows, name, end, rows.field())
        if edit_of_default:
            rows.act(lambda: session.apply(SetInput(name, default=edit_of_default.value, merge=edit_of_default.merge)))
        self._text(
            rows,
            f"{key} doc",
            translate("description", "value"),
            end.doc,
            lambda doc: session.apply(SetInput(name, doc=doc)),
            translate("A description, shown as a tooltip"),
        )

    def _space(self, rows: Rows, port: Port, end: Input, bound: bool) -> None:
        """Draw the color space of the file of an input."""
        session, key = rows.context.session, f"{port} space"
        rows.name(key, translate("color space", "value"), doc=translate("The color space of the file"))
        space = space_field(rows, self._fields, key, end.color_space, rows.field())
        rows.record(key)
        if space:
            rows.act(lambda: session.apply(SetInput(port.socket, color_space=str(space.value))))
        if not bound:
            self._files.space(rows, end.file, end.layer, end.color_space)

    def _default(self, rows: Rows, name: str, end: Input, width: float) -> Edit | None:
        """Draw the default with a button that removes it, or a button that sets one."""
        session, key = rows.context.session, f"{Port(INPUTS, name)} default"
        channels = end.width
        if end.default is None:
            if imgui.button(make_label(translate("None"), f"{key}"), (width, 0.0)):
                start: Scalar = 0.0 if channels == 1 else (0.0,) * channels
                rows.act(lambda: session.apply(SetInput(name, default=start)))
            tip(translate("No default: link something, bind or choose a file. Click to set a default"))
            return None
        side = imgui.get_frame_height()
        color = end.kind.is_color
        if isinstance(end.default, tuple):
            fields, room = self._fields, width - side
            edit = (
                color_field(fields, key, end.default, _NUMBER, room, eyedropper=False)
                if color
                else row_of_numbers(fields, key, end.default, _NUMBER, room, _AXES[:channels])
            )
        else:
            edit = number_field(self._fields, key, float(end.default), _NUMBER, width - side)
        imgui.same_line(0.0, 0.0)
        if rows.icon(icons.ICON_FA_XMARK, f"remove {key}", translate("No default")):
            rows.act(lambda: session.apply(SetInput(name, default=None)))
        return edit

    def _output(self, rows: Rows, port: Port, end: Output) -> None:
        context, name, key = rows.context, port.socket, str(port)
        session = context.session
        rows.name(
            key,
            translate("from", "value"),
            doc=translate("What is linked to this output"),
            color=rows.palette.kinds[end.kind],
        )
        source, width = session.graph.links.get(port), rows.field()
        if source is not None:
            link_chip(rows, port, source, width)
        else:
            imgui.align_text_to_frame_padding()
            imgui.text_disabled(translate("not linked"))
        self._text(
            rows,
            f"{key} layer",
            translate("layer", "value"),
            end.layer,
            lambda layer: session.apply(SetOutput(name, layer=layer)),
            translate("The name of the layer in a file with several layers"),
            hint=name,
        )
        if end.kind is Kind.IMAGE:
            rows.name(
                f"{key} view",
                translate("view", "value"),
                doc=translate("The view that shows it, unless you choose another one in the viewer"),
            )
            views = ("", *list_views(manager=find_color_manager(context)))
            index = choose(
                self._fields,
                f"{key} view",
                end.view or translate(DEFAULT_VIEW),
                (translate(DEFAULT_VIEW), *views[1:]),
                rows.field(),
            )
            rows.record(f"{key} view")
            if index is not None:
                rows.act(lambda: session.apply(SetOutput(name, view=views[index])))
        doc = translate(
            "EXR files get the pixels beyond the frame as well, as far as the overscan of the project goes."
        )
        rows.name(f"{key} overscan", translate("overscan", "value"), doc=doc, changed=end.overscan)
        rows.field()
        is_changed, overscan = imgui.checkbox(f"##{key} overscan", end.overscan)
        rows.record(f"{key} overscan")
        if is_changed:
            rows.act(lambda: session.apply(SetOutput(name, overscan=overscan)))

    def _text(self, rows: Rows, key: str, label: str, text: str, then: Then, doc: str, hint: str = "") -> None:
        draw_text(rows, self._fields, key, label, text, then, doc, hint)


def draw_text(
    rows: Rows,
    fields: Fields,
    key: str,
    label: str,
    text: str,
    then: Then,
    doc: str = "",
    hint: str = "",
    lines: int = 0,
) -> None:
    """Draw a row with a text field."""
    rows.name(key, label, doc=doc)
    edit = text_field(fields, key, text, _TEXT, rows.field(), hint=hint, lines=lines)
    rows.record(key)
    if edit:
        rows.act(lambda: then(str(edit.value)))
