"""Who reads the environment of the process, who opens files, and who may do so outside of a sandbox."""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from halation.cli.program import WITHOUT_ROOT, Commands
from import_graph import ROOT

APP = ROOT / "app"

ENVIRONMENT = {
    "authoring/render_queue/queued_render.py": "the environment of a process that it starts",
    "cli/__init__.py": "settings of libraries, before they are loaded at the start of the process",
    "cli/doctor.py": "the name of the color config",
    "cli/helpers.py": "the environment of processes that it starts",
    "cli/outcome.py": "HALATION_DEBUG",
    "cluster/render_process.py": "the environment of a process that it starts",
    "cli/versions.py": "what the terminal and git say of colors",
    "cli/head_start.py": "whether a process watches this one",
    "cli/watched_copy.py": "where a copy that is watched writes its heartbeat",
    "cli/watchdog.py": "where a watched process, started or forked, writes its heartbeat",
    "color/management.py": "OCIO, the color config of the user, and how much OpenColorIO logs",
    "editor/window/opengl.py": "HALATION_WINDOW: whether the window is visible",
    "editor/window/window_library.py": "PYGLFW_LIBRARY, by which `glfw` knows the copy that it loads",
    "language/system_language.py": "the language of the user",
    "media/limits.py": "HALATION_MAX_PIXELS",
    "regression/parallel.py": "the threads of a worker process, at its start",
    "renderer/execution/progress_beacon.py": "where the watching process reads the heartbeat",
    "renderer/opengl/driver_settings.py": "what Mesa reads from nowhere else, while a context is opened",
    "renderer/opengl/shader_cache.py": "where Mesa keeps what it has compiled, which it reads from nowhere else",
    "renderer/opengl/warming.py": "the device that the user chose",
    "resources/library_messages.py": "what libraries are told to print",
    "resources/machine.py": "whether there is a display",
    "resources/program.py": "HALATION_PROGRAM, the path of the single file that was started",
    "resources/sandbox.py": "HALATION_ROOT",
    "resources/today.py": "SOURCE_DATE_EPOCH, the date of builds that are to be the same each time",
    "resources/user_folders.py": "HALATION_STATE and HALATION_PATH, the user's folders",
}
"""Modules that read or change the environment, and what for. What a graph decides is never among it."""

OPENERS = {
    "resources/input_files.py": "it checks the sandbox and the kind of file first: everything else reads through it",
    "resources/atomic_write.py": "it writes, and checks the sandbox and the kind of file first",
    "cli/__init__.py": "the null device, in place of a stream that is closed",
    "cli/head_start.py": "the start of the graph, which the command checks and reads again: only whether it has code",
    "cli/serve.py": "a copy of standard output, for replies alone",
    "cli/watchdog.py": "the same, where another process answers",
    "serving/service.py": "a thumbnail that it has just written to a temporary folder",
    "scripting/array_file.py": "the file for arrays of a client, after it has checked the sandbox and the kind of file",
    "export/shipped_files.py": "texts of Halation that exports copy",
    "cli/chunk_worker.py": "small files that travel with chunks, in a temporary folder of ours",
    "cluster/versions.py": "the code of nodes that are installed",
    "desktop/entries.py": "the icon of Halation",
    "cli/demo.py": "samples of Halation, copied to where the user says",
    "cli/git_setup.py": "the configuration of git",
    "cli/outcome.py": "the null device, in place of a stream that is closed",
    "resources/heartbeat.py": "the heartbeat, in a temporary folder of ours",
    "authoring/preferences.py": "the editor's own file",
    "authoring/preset_versions.py": "presets in folders of the user",
    "resources/user_folders.py": "the editor's own file",
    "authoring/recovery/recovery.py": "the editor's own files",
    "authoring/recovery/file_locks.py": "the editor's own files",
    "authoring/recovery/claims.py": "the editor's own files",
    "color/dithering.py": "shaders of Halation",
    "color/management.py": "the config of $OCIO, which the user trusts",
    "custom_nodes/isf/glsl.py": "shaders of Halation",
    "editor/browser/places.py": "the list of mounted disks",
    "editor/workflows/flipbook.py": "it opens a flipbook, and no file",
    "compiler/library.py": "shaders of Halation and of plug-ins",
    "media/pictures/stored.py": "a picture in a temporary folder of ours; others after `check_file`",
    "media/pictures/open.py": "pictures, after `check_file`",
    "media/pictures/row_writer.py": "the temporary file of a `Replacement`",
    "media/pictures/writer.py": "the temporary file of a `Replacement`",
    "media/pictures/thumbnail.py": "pictures after `check_file`, and the temporary file of a `Replacement`",
    "media/comparison/contact_sheet.py": "the temporary file of a `Replacement`",
    "language/translation.py": "catalogues of Halation",
    "media/lettering/fonts.py": "fonts of Halation",
    "media/meshes/load.py": "trimesh is given an open file",
    "media/video/index.py": "videos, after `check_file`",
    "media/video/writer.py": "the temporary file of a `Replacement`",
    "color/config_files.py": "archives of configs, after `check_file`",
    "color/gpu_programs.py": "tables, after `may_name_files` has opened them",
    "media/pictures/wide_integers.py": "a picture that it writes into a temporary folder",
    "resources/machine.py": "what the system says of a process",
    "regression/suites.py": "a method of tables of TOML has such a name",
    "regression/toml_tables.py": "the same",
    "regression/report.py": "the template of the page",
    "fit/report.py": "the template of the page",
    "renderer/execution/progress_beacon.py": "the heartbeat",
    "export/python/library.py": "functions that come with the package",
    "renderer/opengl/cache_archive.py": "files of the driver's cache",
    "renderer/opengl/shader_cache.py": "hashes of programs, in the cache of the driver, which writes there too",
    "watch/reloading.py": "the modules of Halation",
}
"""Modules that open files by themselves, and which. All others go through `resources`."""

UNRESTRICTED = {
    "resources/sandbox.py": "its home",
    "authoring/background/shader_files.py": "folders of shaders that the user's preferences name",
    "authoring/document_pictures.py": "small pictures that the editor keeps",
    "serving/service.py": "a thumbnail, in a temporary folder of its own",
    "authoring/library.py": "presets in folders that the user names",
    "authoring/flipbook.py": "a graph that is made of text and names pictures that the user chose",
    "authoring/preferences.py": "the editor's own file",
    "authoring/recovery/recovery.py": "the editor's own files",
    "cli/burn_in.py": "a preset",
    "cli/demo.py": "presets",
    "cli/gallery.py": "presets",
    "reference/specimen.py": "a provider that reads no files",
    "reference/node_page.py": "files of presets of Halation",
    "cli/thumbnail.py": "the picture that it writes where the file manager says",
    "desktop/installation.py": "files of Halation, in the folder of the desktop",
    "color/management.py": "the config of $OCIO, which the user trusts",
    "editor/library/dialog.py": "a preset in a folder of the user",
    "editor/start/gallery.py": "small pictures of presets",
    "editor/start/recent.py": "small pictures that the editor keeps",
    "editor/toolkit/thumbnails.py": "small pictures that the editor keeps",
    "editor/window/screenshot.py": "where the user of the editor says",
    "renderer/opengl/cache_archive.py": "files of the driver's cache, by names that it has checked",
    "renderer/calibration.py": "two nodes of ours, which name no file",
    "watch/watching.py": "shaders and nodes of Halation",
}
"""Modules that may open files outside of every sandbox, and which."""

WITHOUT_FILES = ("schema", "jobs", "desktop", "thumbnail")
"""Commands that need no sandbox of the process: they read no file, or make a sandbox of their own."""

PROCESS = {
    "__init__.py": "Halation from Python: a sandbox only where HALATION_ROOT asks for one",
    "cli/options.py": "all commands with --root",
    "regression/plugin.py": "tests of pytest",
    **{f"cli/{name.replace('-', '_')}.py": why for name, why in WITHOUT_ROOT.items() if name not in WITHOUT_FILES},
}
"""Modules that make the sandbox of the process."""

CHANGERS = {
    "authoring/document_pictures.py": "small pictures that the editor keeps",
    "authoring/recovery/claims.py": "the editor's own files",
    "authoring/recovery/recovery.py": "the editor's own files",
    "cli/chunk_worker.py": "a temporary folder of a worker",
    "cli/demo.py": "the folder whose parent the command has checked",
    "desktop/installation.py": "files of Halation, in the folder of the desktop",
    "editor/browser/listing.py": "where the user of the editor says",
    "editor/exporting/dialog.py": "where the user of the editor says",
    "editor/toolkit/thumbnails.py": "small pictures that the editor keeps",
    "editor/window/opening.py": "the editor's own files",
    "renderer/calibration.py": "the cache of measured devices",
    "renderer/jobs/shared_results.py": "a folder beside the output, which was checked",
    "renderer/opengl/cache_archive.py": "the driver's cache",
    "renderer/opengl/shader_cache.py": "the driver's cache",
    "resources/atomic_write.py": "temporary files that another process has left",
    "resources/library_names.py": "a link in a temporary folder",
    "serving/listening.py": "a socket that nobody listens to, in a place that was checked",
}
"""Modules with functions that make or remove files or folders and see no sandbox, and which."""

CHANGING_CALLS = frozenset({"mkdir", "makedirs", "remove", "rmdir", "rmtree", "symlink_to", "unlink"})

CALLS = frozenset({"open", "read_bytes", "read_text", "write_bytes", "write_text", "fdopen", "copyfile", "load_scene"})
CALLS |= {"CreateFromFile", "FileTransform", "ImageBuf"}
"""Functions and methods that open files."""

PATHLESS = frozenset({"read_text", "read_bytes"})
"""Names that our own functions have too; these take a sandbox."""


@cache
def trees() -> dict[str, ast.AST]:
    return {str(path.relative_to(APP)): ast.parse(path.read_text("utf-8")) for path in APP.rglob("*.py")}


@cache
def list_names() -> dict[str, set[str]]:
    """Each name that is used, as a variable, an attribute or in an import, and the modules that use it."""
    homes = defaultdict[str, set[str]](set)
    for file, tree in trees().items():
        for node in ast.walk(tree):
            if isinstance(node, ast.Name):
                homes[node.id].add(file)
            elif isinstance(node, ast.Attribute):
                homes[node.attr].add(file)
            elif isinstance(node, ast.alias):
                homes[node.name].add(file)
    return homes


def find_names(name: str) -> set[str]:
    """The modules that have a name."""
    return list_names().get(name, set())


def opens_file(call: ast.Call) -> bool:
    """True for a call that opens a file by a path, as far as its text tells."""
    function = call.func
    name = function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")
    if name not in CALLS or any("sandbox" in ast.unparse(item) for item in (*call.args, *call.keywords)):
        return False
    if name == "ImageBuf":
        return bool(call.args) and "str(" in ast.unparse(call.args[0])
    if name == "open":
        owner = ast.unparse(function.value) if isinstance(function, ast.Attribute) else ""
        return not any(word in owner for word in ("session", "dialogs", "commands", "flipbook", "webbrowser", "editor"))
    return True


def find_openers() -> Iterator[str]:
    for file, tree in trees().items():
        if any(isinstance(node, ast.Call) and opens_file(node) for node in ast.walk(tree)):
            yield file


def test_the_environment_is_read_in_few_places() -> None:
    used = find_names("environ") | find_names("getenv") | find_names("putenv") | find_names("environb")
    assert used == ENVIRONMENT.keys()


def test_files_are_opened_in_few_places() -> None:
    openers = set(find_openers())
    assert not openers - OPENERS.keys(), "open files through resources/input_files.py, with a sandbox"
    assert not OPENERS.keys() - openers, "these open no files by themselves: take them off the list"


def find_changers() -> Iterator[str]:
    for file, tree in trees().items():
        for node in ast.walk(tree):
            if not isinstance(node, ast.FunctionDef):
                continue
            calls = (call.func for call in ast.walk(node) if isinstance(call, ast.Call))
            changes = (call for call in calls if isinstance(call, ast.Attribute) and call.attr in CHANGING_CALLS)
            is_changing = any(
                call.attr != "remove" or ast.unparse(call.value).split(".")[-1] == "os" for call in changes
            )
            if is_changing and "sandbox" not in ast.unparse(node):
                yield file


def test_folders_are_made_in_few_places() -> None:
    changers = set(find_changers())
    assert not changers - CHANGERS.keys(), "ask the sandbox before something is made or removed"
    assert not CHANGERS.keys() - changers, "these make nothing without a sandbox: take them off the list"


def test_few_may_do_without_a_sandbox() -> None:
    assert find_names("UNRESTRICTED") == UNRESTRICTED.keys()
    assert find_names("read_process_sandbox") == PROCESS.keys() & {*trees()}


def test_caches_are_emptied_where_they_are() -> None:
    """Whoever wants something to be read again calls a function beside the cache."""
    homes = {"app/compiler/library.py", "nodes/__init__.py"}
    files = [path for top in ("app", "nodes") for path in (ROOT / top).rglob("*.py")]
    assert {str(path.relative_to(ROOT)) for path in files if "cache_clear" in path.read_text("utf-8")} == homes


def test_no_sandbox_has_a_default() -> None:
    """Forgetting it is an error of types, and not a hole."""
    for file, tree in trees().items():
        for node in ast.walk(tree):
            if not isinstance(node, ast.FunctionDef):
                continue
            arguments = node.args
            with_default = [
                *zip(reversed((*arguments.posonlyargs, *arguments.args)), reversed(arguments.defaults), strict=False),
                *(
                    (arg, default)
                    for arg, default in zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True)
                    if default
                ),
            ]
            assert not [arg.arg for arg, _ in with_default if arg.arg == "sandbox"], f"{file}: {node.name}"


def test_every_command_is_handed_its_sandbox() -> None:
    for name in set(Commands()) - set(WITHOUT_ROOT):
        tree = trees()[f"cli/{name.replace('-', '_')}.py"]
        command = next(
            node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef) and node.name == name.replace("-", "_")
        )
        assert "sandbox" in {argument.arg for argument in command.args.kwonlyargs}, name
        assert Path(APP, "cli", f"{name.replace('-', '_')}.py").is_file()
