# NAME.py N: -u'' = pi^2 sin(pi x) on (0, 1) with u(0) = u(1) = 0, by central differences on N cells.
# The last line that it prints is its answer: errors against the exact solution sin(pi x), and values, by name.
import json
import math
import sys

n = int(sys.argv[1])
h = 1 / n
load = [math.pi**2 * math.sin(math.pi * i * h) for i in range(n + 1)]

# Elimination for -u[i-1] + 2 u[i] - u[i+1] = h^2 load[i].
ratio, right = [0.0] * (n + 1), [0.0] * (n + 1)
for i in range(1, n):
    pivot = 2 - ratio[i - 1]
    ratio[i] = 1 / pivot
    right[i] = (h * h * load[i] + right[i - 1]) / pivot
u = [0.0] * (n + 1)
for i in range(n - 1, 0, -1):
    u[i] = right[i] + ratio[i] * u[i + 1]

error = max(abs(u[i] - math.sin(math.pi * i * h)) for i in range(n + 1))
print(json.dumps({"errors": {"max": error}, "values": {"middle": u[n // 2]}}))
