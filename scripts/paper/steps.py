"""All steps of the reproduction, and how they are run beside each other."""

from __future__ import annotations

import json
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, replace
from importlib import import_module
from itertools import chain, repeat
from multiprocessing import get_context

from .common import PAPER, Claim, Run, progress, rounded
from .report import write_report

STEPS = {
    "theorems": "theorems: corollary_1 theorem_1 remark_2 theorem_2",
    "lemmas": "lemmas: lemma_1 lemma_2 corollary_1_converges appendix_a_holds tie_rule",
    "fig1": "thresholds: figure_1",
    "fig2": "study: figure_2",
    "many": "study: many_vertices",
    "fig3": "study: figure_3",
    "fig4": "local: figure_4",
    "fig5": "fig5: figure_5",
    "fig6": "characters: figure_6",
    "fig7": "characters: figure_7",
    "fig8": "characters: figure_8",
    "fig9": "characters: figure_9",
    "quality": "fairness: quality_study",
    "thresholds": "thresholds: thresholds",
    "convergence": "theorems: convergence",
    "rates": "rates: asymptotic_rate rate_at_knots family_of_limits variant_3 sharpness any_order",
    "remark3": "theorems: remark_3",
    "degrees": "thresholds: degrees",
    "arcs": "arcs: arcs",
    "order": "order: approximation_order",
    "acceleration": "acceleration: acceleration",
    "pia": "pia: pia",
    "dimension": "dimension: dimensions",
}
"""By step, a module and its functions; in the order of the paper, then what goes beyond it."""


TIMED = "fig4"
"""The step whose times are its result: it runs alone, after the others."""


def reproduce(run: Run, only: list[str] | None = None, jobs: int = 2) -> None:
    """Make all figures and claims, or only some; what an earlier run left is kept where it is not made again."""
    run.out.mkdir(parents=True, exist_ok=True)
    start = time.perf_counter()
    file = run.out / "claims.json"
    if only and file.exists():
        earlier = json.loads(file.read_text(encoding="utf-8"))
        run.claims += [Claim(**c) for c in earlier["claims"]]
        run.times.update(earlier["times"])
    names = only or list(STEPS)
    beside = [name for name in names if name != TIMED]
    with ProcessPoolExecutor(jobs, get_context("spawn")) as pool:
        alone = (make(name, run) for name in names if name == TIMED)  # made when it is asked for: after the others
        for made in chain(pool.map(make, beside, repeat(run)), alone):
            run.claims += made.claims
            run.times.update(made.times)
            _write(run)
    if not only:
        run.times["all steps, minutes"] = (time.perf_counter() - start) / 60
    _write(run)


def make(name: str, run: Run) -> Run:
    """One step: its pictures into the folder, its claims and its time as the answer."""
    own = replace(run, step=name, claims=[], times={}, cache={})
    module, functions = STEPS[name].split(":")
    with progress(own, name):
        for function in functions.split():
            getattr(import_module(f".{module}", __package__), function)(own)
    return replace(own, cache={})


def _write(run: Run) -> None:
    """claims.json, the latest of each claim in the order of the paper, and the page made of it."""
    order = list(STEPS)
    latest = {c.id: c for c in run.claims}
    run.claims = sorted(latest.values(), key=lambda c: order.index(c.command.split()[-1]))
    content = {"paper": PAPER, "claims": [asdict(c) for c in run.claims], "times": rounded(run.times, 4)}
    text = json.dumps(content, indent=1, ensure_ascii=False) + "\n"
    (run.out / "claims.json").write_text(text, encoding="utf-8")
    write_report(run.out)
