"""Tells PyInstaller what belongs to Halation: all data, and modules that stay files, as they are found by.

Of slangpy, the compiler alone is needed, which Halation loads by its file: no module imports the package. `halation
doctor` reads the metadata of extras.
"""

from PyInstaller.utils.hooks import collect_data_files, collect_dynamic_libs, collect_submodules, copy_metadata

_EXTRAS = ("av", "cma", "distributed", "pyoidn", "scipy", "slangpy")
_SLANG = ("*slang-compiler*", "*slang-glsl-module*")

hiddenimports = [*collect_submodules("halation"), "tkinter", "tkinter.messagebox"]
binaries = collect_dynamic_libs(
    "slangpy", search_patterns=[f"{name}.{end}" for name in _SLANG for end in ("so*", "*dylib", "dll")]
)
datas = collect_data_files("halation") + copy_metadata("halation", recursive=True)
datas += [file for name in _EXTRAS for file in copy_metadata(name)]
datas += collect_data_files("slangpy", include_py_files=True, includes=["__init__.py"])
module_collection_mode = "py"
