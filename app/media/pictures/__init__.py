"""Picture files: EXR, PNG, TIFF and all other formats that OpenImageIO reads and writes."""
