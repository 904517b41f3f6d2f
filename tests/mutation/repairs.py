"""Repairs of holes, each with the fault that undoes it and the test that must notice.

A security fix whose test passes without it protects nothing, and is lost with the next rewrite of its file. So each is
undone here in the fewest words, and `run.py --repairs` shows each fault to its test.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from mutation.mutants import Mutant


@dataclass(frozen=True)
class Repair:
    """What was mended, and how it is undone: `old` stands once in the file, and `new` is the fault."""

    name: str
    file: str
    old: str
    new: str
    test: str

    def find_mutant(self, source: str) -> Mutant:
        """The fault, in the present text of the file. Raises ValueError where that is not as it was."""
        if source.count(self.old) != 1:
            raise ValueError(f"{self.file}: {self.old!r} is there {source.count(self.old)} times: correct {__file__}")
        start = source.index(self.old)
        return Mutant(Path(self.file), start, start + len(self.old), self.new)


REPAIRS = (
    Repair(
        "light where alpha is 0",
        "app/color/transforms.py",
        "np.multiply(converted, alpha, out=converted, where=divisible)",
        "np.multiply(converted, alpha, out=converted)",
        "tests/color/test_alpha.py::test_every_space_in_and_out",
    ),
    Repair(
        "tables of tables stay inside",
        "app/color/config_files.py",
        "            self._sandbox = sandbox\n",
        '            self._sandbox = Sandbox("")\n',
        "tests/cli/test_root.py::test_references_of_tables",
    ),
    Repair(
        "tables of configs stay inside",
        "app/color/config_files.py",
        "    config.setConfigIOProxy(files)\n    return config, files",
        "    return config, files",
        "tests/cli/test_root.py::test_references_of_tables_of_a_config",
    ),
    Repair(
        "meshes stay inside",
        "app/media/meshes/load.py",
        "if asset.resolve().is_relative_to(folder) and asset.exists():",
        "if asset.exists():",
        "tests/cli/test_special_files.py::test_a_mesh_follows_no_link_out",
    ),
    Repair(
        "whole numbers are divided safely",
        "app/glsl/divisions.py",
        "if not any(token.text in _DIVIDERS for token in tokens):",
        "if tokens:",
        "tests/custom_nodes/test_divisions.py",
    ),
    Repair(
        "sizes of code are bounded",
        "app/custom_nodes/securing.py",
        "        check_size(expanded, types)\n",
        "",
        "tests/custom_nodes/test_bounds.py",
    ),
    Repair(
        "code runs in a process that is watched",
        "app/cli/watchdog.py",
        "if any(map(needs_watchdog, graphs)) and not",
        "if not any(map(needs_watchdog, graphs)) and not",
        "tests/cli/test_watchdog.py::test_code_that_ends_its_process",
    ),
    Repair(
        "the time limit holds",
        "app/resources/heartbeat.py",
        "elif heartbeat and 0.0 < self._timeout < time.monotonic() - self._since:",
        "elif heartbeat and 0.0 < self._timeout < self._since - time.monotonic():",
        "tests/cli/test_watchdog.py::test_the_timeout_holds_while_code_compiles",
    ),
    Repair(
        "the memory limit holds",
        "app/resources/heartbeat.py",
        "if heartbeat and memory - self._idle_memory > self._memory:",
        "if heartbeat and memory - self._idle_memory > 64 * self._memory:",
        "tests/cli/test_watchdog.py::test_the_memory_limit_holds_while_code_compiles",
    ),
    Repair(
        "long keys are refused",
        "app/document/syntax.py",
        " and max(map(len, plain), default=0) <= MAX_KEY",
        "",
        "tests/lint/test_sizes.py::test_what_is_too_large_is_refused",
    ),
    Repair(
        "deep brackets are refused",
        "app/document/syntax.py",
        "    if max(accumulate(map(_STEPS.__getitem__, steps)), default=0) > MAX_NESTING:",
        "    if max(accumulate(map(_STEPS.__getitem__, steps)), default=0) < 0:",
        "tests/lint/test_sizes.py::test_what_is_too_large_is_refused",
    ),
    Repair(
        "check is linear: loops",
        "app/graph/walk.py",
        "            elif after not in done and after in steps:",
        "            elif after in steps:",
        "tests/graph/test_walk.py::test_many_ways_are_walked_once",
    ),
    Repair(
        "check is linear: suggestions",
        "app/resources/suggestions.py",
        "    left[0] -= cost\n",
        "",
        "tests/lint/test_sizes.py",
    ),
    Repair(
        "check is linear: code",
        "app/document/code.py",
        "self.letters += max(len(code.text) + len(code.vertex), limits.LEAST_CODE)",
        "self.letters += 0",
        "tests/lint/test_sizes.py::test_the_code_of_a_graph_is_bounded",
    ),
    Repair(
        "standard input is bounded",
        "app/cli/options.py",
        "sys.stdin.buffer.read(MAX_BYTES + 1)",
        "sys.stdin.buffer.read()",
        "tests/lint/test_sizes.py::test_standard_input_is_bounded_as_files_are",
    ),
    Repair(
        "only files are replaced",
        "app/resources/atomic_write.py",
        "    if kind := find_special_kind(mode):",
        "    if kind := find_special_kind(stat.S_IFREG | mode * 0):",
        "tests/cli/test_special_files.py::test_no_writer_replaces_what_is_no_file",
    ),
    Repair(
        "check looks into nothing outside",
        "app/lint/compiled.py",
        "with open_file(path, sandbox) as file:",
        "with open_file(path, Sandbox(None)) as file:",
        "tests/cli/test_check.py::test_what_lies_outside_of_the_root_is_not_looked_into",
    ),
    Repair(
        "chromaticities are converted",
        "app/media/pictures/color_hints.py",
        "return tuple(float(number) for number in numbers)",
        "return ()",
        "tests/color/test_headers.py::test_chromaticities_are_those_of_the_space",
    ),
    Repair(
        "white of 24 and 32 bits is 1",
        "app/media/pictures/wide_integers.py",
        "return (block / np.float64(2**32 - 1)).astype(np.float32)",
        "return block.astype(np.float32)",
        "tests/media/test_depths.py::test_unsigned",
    ),
    Repair(
        "an absent layer is refused",
        "app/inputs/layer_choice.py",
        '        return find_layer(info, "").name\n    return socket.layer\n',
        '        return find_layer(info, "").name\n    return find_layer(info, "").name\n',
        "tests/inputs/test_provider.py::test_an_absent_layer_is_refused_and_its_role_suggested",
    ),
    Repair(
        "layers are found by role",
        "app/inputs/layer_choice.py",
        "if role and (layer := analysis.find_layer(role)):",
        "if False and role and (layer := analysis.find_layer(role)):",
        "tests/inputs/test_provider.py::test_layers_are_found_by_role",
    ),
    Repair(
        "meshes without normals need no scipy",
        "app/media/meshes/load.py",
        "(angles * normals[:, axis : axis + 1])",
        "(normals[:, axis : axis + 1] + 0.0 * angles)",
        "tests/media/test_meshes.py::test_normals_are_those_of_trimesh",
    ),
    Repair(
        "no reader waits for a FIFO",
        "app/resources/input_files.py",
        "    if kind := find_special_kind(status.st_mode):",
        "    if kind := find_special_kind(stat.S_IFREG | status.st_mode * 0):",
        "tests/cli/test_special_files.py::test_no_reader_waits_for_what_is_no_file",
    ),
    Repair(
        "frames that run backwards are a fault of the graph",
        "app/scripting/arguments.py",
        "    if last < first:\n        raise GraphError(",
        "    if last < first - 10**9:\n        raise GraphError(",
        "tests/test_misuse.py::test_frames_that_run_backwards_are_a_fault_of_the_graph",
    ),
    Repair(
        "outlines that memory could not hold are refused",
        "app/compiler/lowering/outline_tables.py",
        "    if across * down * len(fills) > MOST_TILES:",
        "    if across * down * len(fills) > 2**10 * MOST_TILES:",
        "tests/test_misuse.py::test_outlines_that_memory_could_not_hold_are_refused",
    ),
    Repair(
        "frames of the API are whole numbers",
        "app/scripting/arguments.py",
        '    return check_frame(_whole_number("frame", frame))',
        "    return check_frame(frame)  # type: ignore[arg-type]",
        "tests/test_misuse.py",
    ),
    Repair(
        "names need not be UTF-8",
        "app/cli/__init__.py",
        'stream.reconfigure(errors="backslashreplace")',
        'stream.reconfigure(errors="strict")',
        "tests/cli/test_names.py::test_a_process_prints_them",
    ),
    Repair(
        "little memory is a sentence",
        "app/cli/outcome.py",
        "if any(words in str(fault) for words in _NO_MEMORY):",
        "if all(words in str(fault) for words in _NO_MEMORY):",
        "tests/cli/test_memory_limits.py::test_what_libraries_say_without_memory",
    ),
    Repair(
        "tags that no author wrote say nothing",
        "app/media/pictures/color_hints.py",
        "    if tag and tag.casefold() == _UNUSABLE.get(format):\n",
        "    if tag and tag == _UNUSABLE.get(format):\n",
        "tests/color/test_headers.py",
    ),
    Repair(
        "libraries print nothing",
        "app/resources/library_messages.py",
        "    with stream.replace():\n",
        "    if stream:\n",
        "tests/cli/test_faults.py::test_what_libraries_print_is_not_beside_the_sentence",
    ),
    Repair(
        "closed output is an error",
        "app/cli/__init__.py",
        "enumerate((os.O_RDONLY, os.O_RDONLY, os.O_WRONLY))",
        "enumerate((os.O_RDONLY, os.O_WRONLY, os.O_WRONLY))",
        "tests/cli/test_streams.py::test_every_command_that_prints",
    ),
    Repair(
        "all that is not finite is filled",
        "app/media/pictures/finite.py",
        "    if not has_non_finite(filled):\n        return filled\n    most",
        "    if filled is not None:\n        return filled\n    most",
        "tests/media/test_filling.py::test_all_values_of_half_floats",
    ),
    Repair(
        "any thread renders",
        "app/scripting/threads.py",
        "if is_main else _get_thread(os.getpid())",
        "if is_main else DrawingThread(threading.main_thread().ident or 0)",
        "tests/test_misuse.py::test_any_thread_renders",
    ),
    Repair(
        "expanded code is judged",
        "app/custom_nodes/glsl.py",
        "    _check_words(expanded)\n",
        "",
        "tests/custom_nodes/test_macros.py::test_forbidden_words_that_macros_make",
    ),
    Repair(
        "helpers may be called as channels",
        "app/custom_nodes/prefixes.py",
        ' and not (at and tokens[at - 1].text == ".")',
        "",
        "tests/custom_nodes/test_prefixes.py::test_a_helper_called_as_a_swizzle",
    ),
    Repair(
        "a frame far away is not walked to",
        "app/renderer/frame_renderer.py",
        "        if not self._memories.get((begin, begin)):\n            return begin if",
        "        if (begin, begin) not in self._memories:\n            return begin if",
        "tests/renderer/test_history.py::test_a_frame_far_away_is_not_walked_to",
    ),
    Repair(
        "a wrong pattern is a fault of the graph",
        "app/graph/problems.py",
        "        elif fault := sequence_fault(end.file):\n",
        '        elif fault := sequence_fault(""):\n',
        "tests/cli/test_faults.py::test_a_place_for_the_frame_that_is_too_wide_is_a_fault_of_the_graph",
    ),
    Repair(
        "no folder is made outside",
        "app/export/folder.py",
        "    if reason := sandbox.find_write_fault(folder):",
        "    if reason := sandbox.find_write_fault(folder) and None:",
        "tests/cli/test_special_files.py::test_folders_are_not_made_outside",
    ),
    Repair(
        "damaged archives are refused",
        "app/resources/archives.py",
        "LZMAError, NotImplementedError, OSError,",
        "NotImplementedError,",
        "tests/cli/test_cache.py::test_damaged_archives",
    ),
    Repair(
        "a socket takes the place of nothing",
        "app/serving/listening.py",
        "        _bind_socket(listener, path)\n        try:",
        "        try:\n            _bind_socket(listener, path)",
        "tests/cli/test_serve.py::test_what_is_there_is_not_lost_for_a_socket",
    ),
    Repair(
        "a stopped request of a stream is answered",
        "app/cli/watchdog.py",
        "                if not relay.fail_request(fault):\n",
        "                if relay is not None:\n",
        "tests/cli/test_serve.py::test_code_that_does_not_end_costs_one_request_of_a_stream",
    ),
    Repair(
        "all that is read is saved",
        "app/document/writing.py",
        '({"overscan": True} if end.overscan else {})',
        "{}",
        "tests/document/test_format.py::test_every_key_of_a_section_is_saved",
    ),
    Repair(
        "limits hold while code is written in WGSL",
        "app/export/wgsl/folder.py",
        "with beacon.announce(nodes.get(number, ())):",
        "with beacon.announce(()):",
        "tests/cli/test_watchdog.py::test_the_timeout_holds_while_wgsl_is_made",
    ),
    Repair(
        "a missing file is looked for once",
        "app/lint/compiled.py",
        "            self._refused_files[file] = key\n",
        "            pass\n",
        "tests/lint/test_sizes.py::test_a_file_that_is_missing_is_looked_for_once",
    ),
    Repair(
        "of many missing files only the first are looked for",
        "app/lint/compiled.py",
        "        if len(self.faults) > MAX_FINDINGS:\n",
        "        if len(self.faults) > 10**9:\n",
        "tests/lint/test_sizes.py::test_of_many_missing_files_the_first_are_looked_for",
    ),
    Repair(
        "patterns tell nothing of what lies outside",
        "app/resources/folders.py",
        '    sandbox.check(start or ".")\n',
        "",
        "tests/regression/test_reading.py::test_wildcards_tell_nothing_of_what_lies_outside_of_the_root",
    ),
    Repair(
        "patterns do not go in circles",
        "app/resources/folders.py",
        "elif entry.is_dir(follow_symlinks=False):",
        "elif entry.is_dir():",
        "tests/resources/test_folders.py::test_links_do_not_lead_in_circles",
    ),
    Repair(
        "curves of channels on a black panel",
        "app/editor/curves/frame.py",
        "if palette.is_dark",
        'if palette.name == "dark"',
        "tests/editor/curves/test_painting.py::test_curves_of_channels_have_the_color_of_their_channel",
    ),
)
