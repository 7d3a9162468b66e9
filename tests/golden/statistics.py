#!/usr/bin/env python3
"""tests/golden/statistics.py: writes statistics.json beside it, from scipy (Debian's python3-scipy).

Quantiles: numpy. BCa, Wilson, McNemar (as a binomial test) and the signed-rank test: scipy. The
signed-rank test with tied sizes: all 2^n patterns of signs, since scipy is exact only without
ties. The rank-biserial correlation and Holm: by their formulas, here. Clusters: scipy's paired
bootstrap of sums and numbers. Scenarios: numpy's means over the seeds, then as above. Run by hand:
    /usr/bin/python3 tests/golden/statistics.py
"""
import itertools
import json
import pathlib

import numpy as np
import scipy
from scipy import stats

rng = np.random.default_rng(19)


def rounded(values, digits=3):
    return [round(float(v), digits) for v in values]


def quantiles():
    for n in (1, 2, 5, 12):
        x = sorted(rounded(rng.gamma(2, 20, n)))
        p = [0.0, 0.1, 0.25, 0.5, 0.75, 0.975, 1.0]
        yield {"sorted": x, "p": p, "q": [float(np.quantile(x, each)) for each in p]}


def bca():
    for n in (8, 30):
        x = rounded(rng.gamma(2, 20, n))
        found = stats.bootstrap((x,), np.mean, n_resamples=399, method="BCa", random_state=rng)
        yield {"values": x, "means": [float(m) for m in found.bootstrap_distribution],
               "low": float(found.confidence_interval.low),
               "high": float(found.confidence_interval.high)}


def wilson():
    for count, n in ((0, 10), (10, 10), (7, 10), (270, 300), (1, 1), (3, 1000)):
        found = stats.binomtest(count, n).proportion_ci(method="wilson")
        yield {"count": count, "n": n, "low": float(found.low), "high": float(found.high)}


def mcnemar():
    for b, c in ((0, 0), (1, 0), (0, 5), (8, 2), (12, 12), (150, 110)):
        p = stats.binomtest(min(b, c), b + c, 0.5).pvalue if b + c else 1.0
        yield {"only_baseline": b, "only_other": c, "p": float(p)}


def by_patterns(ranks, w_plus):
    sums = np.array([sum(r for r, keep in zip(ranks, signs) if keep)
                     for signs in itertools.product((0, 1), repeat=len(ranks))])
    return float(min(1.0, 2 * min((sums <= w_plus).mean(), (sums >= w_plus).mean())))


def signed_rank(d, method):
    x = np.array([v for v in d if v != 0])
    ranks = stats.rankdata(abs(x))
    plus, minus = float(ranks[x > 0].sum()), float(ranks[x < 0].sum())
    if method == "patterns":
        p = by_patterns(ranks, plus)
    else:
        p = float(stats.wilcoxon(x, mode=method, correction=False).pvalue)
    return {"differences": [float(v) for v in d], "method": method, "w_plus": plus,
            "w_minus": minus, "p": p, "rank_biserial": (plus - minus) / (plus + minus)}


def wilcoxon():
    yield signed_rank(rounded(rng.normal(0.5, 1, 9), 6), "exact")
    yield signed_rank(rounded(rng.normal(0.3, 1, 40), 6), "exact")
    yield signed_rank([0.5, 0.5, -0.5, 1.0, 1.0, 1.5, 0.0, -1.0, 2.0, 0.0, 2.0, 2.5], "patterns")
    yield signed_rank(list(np.round(rng.normal(0.3, 1, 200) * 8) / 8), "approx")  # ties and zeros


def holm():
    for p in ([0.01, 0.04, 0.03, 0.005], [0.5, 0.5], [1.0], [0.02, 0.02, 0.9, 0.001]):
        order = sorted(range(len(p)), key=lambda i: p[i])
        adjusted, largest = [0.0] * len(p), 0.0
        for k, i in enumerate(order):
            largest = max(largest, min(1.0, (len(p) - k) * p[i]))
            adjusted[i] = largest
        yield {"p": p, "adjusted": adjusted}


def clusters():
    """Rates and means over scenarios of unlike size: whole scenarios are drawn."""
    for sums, n in (([5, 5, 3, 0, 5, 1, 5, 5, 4, 2], [5] * 10),
                    (rounded(rng.gamma(2, 80, 12)), [5, 5, 1, 4, 2, 5, 5, 3, 5, 5, 4, 5])):
        found = stats.bootstrap((np.array(sums, float), np.array(n, float)),
                                lambda s, m, axis: s.sum(axis=axis) / m.sum(axis=axis),
                                paired=True, vectorized=True, n_resamples=399, method="BCa",
                                random_state=rng)
        yield {"sums": sums, "n": n, "ratios": [float(m) for m in found.bootstrap_distribution],
               "low": float(found.confidence_interval.low),
               "high": float(found.confidence_interval.high)}


def scenarios():
    """Two controllers, 12 scenarios, 4 seeds: reached (1 or 0) and time, by scenario and seed."""
    base = (rng.random((12, 4)) < 0.55).astype(int)
    other = (rng.random((12, 4)) < 0.85).astype(int)
    base_time, other_time = (np.round(rng.gamma(9, scale, (12, 4)), 3) for scale in (9, 8))
    rates = other.mean(axis=1) - base.mean(axis=1)
    times = []
    for i in range(12):
        both = (base[i] == 1) & (other[i] == 1)
        if both.any():
            times.append(float((other_time[i] - base_time[i])[both].mean()))
    yield {"baseline": {"reached": base.tolist(), "time": base_time.tolist()},
           "other": {"reached": other.tolist(), "time": other_time.tolist()},
           "reached": signed_rank([float(v) for v in np.round(rates, 12)], "patterns"),
           "time": signed_rank(times, "exact"),
           "mean_reached": float(rates.mean()), "mean_time": float(np.mean(times))}


document = {"about": "made by statistics.py, see there: numpy " + np.__version__ + ", scipy "
            + scipy.__version__, "tolerance": 1e-9}
for make in (quantiles, bca, wilson, mcnemar, wilcoxon, holm, clusters, scenarios):
    document[make.__name__] = list(make())
path = pathlib.Path(__file__).with_suffix(".json")
path.write_text(json.dumps(document, separators=(",", ":")) + "\n")
