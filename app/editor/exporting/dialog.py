"""The dialog *Export*: which format, with which options, and whether the document can be exported to it."""

from __future__ import annotations

import tempfile
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING

from imgui_bundle import ImVec2, imgui
from msgspec.structs import replace

from ...authoring.background.graph_export import ExportChoices, ExportOutcome, GraphExport
from ...export.kinds import KINDS
from ...graph import OUTPUTS, Port
from ...language.translation import translate
from ..shared.dialogs import Browse
from ..theme.style import ui_scale
from ..toolkit.buttons import main_button, measure_buttons
from ..toolkit.dialogs import backdrop, dialog, escape_pressed
from ..toolkit.fields import combo, label, measure_labels
from ..toolkit.labels import make_label, translate_label
from ..toolkit.places import record
from ..toolkit.words import draw_dim, draw_wrapped, font

if TYPE_CHECKING:
    from ...authoring.session import Session
    from ...graph import Graph
    from .context import ExportContext

_LABELS = 120.0
_TITLES = ("Format", "Nodes", "Output", "Size", "Frames", "Colors", "Encoding", "Range")
_TABLES = ("cube", "clf", "png")
_PAGES = ("web", "glsl", "wgsl", "reshade", "godot", "unity")
_ENCODINGS = ("usual", "linear", "srgb")
_REST = 0.4
"""Seconds after the last change until the document is tried: a size is typed in several letters."""


class ExportDialog:
    """Tries the export as soon as a kind is chosen, into a temporary folder: so a refusal is seen before a file is
    asked for, and a page can be looked at.
    """

    def __init__(self, context: ExportContext) -> None:
        self._context = context
        self._choices = ExportChoices("web")
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self._trial: GraphExport | None = None
        self._export: GraphExport | None = None
        self._tried: tuple[Graph, ExportChoices] | None = None
        self._changed_at = 0.0
        self._count = 0

    def close(self) -> None:
        """Stop what runs, and remove the temporary files."""
        for export in (self._trial, self._export):
            if export is not None:
                export.stop()
        self._trial = self._export = self._tried = None
        if self._folder is not None:
            self._folder.cleanup()
            self._folder = None

    def draw(self) -> None:
        """Draw the dialog, if it is open."""
        dialogs = self._context.dialogs
        if "export" not in dialogs.open:
            self._stop()
            return
        covered = dialogs.browse is not None
        close = backdrop(self._context, "export") and not covered
        with dialog(self._context, "Export", (620, 0), top=0.4):
            with font(self._context, "bold", 18.0):
                imgui.text_unformatted(translate("Export"))
            imgui.dummy(ImVec2(0, 2 * ui_scale()))
            before = self._choices
            self._draw_choices()
            if self._choices != before:
                self._changed_at = imgui.get_time()
            self._try()
            self._draw_state()
            cancelled = self._draw_buttons()
            if not covered:
                close = close or cancelled or escape_pressed()
        if close:
            dialogs.open.discard("export")

    # --- parts -------------------------------------------------------------------------------------------------------

    def _draw_choices(self) -> None:
        label(translate("Format"), _label_width())
        titles = {f"{kind.name}: {kind.title}": kind.name for kind in KINDS.values()}
        current = next(title for title, name in titles.items() if name == self._choices.kind)
        if chosen := combo(
            self._context,
            "export kind",
            current,
            tuple(titles),
            show=lambda title: f"{titles[title]}: {translate(KINDS[titles[title]].title)}",
        ):
            self._choices = ExportChoices(titles[chosen], self._choices.node, self._choices.selection)
        self._draw_selection()
        if not self._choices.selection:
            self._draw_output()
        if self._choices.kind in _PAGES:
            self._draw_page_options()
        elif self._choices.kind in _TABLES:
            self._draw_table_options()

    def _draw_selection(self) -> None:
        """Draw whether only selected nodes are exported, where some are selected."""
        session = self._context.session
        ids = ",".join(sorted(element for element in session.selection if element in session.root.nodes))
        if not ids:
            self._choices = replace(self._choices, selection="")
            return
        label(translate("Nodes"), _label_width())
        is_limited = imgui.checkbox(translate_label("only the selected ones"), bool(self._choices.selection))[1]
        record(self._context, "export selected")
        self._choices = replace(self._choices, selection=ids if is_limited else "")

    def _draw_output(self) -> None:
        """Draw which output is exported, where there are several."""
        nodes = list_outputs(self._context.session)
        if self._choices.node not in nodes.values():
            self._choices = replace(self._choices, node=next(iter(nodes.values()), ""))
        if len(nodes) > 1:
            label(translate("Output"), _label_width())
            current = next(title for title, node in nodes.items() if node == self._choices.node)
            if chosen := combo(self._context, "export output", current, tuple(nodes)):
                self._choices = replace(self._choices, node=nodes[chosen])

    def _draw_page_options(self) -> None:
        label(translate("Size"), _label_width())
        size = self._draw_text("size", self._choices.size, translate("that of the graph, or such as 960x540"))
        label(translate("Frames"), _label_width())
        current = self._context.session.time.frame
        is_single = imgui.checkbox(
            make_label(translate("only frame {current}", current=current), "export frame"),
            self._choices.frame is not None,
        )[1]
        record(self._context, "export frame")
        self._choices = replace(self._choices, size=size, frame=current if is_single else None)

    def _draw_table_options(self) -> None:
        label(translate("Colors"), _label_width())
        imgui.set_next_item_width(96 * ui_scale())
        side = imgui.input_int(translate_label("along each side"), self._choices.lut_size or 33, 0)[1]
        record(self._context, "export side")
        label(translate("Encoding"), _label_width())
        encoding = combo(self._context, "export encoding", self._choices.encoding or "usual", _ENCODINGS)
        label(translate("Range"), _label_width())
        color_range = self._draw_text(
            "range", self._choices.color_range, translate("0 to 16, or two numbers such as 0,4")
        )
        chosen = self._choices.encoding if not encoding else "" if encoding == "usual" else encoding
        self._choices = replace(
            self._choices, lut_size=min(max(side, 2), 129), encoding=chosen, color_range=color_range
        )

    def _draw_text(self, name: str, text: str, hint: str) -> str:
        imgui.set_next_item_width(-1)
        text = imgui.input_text_with_hint(f"##export {name}", hint, text)[1]
        record(self._context, f"export {name}")
        return text.strip()

    def _draw_state(self) -> None:
        """Draw what is known of the chosen format: whether it can hold the document, and what was written."""
        palette = self._context.palette
        imgui.dummy(ImVec2(0, 4 * ui_scale()))
        export = self._export or self._trial
        outcome = export.outcome if export else None
        if export is None and self._tried is not None:
            draw_dim(self._context, translate("It cannot be tried: the log says why."))
        elif outcome is None:
            draw_dim(self._context, translate("Writing...") if self._export else translate("Trying..."))
        elif outcome.fault:
            draw_wrapped(palette.error, outcome.fault)
        else:
            draw_wrapped(
                palette.text,
                translate("Written: {output}", output=self._export.output)
                if self._export
                else translate("It can be exported."),
            )
            draw_wrapped(palette.dim, describe_figures(outcome))
            for note in outcome.notes:
                draw_wrapped(palette.warning, note)
        record(self._context, "export state")

    def _draw_buttons(self) -> bool:
        """Draw the buttons; True if Close was clicked."""
        width, trial = measure_buttons(translate("Close"), translate("Export...")), self._trial
        is_ready = trial is not None and trial.outcome is not None and not trial.outcome.fault
        imgui.dummy(ImVec2(0, 4 * ui_scale()))
        if self._choices.kind == "web":
            imgui.begin_disabled(not is_ready)
            if imgui.button(translate_label("Show in browser")) and trial is not None:
                self._context.log.attempt(lambda: self._show(trial.output))
            imgui.end_disabled()
            record(self._context, "export preview")
            imgui.same_line()
        room = imgui.get_content_region_avail().x - 2 * width - imgui.get_style().item_spacing.x
        imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + room)
        closed = imgui.button(translate_label("Close"), ImVec2(width, 0))
        record(self._context, "export close")
        imgui.same_line()
        if main_button(self._context, translate("Export..."), "export write", width=width, enabled=is_ready):
            self._ask()
        return closed

    # --- work --------------------------------------------------------------------------------------------------------

    def _try(self) -> None:
        """Export into a temporary folder if the document or the choices have changed, a moment after the last one."""
        trial_key = self._context.session.root, self._choices
        if trial_key == self._tried or imgui.get_time() - self._changed_at < _REST:
            return
        if self._trial is not None:
            self._trial.stop()
        self._tried, self._export = trial_key, None
        self._count += 1
        name = f"{self._context.session.name}{KINDS[self._choices.kind].ending}"
        self._trial = self._begin(self._make_folder() / name)

    def _ask(self) -> None:
        """Ask where to write, and write."""
        kind = KINDS[self._choices.kind]

        def write(path: Path) -> None:
            target = path if path.suffix or not kind.ending else path.with_suffix(kind.ending)
            self._export = self._begin(target)

        title = translate("Export to a folder") if not kind.ending else translate("Export as")
        name = f"{self._context.session.name}{kind.ending}"
        self._context.dialogs.browse = Browse(title, "export", write, saving=True, name=name)

    def _begin(self, output: Path) -> GraphExport | None:
        session = self._context.session

        def begin() -> GraphExport:
            bindings = {name: str(path) for name, path in session.bindings.items()}
            return GraphExport(session.root, self._choices, output, self._make_folder(), bindings, session.sandbox)

        return self._context.log.attempt(begin)

    def _make_folder(self) -> Path:
        """A temporary folder for each trial: a page that is shown in a browser stays until the editor ends."""
        if self._folder is None:
            self._folder = tempfile.TemporaryDirectory(prefix="halation-export-", ignore_cleanup_errors=True)
        folder = Path(self._folder.name) / f"{self._count}"
        folder.mkdir(exist_ok=True)
        return folder

    def _show(self, page: Path) -> None:
        if not webbrowser.open(page.as_uri()):
            self._context.log.add(translate("no browser can be opened: {page} is the page", page=page), "warning")

    def _stop(self) -> None:
        if self._trial is not None:
            self._trial.stop()
        self._trial = self._export = self._tried = None


def _label_width() -> float:
    """The width of the column of names, in units."""
    return measure_labels(map(translate, _TITLES), _LABELS)


def list_outputs(session: Session) -> dict[str, str]:
    """What can be exported, by title: for each output of the graph, and for what the viewer shows, the node that
    `halation export --node` names. It is "" for the only output.
    """
    graph, viewed = session.root, session.views.find_root_port()
    sources = {name: graph.links.get(Port(OUTPUTS, name)) for name in graph.outputs}
    nodes = {f"{OUTPUTS}.{name}": f"{source}" for name, source in sources.items() if source is not None}
    if len(graph.outputs) == 1:
        nodes = dict.fromkeys(nodes, "")
    if viewed is not None and viewed.node in graph.nodes:
        nodes[f"{viewed}, as in the viewer"] = f"{viewed}"
    return nodes


def describe_figures(outcome: ExportOutcome) -> str:
    """The figures of an export in one line."""
    figures = (
        f"{name.replace('_', ' ')} {number if isinstance(number, str) else f'{number:.4g}'}"
        for name, number in outcome.figures.items()
    )
    return ", ".join(figures)
