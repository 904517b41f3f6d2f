"""Picture files: EXR, PNG, TIFF and whatever else OpenImageIO reads and writes."""
