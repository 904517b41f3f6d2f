"""Tells PyInstaller what belongs to Halation: all data, and modules that stay files, as they are found by."""

from PyInstaller.utils.hooks import collect_data_files, collect_submodules, copy_metadata

hiddenimports = [*collect_submodules("halation"), "tkinter", "tkinter.messagebox"]
datas = collect_data_files("halation") + copy_metadata("halation", recursive=True)
module_collection_mode = "py"
