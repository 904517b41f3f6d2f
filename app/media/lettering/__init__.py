"""Text as outlines: fonts, shaping by HarfBuzz, the order of scripts that run both ways, lines."""

FONT_ENDINGS = frozenset({".ttf", ".otf", ".ttc", ".otc"})
"""The endings of font files."""
