"""The open document as commands and panels read it, and its history. Nothing here changes a document."""
