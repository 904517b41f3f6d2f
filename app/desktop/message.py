"""Says something to a user who has no terminal."""

from __future__ import annotations

import contextlib


def show_error(sentence: str) -> None:
    """Show an error in a window and wait until it is closed. Without a display, or without Tk, nothing happens.

    Tk draws without OpenGL, whose absence is what most often has to be said.
    """
    with contextlib.suppress(ImportError):
        import tkinter
        from tkinter import messagebox

        with contextlib.suppress(tkinter.TclError):
            root = tkinter.Tk(className="Halation")
            root.withdraw()
            messagebox.showerror("Halation", sentence, parent=root)
            root.destroy()
