"""How fast the interpolation is beside what else there is: interleaved runs, medians, ratios.

``measure`` times cases in turn, and writes tables into ``docs/benchmarks.md``. A suite is a function that gives rows,
named in ``SUITES``.
"""
