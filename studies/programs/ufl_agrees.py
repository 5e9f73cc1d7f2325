"""The sources of `pieces` in UFL against those in NumPy, at points of the domain: `ufl_agrees.py FOLDER`."""
import random
import sys

import numpy as np
import ufl

sys.path.insert(0, sys.argv[1])
import pieces
import pieces_ufl

random.seed(1)
compared = 0
for name in ("source_a", "source_b", "source_c", "source_d1", "exact_T", "gradient_T", "initial_T"):
    for _ in range(50):
        x = [random.uniform(0.1, 0.9), random.uniform(0.2, 0.8)]
        arguments = (x,) if name.startswith("initial") else (x, random.uniform(0.5, 1))
        expression = getattr(pieces_ufl, name)(*arguments)
        expected = np.atleast_1d(getattr(pieces, name)(*arguments))
        for place, value in enumerate(expected):
            # An expression of numbers is evaluated without a mesh.
            component = expression[place] if expression.ufl_shape else expression
            found = float(ufl.as_ufl(component)(()))
            assert abs(found - value) <= 1e-11 * max(abs(value), 1), f"{name}[{place}] at {arguments}: {found}, not {value}"
            compared += 1
assert compared >= 500, compared
print(f"{compared} values agree")
