"""The dialog that exports the document to the formats of other programs."""
