"""The rule of convergence-judge's RULE.md, written from that page alone: judge(p, T, F, h, e) gives verdict and interval."""
from math import exp, expm1, inf, isfinite, log, sqrt

STUDENT = [inf, 12.70620473617469, 4.302652729749467, 3.1824463052837046]


def without(column, values):
    factor = sum(a * b for a, b in zip(values, column)) / sum(a * a for a in column)
    return [value - factor * a for value, a in zip(values, column)]


def line(x, y, r, round_off):
    """rss, Q, v, Σd², m - k of the line without pollution (r is None) or with h^r."""
    left, rest = [without([1.0] * len(x), values) for values in (x, y)]
    if r is not None:
        column = without([1.0] * len(x), [exp(r * (value - x[0])) for value in x])
        left, rest = without(column, left), without(column, rest)
    square, free = sum(d * d for d in left), len(x) - (2 if r is None else 3)
    rss = sum(value**2 for value in without(left, rest)) + free * round_off**2
    return rss, sum(a * b for a, b in zip(left, rest)) / square, rss / free, square, free


def interval(x, y, q):
    rho, round_off = x[-2] - x[-1], 2**-49 * max(1, *map(abs, y))
    if len(x) == 3:
        half = 1.5 * (abs(q[-1] - q[-2]) + round_off / rho) / expm1((x[0] - x[2]) / 6)
        return q[-1] - half, q[-1] + half
    straight, best = line(x, y, None, round_off), min(line(x, y, r, round_off) for r in (1 / 3, 2 / 3, 1, 2, 3))
    _, rate, v, square, free = best if 20 * best[0] < straight[0] else straight
    half = 1.1 * (STUDENT[free] * sqrt(v / square) + max(0, abs(rate - q[-1]) - sqrt(2 * v) / rho))
    return rate - half, rate + half


def judge(p, T, F, h, e):
    if not all(isfinite(value) and value >= 0 for value in e):
        return "fail", None
    m = max((k + 1 for k in range(len(e)) if e[k] > F), default=0)
    falling = all(coarse > fine > 0 for coarse, fine in zip(h, h[1:]))
    if not (0 < p < inf and 0 < T < 0.5) or m < 3 or 0 in e or not falling or h[0] / h[m - 1] < 1.5:
        return "inconclusive", None
    x, y = [log(value) for value in h[:m]], [log(value) for value in e[:m]]
    q = [(y[k] - y[k + 1]) / (x[k] - x[k + 1]) for k in range(m - 1)]
    changes = [0, 0] + [after - before for before, after in zip(q, q[1:])]
    a, b, d = changes[-3:]
    S = max([0] + [min(abs(one), abs(next)) for one, next in zip(changes, changes[1:]) if one * next < 0])
    near = next((n for n in range(min(4, m - 1)) if abs(q[-1 - n] - q[-1]) > 0.55), min(4, m - 1))
    first = m - 1 - max(2, near)
    low, high = ends = interval(x[first:], y[first:], q)
    if b < 0 and d < -0.1 and q[-1] + 2 * S < p - 1 / 2:
        return "fail", ends
    two, three = [one * next > 0 and abs(next) > 1.1 * abs(one) for one, next in ((b, d), (a, b))]
    turns = a * b > 0 and abs(a) > abs(b) and b * d <= 0 and abs(d) > 4 * abs(b) and abs(d) > T / 10
    if near < 2 or turns or two and (abs(b + d) > T / 6 or three and abs(a + b + d) > T / 40):
        return "inconclusive", ends
    leaves = m == 4 and two and abs(b + d) > T / 40 or m == 3 and abs(q[1] - p) > abs(q[0] - p) + T / 80
    passes = p - T <= low and high <= p + T and q[-1] > 0 and not leaves
    fails = high < p - T or low > p + T and q[-1] > 0
    return "pass" if passes else "fail" if fails else "inconclusive", ends
