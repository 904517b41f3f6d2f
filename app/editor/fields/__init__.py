"""Fields that edit one value of a graph: numbers, colors, texts, choices, curves, ramps, lights."""
