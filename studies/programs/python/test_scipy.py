"""scipy, the orders of `solve_ivp`: its documentation claims 5 for RK45 and 3 for RK23, its tests look at tolerances."""
import numpy as np
from scipy.integrate import solve_ivp

def test_orders(convergence):
    def error(method):
        steps = lambda n: dict(first_step=8 / n, max_step=8 / n, rtol=1e3, atol=1e3)
        end = lambda n: solve_ivp(lambda t, y: y, (0, 8), [1], method, **steps(n)).y[0, -1]
        return lambda n: abs(end(n) - np.exp(8))
    convergence.study(error("RK45"), [32, 64, 128, 256], order=5)
    convergence.study(error("RK23"), [64, 128, 256, 512], order=3)
