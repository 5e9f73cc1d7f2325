"""The rule of convergence-judge's RULE.md, written from that page alone: judge(p, T, F, h, e) gives verdict and interval."""
from math import exp, expm1, inf, isfinite, log, sqrt

STUDENT = [inf, 12.706204736175, 4.3026527297494, 3.1824463052838, 2.7764451051978, 2.5705818356363, 2.446911851145, 2.3646242515928,
           2.3060041352042, 2.2621571627982, 2.2281388519863, 2.2009851600916]
POLLUTION = (1 / 3, 2 / 3, 1, 2, 3)
EPSILON = 2**-52
PASS, FAIL, UNSURE = "pass", "fail", "inconclusive"


def without(column, values):
    factor = sum(a * b for a, b in zip(values, column)) / sum(a * a for a in column)
    return [value - factor * a for value, a in zip(values, column)]


class Line:
    """Least squares of y as a + Q x, or as a + Q x + c h^r."""

    def __init__(self, x, y, r=None):
        round_off = 2**-49 * max(1, *map(abs, y))
        left, rest = [without([1.0] * len(x), values) for values in (x, y)]
        if r is not None:
            column = without([1.0] * len(x), [exp(r * (value - x[0])) for value in x])
            left, rest = without(column, left), without(column, rest)
        self.free = len(x) - (2 if r is None else 3)
        self.X = sum(d * d for d in left)
        self.Q = sum(a * b for a, b in zip(left, rest)) / self.X
        self.rss = sum(value**2 for value in without(left, rest)) + self.free * round_off**2
        self.v = self.rss / self.free if self.free else inf

    def half(self):
        return STUDENT[self.free] * sqrt(self.v / self.X)


def units(x, y):
    """x and y in units of the finest level."""
    return [value - x[-1] for value in x], [value - y[-1] for value in y]


def interval(x, y, q):
    x, y = units(x, y)
    rho = x[-2] - x[-1]
    if len(x) == 3:
        u = 2**-49 * max(1, *map(abs, y))
        half = 1.5 * (abs(q[-1] - q[-2]) + u / rho) / expm1((x[0] - x[2]) / 6)
        return q[-1] - half, q[-1] + half
    line, curved = Line(x, y), [Line(x, y, r) for r in POLLUTION]
    best = min(curved, key=lambda one: one.rss)
    is_curved = 20 * best.rss < line.rss
    if is_curved:
        line = best
    half = 1.1 * (line.half() + max(0, abs(line.Q - q[-1]) - sqrt(2 * line.v) / rho))
    if is_curved:
        half = max([half] + [abs(line.Q - other.Q) for other in curved if other.rss < 4 * line.rss])
    return line.Q - half, line.Q + half


def scattered(x, y, changes):
    """Step 5: the number of finest levels that scatter, and their interval."""
    for n in range(min(len(x), 30), 5, -1):
        last = changes[-(n - 2):]
        xs, ys = units(x[-n:], y[-n:])
        if sum(a * b < 0 for a, b in zip(last, last[1:])) < 2 / 5 * (n - 3):
            continue
        line, curved, k = Line(xs, ys), [Line(xs, ys, r) for r in POLLUTION], n // 2
        halves = [Line(*units(xs[:k], ys[:k])).rss, Line(*units(xs[k:], ys[k:])).rss]
        if sqrt(line.v) <= 1 / 8 and max(halves) <= 30 * min(halves) and all(line.rss - c.rss <= 25 * c.v for c in curved):
            half = max([1.1 * line.half()] + [abs(line.Q - c.Q) for c in curved])
            return n, (line.Q - half, line.Q + half)
    return None


def fitted(x, z, r):
    """z as a + b h^r: b, its standard error, and the rss."""
    column = without([1.0] * len(x), [exp(r * value) for value in x])
    rest, square = without([1.0] * len(x), z), sum(a * a for a in column)
    rss = sum(value**2 for value in without(column, rest))
    return sum(a * b for a, b in zip(rest, column)) / square, sqrt(rss / (len(x) - 2) / square), rss


def lower_order(x, y, p, T, n, scatters):
    """Step 8, of all levels; n of them scatter."""
    def terms(count):
        xs, ys = units(x[-count:], y[-count:])
        z = [b - p * a for a, b in zip(xs, ys)]
        lower = [(d, *fitted(xs, z, -d)) for d in (1 / 2, 1, p)]
        constant = sum(value**2 for value in without([1.0] * count, z)) * (count - 2) / (count - 1)
        return [one for one in lower if one[0] * one[1] > T / 60], min([constant] + [fitted(xs, z, r)[2] for r in POLLUTION])
    for count in range(5 if scatters else 4, min(len(x), 8) + 1):
        lower, other = terms(count)
        if any(rss + 1e-24 * count < other / 5 for *_, rss in lower):
            return True
    return scatters and any(b > 2.5 * error for _, b, error, _ in terms(n)[0])


def decided(p, T, h, e, x, y):
    """Steps 4 to 8, of the levels above the floor."""
    m = len(e)
    q = [(y[k] - y[k + 1]) / (x[k] - x[k + 1]) for k in range(m - 1)]
    off = [16 * 2**-50 * (abs(one) + (1 + abs(one)) / (x[k] - x[k + 1])) for k, one in enumerate(q)]
    changes = [0 if abs(b - a) <= max(off[k:k + 2]) else b - a for k, (a, b) in enumerate(zip(q, q[1:]))]
    found, U, U4 = scattered(x, y, changes), max(off), max(off[-4:])
    near = next((k for k in range(min(4, m - 1)) if abs(q[-1 - k] - q[-1]) > 0.55 + max(off[-1 - k], off[-1])), min(4, m - 1))
    n, ends = found or (max(3, near + 1), None)
    ends = ends or interval(x[-n:], y[-n:], q)
    if any(abs(a - c) < 1 / 4 - max(off[k:k + 3]) and min(abs(b - a), abs(b - c)) > 3 + max(off[k:k + 3])
           for k, (a, b, c) in enumerate(zip(q, q[1:], q[2:]))):
        return UNSURE, ends
    a, b, d = ([0, 0] + changes)[-3:]
    S = max([0] + [min(abs(one), abs(next)) for one, next in zip(changes, changes[1:]) if one * next < 0])
    if b < 0 and d < -0.1 - U and q[-1] + 2 * S < p - 1 / 2 - U:
        return FAIL, ends
    if not found:
        two, three = [one * next > 0 and abs(next) > 1.1 * abs(one) + U4 for one, next in ((b, d), (a, b))]
        turns = a * b > 0 and abs(a) > abs(b) + U4 and b * d <= 0 and abs(d) > 4 * abs(b) + U4 and abs(d) > T / 10 + U4
        away = [p - one for one in q[-4:]]
        away = [0 if abs(one) <= U4 else one for one in away]
        comes = len(q) >= 4 and abs(away[0]) <= T / 10 + U4 and all(
            one * next >= 0 and abs(next) < abs(one) - U4 for one, next in zip(away, away[1:]))
        grows = (two or b == 0 and len(changes) > 1) and abs(b + d) > T / 6 + U4
        if near < 2 or (grows or two and three and abs(a + b + d) > T / 40 + U4 or turns) and not comes:
            return UNSURE, ends
    U3 = max(off[-3:])
    leaves = (m == 4 and b * d > 0 and abs(d) > 1.1 * abs(b) + U3 and abs(b + d) > T / 40 + U3
              or m == 3 and abs(q[1] - p) > abs(q[0] - p) + T / 80 + U3)
    if ends[1] < p - T:
        return FAIL, ends
    if q[-1] <= 0:
        return UNSURE, ends
    if ends[0] > p + T:
        return FAIL, ends
    if ends[0] < p - T or ends[1] > p + T or leaves or lower_order(x, y, p, T, n, found is not None):
        return UNSURE, ends
    return PASS, ends


def judge(p, T, F, h, e, offer=True):
    if not all(isfinite(value) and value >= 0 for value in e):
        return FAIL, None
    m = max((k + 1 for k in range(len(e)) if e[k] > F), default=0)
    falling = all(coarse > fine > 0 for coarse, fine in zip(h, h[1:]))
    if not (0 < p < inf and 0 < T < min(0.5, p)) or m < 3 or 0 in e[:m] or not falling:
        return UNSURE, None
    x, y = [log(value) for value in h[:m]], [log(value) for value in e[:m]]
    verdict, ends = decided(p, T, h, e[:m], x, y) if h[0] / h[m - 1] >= 1.5 * (1 - 8 * EPSILON) else (UNSURE, None)
    q = [(y[k] - y[k + 1]) / (x[k] - x[k + 1]) for k in range(m - 1)]
    nothing = F == 0 and verdict != PASS and max(e[:m]) <= 1e3 * EPSILON and y[0] - y[-1] <= (x[0] - x[-1]) / 2
    alternate = any(m - 1 > 2 + k and all(abs(r) <= 0.1 for r in q[k::2]) and all(r >= 0.5 for r in q[1 - k::2]) for k in (0, 1))
    equal = [a == b and len(f"{a!r}".split("e")[0].replace(".", "").strip("0")) >= 3 for a, b in zip(e, e[1:m])]
    if nothing or alternate:
        verdict = UNSURE
    elif any(equal):
        plateau = verdict == FAIL and e[m - 3] == e[m - 2] == e[m - 1]
        verdict = FAIL if len(set(e[:m])) == 1 or plateau else UNSURE
    if offer and verdict != PASS and min(value for value in e if value) <= 1e4 * EPSILON:
        floors = [float(f"{units * EPSILON:.1e}") for units in (1e2, 1e3, 1e4, 1e5)]
        for floor in floors:
            if floor > F and judge(p, T, floor, h, e, offer=False)[0] == PASS:
                return UNSURE, ends
    return verdict, ends
