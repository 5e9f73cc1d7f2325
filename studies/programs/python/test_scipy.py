"""scipy, the orders of `solve_ivp`: its documentation claims 5 for RK45 and 3 for RK23, its tests look at tolerances."""
import numpy as np
from scipy.integrate import solve_ivp

def test_orders(convergence):
    def error(method):
        fixed = lambda n: dict(first_step=1 / n, max_step=1 / n, rtol=1e3, atol=1e3)
        end = lambda n: solve_ivp(lambda t, y: [y[1], -np.sin(y[0])], (0, 1), [1, 0], method, **fixed(n)).y[0, -1]
        return lambda n: abs(end(n) - 0.6000853661275037)
    convergence.study(error("RK45"), [4, 8, 16, 32], order=5)
    convergence.study(error("RK23"), [8, 16, 32, 64, 128], order=3)
