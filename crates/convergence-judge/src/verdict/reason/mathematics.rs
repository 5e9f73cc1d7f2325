//! The mathematics behind the reasons, and what to try, most promising first.

/// Of a lower order.
pub(super) const LOST_ORDER: &str = "The error is e(h) = C h^p + D h^q + ...; the rate between two steps tends to the smallest exponent with a coefficient \
     that is not zero. What is lost tells what is wrong. Half an order: a singular solution, a boundary or initial layer, \
     data that do not match at a corner, a maximum norm. One order: a term at the wrong time level or point, a one-sided \
     difference at the boundary, a rule that is too weak for the load, a derivative measured in place of the function, a \
     first step of lower order repeated at every restart. All of it, a rate of 0: a term is missing or has the wrong sign or \
     coefficient, so that e tends to a constant. A rate below 0: the scheme is unstable. To try, in this order: one level \
     coarser and one finer; the other errors of the same run, for the field that lost most is next to the cause; terms \
     switched off one by one, until the order is back; a solution that is a polynomial in the discrete space, whose error \
     must be round-off; the residual of the exact solution in the discrete equations.";

/// Of errors that tend to a constant.
pub(super) const PLATEAU: &str = "A plateau: e(h) = |E + C h^p| with E that does not depend on h. The rates are p - log2 of something that doubles 2^p \
     times as fast as the error falls: they leave p within one or two levels, then are 0. E is what does not change with the \
     step. To try, in this order: a tenth of the solver's tolerance (E falls with it); the other step halved (E falls by its \
     order: isolate the axis, or couple the steps); a finer reference; double precision, where the plateau rises again as \
     h falls, like 1/h or 1/h^2: round-off. If nothing moves E, it is a wrong coefficient: e(h) - e(h/2) still has order p.";

/// Of a rate above the order.
pub(super) const TOO_FAST: &str = "A scheme converges faster than its order only where the leading coefficient C vanishes: by symmetry, on an equidistant \
     mesh, at points of superconvergence, for a polynomial, or before the coarse levels resolve the solution (D h^q with \
     q > p is still larger). To try: a solution without symmetry; a mapped or perturbed mesh; a norm that is not taken at \
     nodes; finer levels, until C h^p is the larger one. If it stays, claim the higher order.";

/// Of a constant in front of the right power.
pub(super) const OTHER_CONSTANT: &str = "e(h) = C h^p with the right p: what is wrong is itself of order p. A factor 2 in C is a weight of a quadrature or a half \
     of a coefficient; a factor 2^p a step taken for its half; anything else a norm that is another one. To try: the same \
     level by hand, or by an independent program; the local truncation error, term by term.";

/// Of what is no error.
pub(super) const NO_ERROR: &str = "No rate can be had from what is no error. A run that breaks down on coarse levels alone meets a step restriction \
     (dt <= C h or C h^2); on fine ones alone a lost pivot, a Jacobian that is not the derivative, or a tolerance below \
     round-off; on all levels an instability or missing data. To try: the first step of the coarsest failing level; the same \
     with a tenth of dt; the energy step by step, which shows the step at which it begins.";

/// Of errors that are those of another run.
pub(super) const REPEATED_RUN: &str = "Two discretizations of one problem have errors that differ in the second digit, and never agree in all of them. Errors \
     that do are one number, printed twice: a file that a failed run has left, a count that the program does not read or \
     rounds, a last step that is cut or left out so that runs end at other times, one norm for two fields. To try: print \
     the number of unknowns and the end time beside each error; delete all output, then run one level alone.";

/// Of errors that are lost in round-off.
pub(super) const ROUND_OFF: &str = "Subtraction leaves an error of about 1e-16 times the condition of the problem, which grows like 1/h or 1/h^2: the sum \
     C h^p + eps/h^k has a minimum, and levels beyond it say nothing. To try: coarser levels; a larger solution error by \
     a less smooth solution; more digits in the output.";

/// Of an interval that decides nothing.
pub(super) const NEXT_TERM: &str = "From levels h_1 > h_2 > ... the rate at h -> 0 is fitted, with the next term of e(h) = C h^p (1 + a h^r) unknown: the \
     interval holds every p that some such law gives. It narrows like the finest h^r, and with the number of levels. To \
     try: a finer level, which is worth more than three coarse ones; steps in one fixed ratio; an error without changes \
     of sign; then a wider tolerance, below half an order.";
