"""OTF and TTF files."""
