"""The compiled core: numbers in, numbers out; no classes, no errors, no input checks but those on the polygon.

``footpoint`` nearest points, certified · ``general`` one pass for every degree and variant · ``layout`` merged vertices
and knots · ``lemma2`` intervals · ``lanes`` one pass on cubics, many vertices at once · ``flagged`` those of them that
need a closer look · ``passes`` a polygon's iteration · ``side_by_side`` that of short polygons together · ``solve`` the
frozen system · ``one`` a polygon in and out · ``ragged`` many · ``lend`` arrays whose references are not counted,
``select`` a choice without a branch, ``fused`` sums of products, ``wide`` vectors.

Numba keeps the machine code beside these files, or in the user's cache folder where that cannot be written. It looks
at the date of a function's own file and not at those of the functions called by it: after an edit, run ``make clean``.
"""
