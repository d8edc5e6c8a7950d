"""The gallery of a finished run, and other pages."""
