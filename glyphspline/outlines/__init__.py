"""What a font draws: contours, their canonical order, sampling, joins and overlaps."""
