"""The window *Match*: which picture is the reference, which values may change, and how far the search is.

It is no dialog: the viewer behind it shows each better picture, and one may go on working.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from imgui_bundle import ImVec2, imgui

from ...authoring.background.graph_fit import FitChoices, FitOutcome
from ...fit.libraries import HOW_TO_INSTALL, has_fit_libraries
from ...language.translation import mark, translate, translate_plural
from ..shared.dialogs import Browse
from ..theme.style import ui_scale
from ..toolkit.buttons import main_button
from ..toolkit.dialogs import escape_pressed, note_lists
from ..toolkit.fields import combo, label, measure_labels
from ..toolkit.labels import make_label, translate_label
from ..toolkit.places import record
from ..toolkit.words import draw_dim, draw_wrapped
from .search import MatchSearch

if TYPE_CHECKING:
    from .context import MatchContext

_WIDTH, _LABELS, _TABLE_HEIGHT = 440.0, 92.0, 180.0
_TITLES = ("Reference", "Values", "Compare", "Time")
_TIMES = {mark("15 seconds"): 15.0, mark("1 minute"): 60.0, mark("5 minutes"): 300.0}
_COMPARISONS = {mark("the same frame, pixel by pixel"): "pixels", mark("the look of any picture"): "look"}


class MatchWindow:
    """Asks what to match, shows how it goes, and what came out."""

    def __init__(self, context: MatchContext) -> None:
        self._context = context
        self._search = MatchSearch(context.session)
        self._reference: Path | None = None
        self._patterns = ""
        self._comparison, self._time = next(iter(_COMPARISONS)), next(iter(_TIMES))
        self._was_open, self._height = False, 0.0
        self._can_fit = has_fit_libraries()

    def close(self) -> None:
        """Stop what runs."""
        self._search.end()

    def draw(self) -> None:
        """Draw the window, if it is open."""
        dialogs = self._context.dialogs
        if not dialogs.matches:
            if self._was_open:
                self._search.end()
            self._was_open = False
            return
        if not self._was_open:
            self._patterns, self._was_open = self._suggest_patterns(), True
        view, scale = imgui.get_main_viewport(), ui_scale()
        corner = ImVec2(view.pos.x + 24 * scale, view.pos.y + view.size.y - 104 * scale)
        imgui.set_next_window_pos(corner, imgui.Cond_.appearing.value, ImVec2(0.0, 1.0))
        imgui.set_next_window_size(ImVec2(min(_WIDTH * scale, view.size.x), 0))
        flags = imgui.WindowFlags_.no_docking | imgui.WindowFlags_.no_saved_settings | imgui.WindowFlags_.no_collapse
        title = make_label(translate("Match a reference"), "match")
        _, is_open = imgui.begin(title, True, int(flags))
        self._context.log.attempt(self._search.follow)
        if self._search.is_open:
            self._draw_search()
        else:
            self._draw_choices()
        self._stay_above(corner.y)
        is_left = escape_pressed() and not imgui.get_io().want_text_input
        note_lists()
        imgui.end()
        dialogs.matches = bool(is_open) and not is_left and dialogs.matches

    def _stay_above(self, bottom: float) -> None:
        """Move the window up when it grew beyond where it began; the user may move it anywhere."""
        place, height = imgui.get_window_pos(), imgui.get_window_size().y
        if height > self._height and place.y + height > bottom:
            imgui.set_window_pos(ImVec2(place.x, max(bottom - height, 0.0)))
        self._height = height

    # --- before ------------------------------------------------------------------------------------------------------

    def _suggest_patterns(self) -> str:
        """The values of those selected nodes that have some; without any the controls, else all values."""
        session = self._context.session
        patterns = [f"{id}.*" for id in session.root.nodes if id in session.selection]
        chosen = [pattern for pattern in patterns if self._search.count_numbers(pattern)[0]]
        return ", ".join(chosen or session.root.controls) or "*.*"

    def _draw_choices(self) -> None:
        palette, width = self._context.palette, measure_labels(map(translate, _TITLES), _LABELS)
        label(translate("Reference"), width)
        name = self._reference.name if self._reference else translate("Choose a picture...")
        if imgui.button(make_label(name, "match reference"), ImVec2(-1, 0)):
            title = translate("Choose the Reference")
            self._context.dialogs.browse = Browse(title, "image", self._choose_reference)
        record(self._context, "match reference")
        label(translate("Values"), width)
        imgui.set_next_item_width(-1)
        self._patterns = imgui.input_text("##match values", self._patterns)[1]
        record(self._context, "match values")
        label(translate("Compare"), width)
        self._comparison = self._draw_combo("match way", self._comparison, tuple(_COMPARISONS))
        label(translate("Time"), width)
        self._time = self._draw_combo("match time", self._time, tuple(_TIMES))
        count, fault = self._search.count_numbers(self._patterns)
        if fault:
            draw_wrapped(palette.error, fault)
        else:
            draw_dim(
                self._context,
                translate_plural(
                    "{count} number may change, in the range of its slider.",
                    "{count} numbers may change, in the ranges of their sliders.",
                    count,
                ),
            )
        record(self._context, "match state")
        if not self._can_fit:
            draw_wrapped(palette.error, HOW_TO_INSTALL)
        is_ready = bool(count) and self._can_fit and self._reference is not None
        if main_button(self._context, translate("Match"), "match start", enabled=is_ready):
            self._context.log.attempt(self._start)

    def _choose_reference(self, path: Path) -> None:
        self._reference = path

    def _draw_combo(self, name: str, current: str, choices: tuple[str, ...]) -> str:
        titles = {translate(choice): choice for choice in choices}
        chosen = combo(self._context, name, translate(current), tuple(titles))
        return titles.get(chosen, current)

    def _start(self) -> None:
        assert self._reference is not None
        frame = self._context.session.time.frame
        self._search.start(
            FitChoices(self._reference, self._patterns, _COMPARISONS[self._comparison], _TIMES[self._time], frame)
        )

    # --- while it runs, and after ------------------------------------------------------------------------------------

    def _draw_search(self) -> None:
        outcome = self._search.outcome
        if outcome is None:
            self._draw_progress()
        elif outcome.fault:
            draw_wrapped(self._context.palette.error, outcome.fault)
            record(self._context, "match state")
            if imgui.button(translate_label("Back")):
                self._search.put_back()
            record(self._context, "match back")
        else:
            self._draw_outcome(outcome)

    def _draw_progress(self) -> None:
        step = self._search.step
        imgui.progress_bar(min(step.done, 1.0) if step else 0.0, ImVec2(-1, 0), "")
        draw_dim(
            self._context,
            translate("{renders} pictures tried, error {error}", renders=step.renders, error=f"{step.error:.3g}")
            if step
            else translate("Starting..."),
        )
        record(self._context, "match state")
        if imgui.button(translate_label("Stop and keep the best")):
            self._search.stop()
        record(self._context, "match stop")
        imgui.same_line()
        if imgui.button(translate_label("Cancel")):
            self._search.put_back()
        record(self._context, "match cancel")

    def _draw_outcome(self, outcome: FitOutcome) -> None:
        before, after = outcome.delta_e or outcome.error
        name = "ΔE 2000" if outcome.delta_e else translate("error")
        draw_wrapped(
            self._context.palette.text,
            translate(
                "{name} from {before} to {after}, {renders} pictures in {seconds} s",
                name=name,
                before=f"{before:.3g}",
                after=f"{after:.3g}",
                renders=outcome.renders,
                seconds=f"{outcome.seconds:.0f}",
            ),
        )
        record(self._context, "match state")
        self._draw_values(outcome)
        if main_button(self._context, translate("Keep"), "match keep"):
            self._search.end()
        imgui.same_line()
        if imgui.button(translate_label("Put back")):
            self._search.put_back()
        record(self._context, "match back")

    def _draw_values(self, outcome: FitOutcome) -> None:
        """Draw each number before and after; those that the reference says little about are dim."""
        flags = imgui.TableFlags_.scroll_y | imgui.TableFlags_.row_bg | imgui.TableFlags_.sizing_stretch_prop
        rows = min(len(outcome.values) + 1, 8) * imgui.get_text_line_height_with_spacing() + 4 * ui_scale()
        if not imgui.begin_table("##match values", 3, int(flags), ImVec2(0, min(rows, _TABLE_HEIGHT * ui_scale()))):
            return
        for value in outcome.values:
            color = self._context.palette.text if value.is_determined else self._context.palette.dim
            for text in (value.name, f"{value.before:.4g}", f"{value.after:.4g}"):
                imgui.table_next_column()
                imgui.text_colored((*color, 1.0), text)
            if not value.is_determined:
                imgui.set_item_tooltip(translate("The reference says little about this number."))
        imgui.end_table()
