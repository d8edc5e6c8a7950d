"""Geometric interpolation of Xiong, Li and Mao (2012): from a polygon to a closed or clamped B-spline."""
