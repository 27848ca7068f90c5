"""The time line: the maps of the last minutes, to be looked at, compared, gone on from and filmed."""
