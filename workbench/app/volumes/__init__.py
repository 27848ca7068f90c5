"""Seeing into solids: a plane that cuts them, peeling by distortion, and what is drawn of them then."""
