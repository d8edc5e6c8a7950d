"""How fast the interpolation is beside what else there is: interleaved runs, medians, ratios.

``measure`` times cases in turn · ``shapes`` makes the polygons · a module a suite (``core``, ``startup``) gives rows ·
``table`` writes them into ``docs/benchmarks.md`` and ``outputs/benchmark/``. A new suite is a module with ``rows()``,
named in ``SUITES``.
"""
