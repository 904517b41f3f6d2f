"""`python -m halation.cli`."""

from . import main

main()
