"""The GLSL library: shader files by name, what they include, and what their functions cost."""

from __future__ import annotations

import re
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from functools import cache, cached_property
from hashlib import blake2b
from itertools import chain
from pathlib import Path
from typing import ClassVar

from halation.nodes import plugins
from halation.shaders import folder
from msgspec import field

from ..errors import ShaderError
from ..glsl import GlslFunction, GlslText, parse
from ..graph.names import did_you_mean
from ..resources.record import Record
from ..resources.working_space import WorkingSpace

_ACCESSOR = re.compile(r"\w+_(?:at|near|raw|size)")

_LOOP_WORDS = frozenset({"for", "while", "do"})
_EXPENSIVE_WORDS = _LOOP_WORDS | frozenset({"pow", "exp", "log", "log2", "sin", "cos", "tan", "asin", "acos", "atan"})

PASS_UNIFORMS = frozenset({"proxy", "frame"})
"""The uniforms that a function may read without declaring them."""

Lines = tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...], frozenset[str]]
"""Lines of the files that a pass includes before and after its own functions, the names of the files, and which of
`PASS_UNIFORMS` they read."""

MAX_REMEMBERED_PASSES = 1024
"""Passes whose included lines are kept: many times the programs of a large graph. Chosen by judgement; each takes some
kilobytes."""

MAX_DERIVED_LIBRARIES = 8
"""Libraries that are kept with the code of graphs: one for each graph with custom nodes and each version of its code.
Chosen by judgement: more than a user has open at once."""


class Library(Record, frozen=True):
    """Shader texts by name, such as `color/exposure` or `lib/color`."""

    texts: Mapping[str, GlslText]
    _closures: dict[tuple[str, ...], tuple[GlslText, ...]] = field(
        default_factory=dict[tuple[str, ...], tuple[GlslText, ...]]
    )
    _light: dict[tuple[str, str], bool] = field(default_factory=dict[tuple[str, str], bool])
    _words: dict[tuple[str, str], frozenset[str]] = field(default_factory=dict[tuple[str, str], frozenset[str]])
    _uniforms: dict[tuple[str, str], frozenset[str]] = field(default_factory=dict[tuple[str, str], frozenset[str]])
    _digests: dict[tuple[str, ...], str] = field(default_factory=dict[tuple[str, ...], str])
    _lines: dict[Hashable, Lines] = field(default_factory=dict[Hashable, Lines])
    _derived: dict[frozenset[str], Library] = field(default_factory=dict[frozenset[str], "Library"])

    compare_exclude: ClassVar[frozenset[str]] = frozenset(
        {"_closures", "_light", "_words", "_uniforms", "_digests", "_lines", "_derived"}
    )

    def with_texts(self, texts: Iterable[GlslText]) -> Library:
        """This library with the code of a graph. Names of texts contain a hash, so equal names are equal code."""
        added = {text.name: text for text in texts}
        if not added:
            return self
        return self._derive(added, frozenset(added))

    def with_working_space(self, working: WorkingSpace | None) -> Library:
        """This library for a working space; None is linear Rec.709, for which the files are written."""
        return self if working is None else self.with_replacement(working.text, f"{working}")

    def with_replacement(self, text: GlslText, mark: str) -> Library:
        """This library with another text in place of a file; `mark` identifies the content."""
        return self._derive({text.name: text}, frozenset({text.name, mark}))

    def file_name(self, shader: str) -> str:
        """The name of a file in messages."""
        return self.texts[shader].file if shader in self.texts else f"shaders/{shader}.glsl"

    def function(self, shader: str, name: str, asker: str) -> GlslFunction:
        """A function of a file, or a ShaderError that names who asked."""
        text = self._find_text(shader, asker)
        if name not in text.functions:
            raise ShaderError(asker, text.file, 1, f"there is no function '{name}' in it")
        return text.functions[name]

    def defining_file(self, shader: str, name: str, asker: str) -> str:
        """The file with a function: `shader` itself, or one that it includes; `shader` also if none has it."""
        files = [text.name for text in self.closure((shader,), asker) if name in text.functions]
        return shader if shader in files or not files else files[0]

    def closure(self, names: tuple[str, ...], asker: str) -> tuple[GlslText, ...]:
        """The files and all that they include, each once, includes first. A ShaderError names the node `asker`."""
        if names not in self._closures:
            texts: dict[str, GlslText] = {}
            for name in names:
                self._include(name, asker, (), texts)
            self._closures[names] = tuple(texts.values())
        return self._closures[names]

    def uses(self, shader: str, words: frozenset[str], asker: str) -> bool:
        """True if the file or anything that it includes contains one of `words`."""
        return any(words & text.words for text in self.closure((shader,), asker))

    def remember_lines(self, key: Hashable, find: Callable[[], Lines]) -> Lines:
        """The included lines of a pass, which `find` makes the first time. `key` is everything that they depend on."""
        if key not in self._lines:
            if len(self._lines) >= MAX_REMEMBERED_PASSES:
                self._lines.pop(next(iter(self._lines)))
            self._lines[key] = find()
        return self._lines[key]

    def is_light(self, shader: str, function: str, asker: str) -> bool:
        """True for a function without loops that reads pictures, in a file that holds nothing but functions.

        It costs little, and a pass can include it several times under different names.
        """
        if (shader, function) not in self._light:
            self._light[shader, function] = self._is_light(shader, function, asker)
        return self._light[shader, function]

    def find_uniforms(self, shader: str, function: str, asker: str) -> frozenset[str]:
        """Those of `PASS_UNIFORMS` that a function reads, with all that it calls and all macros of its files."""
        if (shader, function) not in self._uniforms:
            needed = frozenset({function})
            for text in reversed(self.closure((shader,), asker)):
                needed |= text.keep_needed(needed).words
            self._uniforms[shader, function] = needed & PASS_UNIFORMS
        return self._uniforms[shader, function]

    def digest(self, names: tuple[str, ...], asker: str) -> str:
        """A hash of files and all that they include."""
        if names not in self._digests:
            bodies = "\0".join(text.body for text in self.closure(names, asker))
            self._digests[names] = blake2b(bodies.encode(), digest_size=16).hexdigest()
        return self._digests[names]

    def is_cheap(self, shader: str, function: str, asker: str) -> bool:
        """True for a function without loops and transcendental functions: it costs less than to store a picture."""
        return self.find_words(shader, function, asker).isdisjoint(_EXPENSIVE_WORDS)

    def is_straight(self, shader: str, function: str, asker: str) -> bool:
        """True for a function without loops."""
        return self.find_words(shader, function, asker).isdisjoint(_LOOP_WORDS)

    def find_words(self, shader: str, function: str, asker: str) -> frozenset[str]:
        """All words of a function and of those that it calls."""
        if (shader, function) not in self._words:
            self._words[shader, function] = frozenset[str]().union(
                *dict(self._find_words_by_file(shader, function, asker)).values()
            )
        return self._words[shader, function]

    def _find_words_by_file(self, shader: str, function: str, asker: str) -> Iterator[tuple[str, frozenset[str]]]:
        """The files that a function may need, its own first, with the words of the functions that it needs of each."""
        needed = frozenset({function})
        for text in reversed(self.closure((shader,), asker)):
            words = text.keep_needed(needed).words if needed & text.functions.keys() else frozenset[str]()
            needed |= words
            yield text.name, words

    def _is_light(self, shader: str, function: str, asker: str) -> bool:
        if self._find_text(shader, asker).outside or not self.is_straight(shader, function, asker):
            return False
        included_words = (words for name, words in self._find_words_by_file(shader, function, asker) if name != shader)
        return not any(_ACCESSOR.fullmatch(word) for words in included_words for word in words)

    def _derive(self, added: Mapping[str, GlslText], key: frozenset[str]) -> Library:
        """This library with texts added or replaced; `key` identifies them."""
        if key not in self._derived:
            if len(self._derived) >= MAX_DERIVED_LIBRARIES:
                self._derived.pop(next(iter(self._derived)))
            self._derived[key] = Library(OverlaidTexts(added, self.texts))
        return self._derived[key]

    def _find_text(self, name: str, asker: str) -> GlslText:
        """A file, or a ShaderError that names who asked: what reads files does not know it."""
        if name not in self.texts:
            raise self._describe_missing_file(name, asker)
        try:
            return self.texts[name]
        except ShaderError as error:
            raise ShaderError(asker, error.file, error.line, error.fault) from None

    def _describe_missing_file(self, name: str, asker: str) -> ShaderError:
        """The error about a file that is not there; of a plug-in most often because its wheel was made without it."""
        namespace, _, inner = name.partition("/")
        if not any(plugin.namespace == namespace for plugin in plugins()):
            return ShaderError(asker, f"shaders/{name}.glsl", 0, "there is no such shader file")
        fault = "there is no such file; a package brings its shaders if [tool.setuptools.package-data] in its "
        return ShaderError(asker, f"{namespace}/shaders/{inner}.glsl", 0, f"{fault}pyproject.toml names *.glsl")

    def _include(self, name: str, asker: str, trail: tuple[str, ...], texts: dict[str, GlslText]) -> None:
        """Add a file to `texts`, after all that it includes. `trail` are the files that include it."""
        if name in texts:
            return
        text = self._find_text(name, asker)
        for include, line in text.includes.items():
            circle = include in (*trail, name)
            if circle or include not in self.texts:
                hint = "" if circle else did_you_mean(f"{include}.glsl", [f"{name}.glsl" for name in self.texts])
                fault = "goes in a circle" if circle else f"names no shader file{hint}"
                raise ShaderError(asker, text.file, line, f'#include "{include}.glsl" {fault}')
            self._include(include, asker, (*trail, name), texts)
        texts[name] = text


class OverlaidTexts(Mapping[str, GlslText]):
    """Texts that hide those of the same name in another mapping, which is still read lazily."""

    def __init__(self, above: Mapping[str, GlslText], below: Mapping[str, GlslText]) -> None:
        self._above, self._below = above, below

    def __getitem__(self, name: str) -> GlslText:
        return self._above[name] if name in self._above else self._below[name]

    def __iter__(self) -> Iterator[str]:
        return iter({**dict.fromkeys(self._below), **dict.fromkeys(self._above)})

    def __len__(self) -> int:
        return len(set(self._below).union(self._above))

    def __contains__(self, name: object) -> bool:
        return name in self._above or name in self._below


class ShaderFolder(Mapping[str, GlslText]):
    """Shader files of a folder by name; each is read when it is first used.

    Files of a plug-in begin with its namespace. So must their functions, because two nodes of any origin may share a
    pass.
    """

    def __init__(self, folder: Path, namespace: str = "") -> None:
        self._folder, self._namespace = folder, namespace
        self._read: dict[str, GlslText] = {}

    @cached_property
    def _files(self) -> dict[str, Path]:
        return dict(_find_files(self._folder, f"{self._namespace}/" if self._namespace else ""))

    def __getitem__(self, name: str) -> GlslText:
        if name not in self._read:
            self._read[name] = self._parse(name)
        return self._read[name]

    def _parse(self, name: str) -> GlslText:
        source = self._files[name].read_bytes().decode(errors="replace")
        if not self._namespace:
            return parse(name, source)
        namespace, _, inner = name.partition("/")
        text = parse(name, source, f"{namespace}/shaders/{inner}.glsl")
        for function in text.all_functions:
            if not function.name.startswith(f"{namespace}_"):
                fault = f"the function '{function.name}' of a plug-in must begin with '{namespace}_'"
                raise ShaderError("", text.file, function.line, fault)
        return text

    def __iter__(self) -> Iterator[str]:
        return iter(self._files)

    def __len__(self) -> int:
        return len(self._files)

    def __contains__(self, name: object) -> bool:
        return name in self._files


class InstalledTexts(Mapping[str, GlslText]):
    """The shader files of Halation and of plug-ins, which are only searched for names that Halation does not have."""

    def __init__(self) -> None:
        self._own = ShaderFolder(folder())

    @cached_property
    def _plugins(self) -> Mapping[str, ShaderFolder]:
        """The shader files of every plug-in by its namespace."""
        return {
            plugin.namespace: ShaderFolder(plugin.folder / "shaders", plugin.namespace)
            for plugin in plugins()
            if plugin.nodes and plugin.folder and (plugin.folder / "shaders").is_dir()
        }

    def __getitem__(self, name: str) -> GlslText:
        return self._own[name] if name in self._own else self._plugins[name.partition("/")[0]][name]

    def __iter__(self) -> Iterator[str]:
        return chain(self._own, *self._plugins.values())

    def __len__(self) -> int:
        return len(self._own) + sum(map(len, self._plugins.values()))

    def __contains__(self, name: object) -> bool:
        if name in self._own:
            return True
        return isinstance(name, str) and name in self._plugins.get(name.partition("/")[0], ())


def _find_files(folder: Path, prefix: str) -> Iterator[tuple[str, Path]]:
    for item in folder.iterdir():
        if "." not in item.name:
            yield from _find_files(item, f"{prefix}{item.name}/")
        elif item.name.endswith(".glsl"):
            yield prefix + item.name.removesuffix(".glsl"), item


@cache
def load_library() -> Library:
    """The library that ships with Halation, with the shaders of plug-ins."""
    return Library(InstalledTexts())


def reload_library() -> Library:
    """The same with the texts of shaders as they are now."""
    load_library.cache_clear()
    return load_library()
