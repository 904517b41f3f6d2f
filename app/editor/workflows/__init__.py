"""What takes several steps with questions between them: documents, files of code, flipbooks."""
