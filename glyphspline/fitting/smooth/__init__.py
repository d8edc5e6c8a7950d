"""The smooth fit: closed C2 curves within a tolerance."""
