"""The document: everything that a user chose."""
