"""Advection and diffusion in the unit square: vertices, central differences, ghost points for slopes, the trapezoidal rule; with mistakes on
request."""

import numpy as np
import plane as data


class Line:
    """The matrix along a line; the weights of the value before the unknowns, and of the slope behind them."""

    def __init__(self, n, axis, mistake):
        h = 1 / n
        speed = [data.parameter_b_x, data.parameter_b_y][axis]
        rate = data.parameter_a * (1.1 if mistake == "coefficient" and axis == 1 else 1)
        before, here, behind = -rate / h**2 - speed / (2 * h), 2 * rate / h**2, -rate / h**2 + speed / (2 * h)
        if mistake == "upwind" and axis == 1:
            before, here, behind = -rate / h**2 - speed / h, 2 * rate / h**2 + speed / h, -rate / h**2
        self.matrix = np.diag(np.full(n, here)) + np.diag(np.full(n - 1, before), -1) + np.diag(np.full(n - 1, behind), 1)
        is_one_sided = mistake in ("slope", "both") and axis == 0
        self.matrix[-1, -1 if is_one_sided else -2] += behind
        self.first, self.last = before, behind * (h if is_one_sided else 2 * h)
        self.eigen, self.back = np.linalg.eig(self.matrix)
        self.forth = np.linalg.inv(self.back)


def solve(n, mistake=""):
    """The error in L2 at t = 0.5 with n cells along an edge."""
    h, end = 1 / n, 0.5
    dt, grid = end / n, np.linspace(0, 1, n + 1)[1:]
    points = np.array(np.meshgrid(grid, grid, indexing="ij"))
    x, y = Line(n, 0, mistake), Line(n, 1, mistake)
    value_at = h / 2 if mistake == "both" else 0

    def at(place, axis):
        face = np.full(n, place)
        return np.array([face, grid] if axis == 0 else [grid, face])

    def known(t):
        """Source and boundary data."""
        f = np.array(data.source_u(points, t - dt / 2 if mistake == "source" else t)).reshape(n, n).copy()
        f[0, :] -= x.first * np.broadcast_to(data.exact_u(at(value_at, 0), t), n)
        f[:, 0] -= y.first * np.broadcast_to(data.exact_u(at(0, 1), t), n)
        f[-1, :] -= x.last * np.broadcast_to(data.boundary_x_max_slope(at(1, 0), t), n)
        f[:, -1] -= y.last * np.broadcast_to(data.boundary_y_max_slope(at(1, 1), t - dt if mistake == "late slope" else t), n)
        return f

    u = np.broadcast_to(data.exact_u(points + (h / 2 if mistake == "initial" else 0), 0.0), (n, n)).copy()
    for step in range(n):
        old, new = step * dt, (step + 1) * dt
        right = u / dt - (x.matrix @ u + u @ y.matrix.T) / 2 + (known(old) + known(new)) / 2
        scaled = x.forth @ right @ y.forth.T / (1 / dt + (x.eigen[:, None] + y.eigen) / 2)
        u = np.real(x.back @ scaled @ y.back.T)
    return {"L2": float(np.sqrt(np.mean((u - data.exact_u(points, end)) ** 2)))}
