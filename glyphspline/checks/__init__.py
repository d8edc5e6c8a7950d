"""What may be wrong with outlines as a font stores them. Nothing is fitted."""
