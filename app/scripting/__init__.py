"""What the Python interface needs beside the engine: checks of arguments, and rendering from any thread."""
