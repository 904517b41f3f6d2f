"""Says something to a user who has no terminal."""

from __future__ import annotations

import shutil
import subprocess

_PROGRAMS = (("zenity", "--error", "--no-markup", "--text"), ("kdialog", "--error"), ("xmessage",))
"""Programs of desktops that show a sentence in a window, and their words before it."""


def show_error(sentence: str) -> None:
    """Show an error in a window and wait until it is closed. Without a display, nothing happens.

    Tk draws without OpenGL, whose absence is what most often has to be said. Where Tk lacks a library or a font, a
    program of the desktop shows it.
    """
    try:
        _show_in_tk(sentence)
    except (ImportError, RuntimeError):
        _call_program(sentence)


def _show_in_tk(sentence: str) -> None:
    import tkinter
    from tkinter import messagebox

    try:
        root = tkinter.Tk(className="Halation")
        root.withdraw()
        messagebox.showerror("Halation", sentence, parent=root)
        root.destroy()
    except tkinter.TclError as fault:
        raise RuntimeError(str(fault)) from fault


def _call_program(sentence: str) -> None:
    for program, *words in _PROGRAMS:
        if path := shutil.which(program):
            subprocess.run([path, *words, sentence], capture_output=True, check=False)
            return
