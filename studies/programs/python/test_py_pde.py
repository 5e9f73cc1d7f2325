"""py-pde, finite differences: its Poisson solver, of which `tests/` compare single grids."""
import numpy as np
from pde import CartesianGrid, ScalarField, solve_poisson_equation

def test_order(convergence):
    def error(n):
        field = ScalarField.from_expression(CartesianGrid([[0, 1]], n), "-pi**2 * sin(pi * x)")
        exact = np.sin(np.pi * field.grid.axes_coords[0])
        return np.abs(solve_poisson_equation(field, bc={"value": 0}).data - exact).max()
    convergence.study(error, order=2)
