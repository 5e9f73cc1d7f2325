"""A pendulum of amplitude 1 by the classical Runge-Kutta scheme: its angle at t = 5, of which no exact value is at hand."""
from math import sin


def angle(steps):
    dt = 5 / steps
    f = lambda y: (y[1], -sin(y[0]))
    add = lambda y, c, k: (y[0] + c * k[0], y[1] + c * k[1])
    y = (1.0, 0.0)
    for _ in range(steps):
        k1 = f(y)
        k2 = f(add(y, dt / 2, k1))
        k3 = f(add(y, dt / 2, k2))
        k4 = f(add(y, dt, k3))
        y = tuple(y[i] + dt / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]) for i in range(2))
    return y[0]


# For the harness:
import json
import sys

steps = int(sys.argv[1])
print(json.dumps({"values": {"angle": angle(steps)}, "dt": 5 / steps, "work": 4 * steps}))
