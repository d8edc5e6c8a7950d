"""The compiled steps of the smooth fit: all contours of a glyph at once, on flat arrays.

``chains`` the contours, each begun and run as its shape has it · ``spacing`` how far apart vertices may lie, and places
for them · ``places`` vertices put in where spans fail, and graded · ``near`` the certified distance, span by span ·
``prune`` vertices taken out · ``forms`` length, area, curvature and crossings of the results.

Parts of a flat array belong to one contour each: part k is ``values[offsets[k]:offsets[k + 1]]``.
"""
