"""How the editor looks: colors, fonts and sizes, in one place."""
