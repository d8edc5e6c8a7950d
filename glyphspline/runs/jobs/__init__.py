"""What runs do with glyphs: the jobs of :mod:`..engine`."""
