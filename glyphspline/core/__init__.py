"""The compiled core: numbers in, numbers out; no classes, no errors, no input checks but those on the polygon.

``footpoint`` nearest points, certified · ``general`` one pass for every degree and variant · ``layout`` merged vertices
and knots · ``lemma2`` intervals · ``lanes`` one pass on cubics, many vertices at once · ``solve`` the frozen system ·
``ragged`` many polygons.

Numba keeps the machine code beside these files, or in the user's cache folder where that cannot be written. It looks
at the date of a function's own file and not at those of the functions called by it: after an edit, run ``make clean``.
"""
