"""SVG drawings and curvature maps."""
