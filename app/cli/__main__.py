"""`python -m halation.app.cli`."""

from . import main

main()
