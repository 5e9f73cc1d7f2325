"""Convergence studies: rates with intervals, and verdicts that are hard to fool.

>>> import convergence_study as cs
>>> h = [0.25, 0.125, 0.0625, 0.03125]
>>> cs.judge(h, [0.041, 0.0103, 0.00257, 0.000642], order=2).verdict
'pass'

`judge` and `assert_order` take existing errors, `study` a function that computes them, `limit` values without an exact solution, `rates` a file
or a text; `norms` makes errors of what is at points; `taylor` tests gradients and Hessians, `adjoint` an operator and its adjoint. All of them call the Rust crate `convergence-study`; there is no rule in Python.
"""

from ._judging import assert_order, judge, limit, rates, study
from ._native import Judgement, Limit, Study, __version__
from ._norms import norms
from ._taylor import Taylor, adjoint, taylor

__all__ = [
    "Judgement",
    "Limit",
    "Study",
    "Taylor",
    "__version__",
    "adjoint",
    "assert_order",
    "judge",
    "limit",
    "norms",
    "rates",
    "study",
    "taylor",
]
