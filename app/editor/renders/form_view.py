"""The form for renders to files."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...authoring.render_queue.queue import QueuedFiles
from ...color.display import list_views
from ...graph.frames import format_frames
from ...language.translation import mark, translate
from ...media import holds_light
from ..shared.coloring import find_color_manager
from ..shared.declared_words import name_choice
from ..shared.dialogs import Browse
from ..theme.style import ui_scale, vec4
from ..toolkit.buttons import main_button, quiet_button, width_of_buttons
from ..toolkit.fields import combo, label, measure_labels
from ..toolkit.labels import make_label, translate_label
from ..toolkit.places import record
from ..toolkit.words import SMALL, cut_end, cut_middle, draw_dim, draw_wrapped, font, tip
from .form import DEPTHS, DITHERS, FILE_STEM, Extent, RenderForm, RenderTargets, Sizing, formats
from .wording import aim_text, exist_text

if TYPE_CHECKING:
    from .context import RendersContext

_LABELS = 80.0
_TITLES = ("Frames", "Files", "Fill", "Processes", "Format", "Size", "Precision", "Dither")
_SIZINGS: tuple[Sizing, ...] = ("full size", "scale", "size")
_LONGEST = 24
_PATTERN = "photos/*.jpg"
"""What the field for many files shows while it is empty."""


def draw_form(context: RendersContext, form: RenderForm) -> None:
    """Draw the choices of the form."""
    _draw_files(context, form)
    _draw_frames(context, form)
    _draw_options(context, form)


def draw_start(context: RendersContext, form: RenderForm, width: float) -> None:
    """Draw the files that would be written, and the button that begins a render, or lets it wait."""
    _draw_consequences(context, form, form.targets(imgui.get_time()))
    waits = bool(context.exports.unfinished)
    title = f"{icons.ICON_FA_FILM}  {translate('Add to the queue') if waits else translate('Render')}"
    is_ready = not form.targets(imgui.get_time()).fault
    if main_button(context, title, "render", enabled=is_ready, width=width):
        context.log.attempt(lambda: form.start())


def _label_width() -> float:
    """The width of the column of names, in units."""
    return measure_labels((*map(translate, _TITLES), translate("View", "color")), _LABELS)


def _draw_files(context: RendersContext, form: RenderForm) -> None:
    chosen_outputs = form.list_chosen_outputs()
    button = width_of_buttons(icons.ICON_FA_FOLDER_OPEN)
    for name in context.session.root.outputs:
        imgui.push_id(name)
        left, column = imgui.get_cursor_pos_x(), _label_width() * ui_scale()
        short_name = cut_end(name, column - imgui.get_frame_height() - imgui.get_style().item_spacing.x)
        changed, on = imgui.checkbox(make_label(short_name, "on"), name in chosen_outputs)
        record(context, f"render {name}")
        tip(name)
        if changed:
            form.chosen[name] = on
        imgui.begin_disabled(name not in chosen_outputs)
        imgui.same_line(left + column)
        imgui.set_next_item_width(imgui.get_content_region_avail().x - button - 4 * ui_scale())
        path = str(form.file(name))
        edited, path = imgui.input_text("##file", path)
        if edited:
            form.files[name] = path
        tip(path)
        record(context, f"render file {name}")
        imgui.same_line(0, 4 * ui_scale())
        if quiet_button(context, icons.ICON_FA_FOLDER_OPEN, f"choose {name}", translate("Choose the file to write")):
            chosen = partial(_take_file, context, form, name)
            file = form.file(name)
            context.dialogs.browse = Browse(
                translate("Render {name} to", name=name), "export", chosen, saving=True, name=file.name
            )
        imgui.end_disabled()
        imgui.pop_id()


def _take_file(context: RendersContext, form: RenderForm, output: str, path: Path) -> None:
    form.files[output] = str(path)
    form.extend(form.extent_of())


def _draw_frames(context: RendersContext, form: RenderForm) -> None:
    offered, extent = form.extents(), form.extent_of()
    labels: dict[str, Extent] = {_extent_text(extent, frames): extent for extent, frames in offered.items()}
    if chosen := choose(context, mark("Frames"), _extent_text(extent, offered[extent]), tuple(labels)):
        form.extend(labels[chosen])
    if extent == "listed frames":
        _draw_frame_list(context, form)
    if extent == "many files":
        _draw_many_files(context, form)
    if extent != "this frame":
        _draw_workers(context, form)


def _draw_workers(context: RendersContext, form: RenderForm) -> None:
    """Draw who shares the work: processes of this machine, or a cluster."""
    label(translate("Processes"), _label_width())
    half = (imgui.get_content_region_avail().x - imgui.get_style().item_spacing.x) / 2
    imgui.set_next_item_width(half)
    most = max(os.cpu_count() or 1, 1)
    imgui.begin_disabled(bool(form.cluster))
    form.jobs = min(max(imgui.slider_int("##jobs", form.jobs, 1, most)[1], 1), 256)
    imgui.end_disabled()
    record(context, "render jobs")
    tip(
        translate(
            "How many processes share the frames. Each needs its own memory on the device. A graph "
            "with temporal nodes is rendered by one process."
        )
    )
    imgui.same_line()
    imgui.set_next_item_width(-1)
    form.cluster = imgui.input_text_with_hint("##cluster", translate("or a cluster"), form.cluster)[1].strip()
    record(context, "render cluster")
    tip(
        translate(
            "The address of a Dask scheduler, whose workers share the frames, or {local} for four workers on this "
            "machine. Empty renders here.",
            local="local:4",
        )
    )


def _draw_many_files(context: RendersContext, form: RenderForm) -> None:
    """Draw the field for the files, and which input they fill."""
    inputs = form.list_file_inputs()
    name = form.many.input if form.many.input in inputs else inputs[0]
    label(translate("Files"), _label_width())
    imgui.set_next_item_width(-width_of_buttons(icons.ICON_FA_FOLDER_OPEN) - 4 * ui_scale())
    files = imgui.input_text_with_hint("##many", _PATTERN, form.many.files)[1]
    form.many = QueuedFiles(files, name)
    record(context, "render many files")
    tip(
        translate(
            "A folder, a pattern such as photos/**/*.jpg, or {list} for a text with one name in each line. The graph "
            "is rendered once for each file. In the name of what is written, {stem} stands for its name.",
            list="@files.txt",
            stem=FILE_STEM,
        )
    )
    imgui.same_line(0, 4 * ui_scale())
    doc = translate("Choose one of the files: all of its kind in its folder are rendered")
    if quiet_button(context, icons.ICON_FA_FOLDER_OPEN, "choose many files", doc):
        context.dialogs.browse = Browse(translate("Render All Files Like"), "image", partial(_take_folder, form))
    if len(inputs) > 1 and (chosen := choose(context, mark("Fill"), name, inputs)):
        form.many = QueuedFiles(files, chosen)


def _take_folder(form: RenderForm, path: Path) -> None:
    form.many = QueuedFiles(str(path.parent / f"*{path.suffix}"), form.many.input)


def _extent_text(extent: Extent, frames: tuple[int, ...]) -> str:
    if extent == "listed frames" or not frames:
        return name_choice(extent)
    return f"{name_choice(extent)}: {_short(frames)}"


def _short(frames: tuple[int, ...]) -> str:
    """The frames as a short text."""
    if len(frames) > 2 and frames == tuple(range(frames[0], frames[-1] + 1)):
        return f"{frames[0]}-{frames[-1]}"
    text = format_frames(frames[:100])
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}\u2026"


def _draw_frame_list(context: RendersContext, form: RenderForm) -> None:
    """Draw the field for a list of frames, checked while the user types."""
    label("", _label_width())
    imgui.set_next_item_width(-1)
    wrong = bool(form.list_fault)
    if wrong:
        imgui.push_style_color(imgui.Col_.text, vec4(context.palette.error))
    form.listed = imgui.input_text_with_hint("##listed", "1-24x2,40", form.listed)[1]
    if wrong:
        imgui.pop_style_color()
    record(context, "render frames")
    tip(translate("1-24; 1-24x2 for every second frame; 10-1 for backwards. Separate several with commas."))
    if wrong:
        imgui.indent(_label_width() * ui_scale())
        with font(context, "text", SMALL):
            draw_wrapped(context.palette.error, form.list_fault)
        record(context, "render list fault")
        imgui.unindent(_label_width() * ui_scale())


def _draw_options(context: RendersContext, form: RenderForm) -> None:
    kinds = {form.file(name).suffix.lower() for name in form.list_chosen_outputs()}
    format = kinds.pop() if len(kinds) == 1 else translate("mixed")
    if chosen := choose(context, mark("Format"), format, formats()):
        form.reform(chosen)
    if chosen := choose(context, mark("Size"), form.sizing, _SIZINGS, name_choice):
        form.sizing = next(sizing for sizing in _SIZINGS if sizing == chosen)
    if form.sizing == "scale":
        label("", _label_width())
        imgui.set_next_item_width(-1)
        form.scale = imgui.slider_float("##scale", form.scale, 0.05, 2.0, "x %.2f")[1]
    elif form.sizing == "size":
        label("", _label_width())
        imgui.set_next_item_width(-1)
        width, height = imgui.input_int2("##size", list(form.size))[1]
        form.size = (min(max(width, 1), 16384), min(max(height, 1), 16384))
    depth = dict(DEPTHS)
    if chosen := choose(context, mark("Precision"), depth[form.precision], tuple(depth.values()), translate):
        form.precision = next(name for name, text in DEPTHS if text == chosen)
    if not holds_light(f"file{format}"):
        own = translate("as the output states")
        if chosen := choose(
            context,
            mark("View", "color"),
            form.view or own,
            (own, *list_views(manager=find_color_manager(context))),
            sense="color",
        ):
            form.view = "" if chosen == own else chosen
        dithers = dict(DITHERS)
        if chosen := choose(context, mark("Dither"), dithers[form.dither], tuple(dithers.values()), translate):
            form.dither = next(name for name, text in DITHERS if text == chosen)
    label("", _label_width())
    form.resume = imgui.checkbox(translate_label("Resume"), form.resume)[1]
    record(context, "render resume")
    tip(
        translate(
            "Skip frames whose files are up to date: after a render that was stopped, or a change "
            "that affects only some frames."
        )
    )


def _draw_consequences(context: RendersContext, form: RenderForm, aim: RenderTargets) -> None:
    """Draw the files that would be written, and what prevents the render."""
    palette = context.palette
    if aim.fault:
        if aim.fault != form.list_fault:
            draw_wrapped(palette.error, aim.fault)
            record(context, "render fault")
        if len(form.frames()) > 1 and quiet_button(
            context,
            f"{icons.ICON_FA_HASHTAG}  {translate('Add a frame number to the name')}",
            "render number",
            "shot.####.exr",
        ):
            form.number()
        return
    draw_dim(context, cut_middle(aim_text(aim), imgui.get_content_region_avail().x))
    record(context, "render aim")
    tip(aim.first if aim.files == 1 else f"{aim.first}\n{aim.last}")
    if not aim.exist:  # a render writes its first file: the line that counts them has its room, and nothing moves
        imgui.dummy(ImVec2(0.0, imgui.get_frame_height()))
    else:
        imgui.align_text_to_frame_padding()
        draw_wrapped(palette.dim if form.resume else palette.warning, exist_text(aim, form.resume))
        record(context, "render exists")
        if not form.resume:
            imgui.same_line()
            if imgui.get_content_region_avail().x < width_of_buttons(translate("Resume instead")):
                imgui.new_line()
            doc = translate("Skip the files that are up to date")
            if quiet_button(context, translate("Resume instead"), "render resume instead", doc):
                form.resume = True


def choose(
    context: RendersContext,
    title: str,
    current: str,
    choices: tuple[str, ...],
    show: Callable[[str], str] = str,
    sense: str = "",
) -> str:
    """Draw a labelled choice; returns what was chosen in this frame, or ""."""
    label(translate(title, sense), _label_width())
    return combo(context, title, current, choices, show=show)
