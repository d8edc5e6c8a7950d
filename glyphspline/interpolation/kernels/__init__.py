"""The compiled kernels: numbers in, numbers out; no classes, no errors, no input checks but those on the polygon.

``footpoint`` nearest points, certified · ``any_degree_pass`` one pass for every degree and variant · ``vertices``
merged vertices and knots · ``blocks`` vertices in memory · ``lemma2`` intervals · ``newton_simd`` footpoints on cubics,
many vertices at once · ``certificate`` those of them that take a full search · ``collocation`` the frozen system ·
``iteration`` Algorithm 2 on a group of polygons · ``run`` many polygons.
"""
