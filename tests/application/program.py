"""What the program of the application folder runs: the command line, or the module that a helper process is.

Halation starts its helpers as `python -P -m module`. There is no such Python in the folder, so its one program
understands these words. Programs that Halation starts, such as git, load the libraries of the system again.
"""

import os
import sys
from multiprocessing import freeze_support
from runpy import run_module

_SEARCH_PATH = "LD_LIBRARY_PATH"

if (original := os.environ.pop(f"{_SEARCH_PATH}_ORIG", None)) is not None:
    os.environ[_SEARCH_PATH] = original
else:
    os.environ.pop(_SEARCH_PATH, None)
freeze_support()
if sys.argv[1:3] == ["-P", "-m"]:
    module = sys.argv[3]
    sys.argv = [module, *sys.argv[4:]]
    run_module(module, run_name="__main__", alter_sys=True)
else:
    from halation.cli import main

    if sys.argv[1:] == [] and ".app/Contents/MacOS/" in sys.executable and not sys.stdout.isatty():
        sys.argv.append("edit")  # macOS opens a bundle without words, and shows no text
    main()
