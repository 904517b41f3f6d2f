"""Says something to a user who has no terminal."""

from __future__ import annotations

import contextlib
import shutil
import subprocess

_PROGRAMS = (("zenity", "--error", "--no-markup", "--text"), ("kdialog", "--error"), ("xmessage",))
"""Programs of desktops that show a sentence in a window, and their words before it."""


def show_error(sentence: str) -> None:
    """Show an error in a window and wait until it is closed. Without a display, nothing happens.

    Tk draws without OpenGL, whose absence is what most often has to be said. Where Tk itself lacks a library, a
    program of the desktop shows it.
    """
    try:
        import tkinter
        from tkinter import messagebox
    except ImportError:
        _call_program(sentence)
        return
    with contextlib.suppress(tkinter.TclError):
        root = tkinter.Tk(className="Halation")
        root.withdraw()
        messagebox.showerror("Halation", sentence, parent=root)
        root.destroy()


def _call_program(sentence: str) -> None:
    for program, *words in _PROGRAMS:
        if path := shutil.which(program):
            subprocess.run([path, *words, sentence], capture_output=True, check=False)
            return
