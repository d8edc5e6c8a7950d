"""The command ``dataset``: glyphs of many fonts as tables; and the table, URLs and clusters of runs.

Needs no other plug-in. In: fonts; out: Parquet. Read first: :mod:`.run`.
"""

from __future__ import annotations

from ...hooks import Listed, Plugin

PLUGIN = Plugin(
    commands={
        "dataset": Listed(
            ".command:dataset",
            "Make a data set of the glyphs of fonts: Parquet files that datasets, pandas, DuckDB and Arrow open.",
        )
    },
    work={"points": ".work:points"},
    whole={"parquet": ".formats:PARQUET"},
    services={"cluster": ".cluster:ClusterExecutor", "fetch_fonts": ".remote:fetch_fonts"},
)
