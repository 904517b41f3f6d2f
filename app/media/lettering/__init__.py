"""Text as outlines: fonts, shaping by HarfBuzz, the order of scripts that run both ways, lines."""
