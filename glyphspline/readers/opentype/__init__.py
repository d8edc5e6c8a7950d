"""TrueType and OpenType fonts, through HarfBuzz and fontTools."""
