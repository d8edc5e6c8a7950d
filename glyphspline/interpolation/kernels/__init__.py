"""The compiled kernels: numbers in, numbers out; no classes, no errors, no input checks but those on the polygon.

``driver`` Algorithm 2 on many polygons · ``blocks`` vertices in memory · ``lemma2`` intervals · ``newton_simd``,
``gram_simd`` footpoints on cubics in the plane and in space, many vertices at once · ``certificate`` those of them that
take a full search · ``footpoint`` nearest points, certified · ``any_degree_pass`` a pass for every degree and variant.
"""
