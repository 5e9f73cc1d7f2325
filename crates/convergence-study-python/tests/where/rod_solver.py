"""Heat in a rod: finite volumes around centres of cells, two steps backwards in time (BDF2); with mistakes on request."""

import numpy as np
import rod as data
from rod import exact_T


def matrix_of(n, h, mistake):
    """The matrix of conduction; conductivity at the faces of cells; weights at x_min of the value, and of the first two centres."""
    faces = np.arange(n + 1) * h
    k = data.parameter_k * (1 + faces / 4) * (1.05 if mistake == "coefficient" else 1)
    matrix = np.zeros((n, n))
    for face in range(1, n):
        left, right, flow = face - 1, face, k[face] / h**2
        matrix[left, left] += flow
        matrix[left, right] -= flow
        matrix[right, right] += flow
        matrix[right, left] -= flow
    # The slope of the parabola through the value and two centres: (-8 T_0 + 9 T_1 - T_2)/(3 h).
    weights = [-1, 1, 0] if mistake in ("value", "both") else [-8 / 3, 3, -1 / 3]
    matrix[0, 0] += weights[1] * k[0] / h**2
    matrix[0, 1] += weights[2] * k[0] / h**2
    return matrix, k, weights


def solve(n, mistake=""):
    """The error in L2 at t = 0.5 with n cells."""
    h, dt = 2 / n, 0.5 / n
    cells = (np.arange(n) + 0.5)[None, :] * h
    matrix, k, weights = matrix_of(n, h, mistake)

    def exact(t, shift=0.0):
        return np.broadcast_to(exact_T(cells + shift, t), n)

    def known(t):
        source = np.broadcast_to(data.source_T(cells, t - dt if mistake == "source" else t), n).copy()
        source[0] -= weights[0] * k[0] / h**2 * np.ravel(data.boundary_x_min_value(np.array([[0.0]]), t))[0]
        end = 2 - h / 2 if mistake in ("flux", "both") else 2.0
        source[-1] += np.ravel(data.boundary_x_max_flux(np.array([[end]]), t))[0] / h
        return source

    shift = h / 3 if mistake == "initial" else 0.0
    before, now = exact(-dt, shift), exact(0.0, shift)
    for step in range(1, n + 1):
        t = step * dt
        if mistake == "euler":
            before, now = now, np.linalg.solve(np.eye(n) / dt + matrix, now / dt + known(t))
        else:
            before, now = now, np.linalg.solve(1.5 * np.eye(n) / dt + matrix, (4 * now - before) / (2 * dt) + known(t))
    return {"L2": float(np.sqrt(np.mean((now - exact(0.5)) ** 2)))}
