"""Judges 1,000 random tables by rule.py and by the harness: rule_agrees.py HARNESS [FOLDER OF rule.py]. Exit status 1 if they differ."""
import json
import math
import random
import subprocess
import sys
import tempfile

sys.path.insert(0, sys.argv[2] if len(sys.argv) > 2 else sys.path[0])
import rule

COLUMNS = 20


def errors(p, h):
    """Pollution of either sign, scatter, wrong orders, and lower orders or limits that just begin to show."""
    order, a, r = p + random.choice([0, 0, 0.5, -0.5]), random.gauss(0, 0.5), random.uniform(0.3, 3)
    scatter, hidden = random.choice([0, 0, 1e-3, 0.02, 0.05, 0.1, 0.3]), 0.3 * random.random() ** 3 * random.choice([0, 1, 1])
    lower = order - random.choice([0.5, 1, order])
    main = [step**order * (1 + a * step**r) * math.exp(scatter * random.gauss(0, 1)) for step in h]
    share = hidden * main[-1] / h[-1] ** lower
    return [abs(value + share * step**lower) for value, step in zip(main, h)]


def agree(mine, theirs):
    verdict, ends = mine
    close = ends is None or all(abs(a - b) < 1e-7 * (1 + abs(a)) for a, b in zip(ends, theirs["interval"]))
    return verdict == theirs["verdict"] and close


random.seed(20)
verdicts, differ = [], 0
for _ in range(1000 // COLUMNS):
    T, F, p = random.choice([0.05, 0.1, 0.25, 0.4]), random.choice([0, 0, 1e-4]), random.choice([1, 1.5, 2, 3])
    h, ratio = [1.0], random.choice([2, 2, 2, 1.5, 4, 1.05, None])
    for _ in range(random.randint(2, 11)):
        h.append(h[-1] / (ratio or random.uniform(1.1, 3)))
    table = {f"e{k}": errors(p, h) for k in range(COLUMNS)}
    with tempfile.NamedTemporaryFile("w") as file:
        print("h", *table, file=file)
        for row in zip(h, *table.values()):
            print(*map(repr, row), file=file)
        file.flush()
        claims = ["--order", p, "--tolerance", T, "--floor", F, "--step", "h", "--columns", ",".join(table)]
        command = [sys.argv[1], "rates", file.name, *map(str, claims), "--format", "json"]
        rates = json.loads(subprocess.run(command, capture_output=True, text=True).stdout)
    for column, rate in zip(table.values(), rates["studies"][0]["rates"] if "studies" in rates else rates["rates"]):
        mine = rule.judge(p, T, F, h, column)
        verdicts.append(mine[0])
        differ += not agree(mine, rate)
print(", ".join(f"{verdicts.count(verdict)} {verdict}" for verdict in sorted(set(verdicts))), f"; {differ} differ", sep="")
sys.exit(differ > 0 or len(verdicts) != 1000 or len(set(verdicts)) < 3)
