"""The short way for many glyphs: sampled by step, one smooth curve a contour, written as SVG.

It does what reader, sampling, interpolation and SVG writer do, on flat arrays and for a whole chunk of glyphs at
once, in compiled code; :func:`.lane.draw_chunk` is the way in. Whatever is unusual in a glyph (nothing drawn, a
bad polygon, too much of anything) sends it back to the long way, which knows what to say of it. A test holds the two
ways to the same files.

``reading`` outlines from HarfBuzz · ``contours`` as the pen makes them · ``stepping`` places by step ·
``curves`` Bézier points, and numbers as text · ``lane`` the whole ·
``outlines`` what glyphs are that go the long way.
"""
