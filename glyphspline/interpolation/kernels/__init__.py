"""The compiled kernels: numbers in, numbers out; no classes, no errors, no input checks but those on the polygon.

``driver`` polygon after polygon · ``lemma2`` intervals · ``passes`` one pass over the vertices · ``search`` those that
it cannot certify at once · ``footpoint`` nearest points, certified. All of it runs as plain Python too, and gives the
same bits.
"""
