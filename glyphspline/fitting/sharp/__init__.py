"""The sharp mode: contours split at corners into lines and clamped splines."""
