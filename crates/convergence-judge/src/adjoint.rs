//! Is one operator the adjoint of another? `<w, A v> = <A'w, v>` for all v and w, and if it does
//! not hold, it fails for almost all of them.

use std::fmt;

use super::verdict::Verdict;

/// `<w, A v>` or `<A'w, v>`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Product {
    /// The sum of the products of components.
    pub value: f64,
    /// The sum of their absolute values, to which round-off is relative.
    pub size: f64,
}

/// Both products for one v and one w.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AdjointProducts {
    /// `<w, A v>`.
    pub forward: Product,
    /// `<A'w, v>`.
    pub backward: Product,
    /// The part of the larger size by which they may differ.
    pub to: f64,
}

impl AdjointProducts {
    fn difference(&self) -> f64 {
        (self.forward.value - self.backward.value).abs()
    }

    /// The larger size.
    fn size(&self) -> f64 {
        self.forward.size.max(self.backward.size)
    }

    /// Whether the products are equal. Two operators that give zero test nothing; NaN is a
    /// difference, and so is an infinite product, whose size would allow any.
    pub fn verdict(&self) -> Verdict {
        if self.forward.size == 0.0 && self.backward.size == 0.0 {
            Verdict::Inconclusive
        } else if self.size().is_finite() && self.difference() <= self.to * self.size() {
            Verdict::Pass
        } else {
            Verdict::Fail
        }
    }
}

impl fmt::Display for AdjointProducts {
    /// `<w, A v> = 1.5, <At w, v> = 1.4: they differ by 1.0e-1, allowed 1e-10 of 2.5`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (left, right) = (self.forward.value, self.backward.value);
        write!(f, "<w, A v> = {left:?}, <At w, v> = {right:?}: ")?;
        if self.verdict() == Verdict::Inconclusive {
            return f.write_str("A v and At w are zero: nothing is tested");
        }
        let Self { to, .. } = self;
        let difference = self.difference();
        let size = self.size();
        if !(difference + size).is_finite() {
            return f.write_str("expected finite terms in both, found NaN or infinity");
        }
        write!(
            f,
            "they differ by {difference:.1e}, allowed {to:.0e} of {size:.2e}"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::{AdjointProducts, Product};
    use crate::verdict::Verdict;

    fn products(forward: f64, backward: f64, size: f64) -> AdjointProducts {
        let product = |value| Product { value, size };
        AdjointProducts {
            forward: product(forward),
            backward: product(backward),
            to: 1e-10,
        }
    }

    fn verdict(forward: f64, backward: f64, size: f64) -> Verdict {
        products(forward, backward, size).verdict()
    }

    #[test]
    fn products_that_differ_fail_and_a_zero_tests_nothing() {
        assert_eq!(verdict(1.0, 1.0 + 1e-13, 2.0), Verdict::Pass);
        for backward in [1.0 + 1e-9, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(verdict(1.0, backward, 2.0), Verdict::Fail, "{backward}");
        }
        for infinite in [f64::INFINITY, f64::NEG_INFINITY] {
            for value in [infinite, 1.0] {
                let found = products(value, infinite, f64::INFINITY);
                assert_eq!(found.verdict(), Verdict::Fail, "{value}, {infinite}");
                assert!(
                    found.to_string().contains("expected finite terms"),
                    "{found}"
                );
            }
        }
        assert_eq!(verdict(0.0, 0.0, 0.0), Verdict::Inconclusive);
    }

    #[test]
    fn an_operator_of_which_only_the_adjoint_is_zero_has_another() {
        let zero = products(0.0, 0.0, 0.0);
        for other in [
            products(1.5, 1.5, 2.0),
            products(f64::NAN, f64::NAN, f64::NAN),
        ] {
            let [mut one, mut two] = [zero, zero];
            one.forward = other.forward;
            two.backward = other.backward;
            assert_eq!([one.verdict(), two.verdict()], [Verdict::Fail; 2], "{one}");
        }
    }

    #[test]
    fn a_sum_that_cancels_is_measured_by_its_terms() {
        assert_eq!(verdict(1e-14, -1e-14, 2.0), Verdict::Pass);
        assert_eq!(verdict(1e-14, -1e-14, 1e-14), Verdict::Fail);
    }
}
