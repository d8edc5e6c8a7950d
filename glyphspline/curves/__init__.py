"""A curve as such: B-splines, Bézier pieces, compiled cubics, integrals, crossings, curvature."""
