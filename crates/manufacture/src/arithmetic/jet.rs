//! Truncated Taylor series in all variables about a point: the second way to derivatives, which
//! shares no rule with the graph's.

use std::collections::HashMap;
use std::rc::Rc;

use super::Algebra;
use crate::language::names::Function;
use crate::language::tree::{Binary, Relation};

/// Largest number of variables: three coordinates and time.
const VARIABLES: usize = 4;

/// The monomials up to a degree, in the order of their degrees, and their products.
#[derive(Debug)]
pub(crate) struct Monomials {
    order: usize,
    exponents: Vec<[u8; VARIABLES]>,
    places: HashMap<[u8; VARIABLES], usize>,
    /// Number of monomials of at most each degree.
    counts: Vec<usize>,
    /// For each pair the place of the product; a row ends where the degree exceeds the order.
    products: Vec<Vec<u32>>,
}

impl Monomials {
    pub(crate) fn new(variables: usize, order: usize) -> Self {
        let mut exponents = vec![[0; VARIABLES]];
        let mut counts = vec![1];
        let mut last = exponents.clone();
        for _ in 0..order {
            let mut next = vec![];
            for monomial in &last {
                // Each monomial is made once: only exponents after the last used one grow.
                let first = monomial.iter().rposition(|e| *e > 0).unwrap_or(0);
                for variable in first..variables {
                    let mut grown = *monomial;
                    grown[variable] += 1;
                    next.push(grown);
                }
            }
            exponents.extend(&next);
            counts.push(exponents.len());
            last = next;
        }
        let places: HashMap<_, _> = exponents.iter().enumerate().map(|(i, e)| (*e, i)).collect();
        let mut products = vec![];
        for left in &exponents {
            let degree = left.iter().sum::<u8>() as usize;
            let mut row = vec![];
            for right in &exponents[..counts[order - degree]] {
                let product: [u8; VARIABLES] = std::array::from_fn(|k| left[k] + right[k]);
                row.push(places[&product] as u32);
            }
            products.push(row);
        }
        Self {
            order,
            products,
            exponents,
            places,
            counts,
        }
    }
}

/// A truncated Taylor series.
#[derive(Debug, Clone)]
pub(crate) struct Jet {
    order: usize,
    /// One for each monomial of at most that degree.
    coefficients: Vec<f64>,
}

impl Jet {
    pub(crate) fn value(&self) -> f64 {
        self.coefficients[0]
    }

    fn is_constant(&self) -> bool {
        self.coefficients[1..].iter().all(|c| *c == 0.0)
    }
}

/// Jets about a point.
#[derive(Debug, Clone)]
pub(crate) struct Jets {
    pub(crate) monomials: Rc<Monomials>,
    pub(crate) point: Vec<f64>,
    pub(crate) parameters: Rc<Vec<f64>>,
    /// Points and weights of integrals over each variable.
    pub(crate) rules: Rc<Vec<Vec<[f64; 2]>>>,
}

impl Jets {
    fn times(&self, left: &Jet, right: &Jet) -> Jet {
        let order = left.order.min(right.order);
        let mut coefficients = vec![0.0; self.monomials.counts[order]];
        for (i, a) in left.coefficients[..coefficients.len()].iter().enumerate() {
            if *a == 0.0 {
                continue;
            }
            let products = &self.monomials.products[i];
            for (place, b) in products.iter().zip(&right.coefficients) {
                match coefficients.get_mut(*place as usize) {
                    Some(sum) => *sum += a * b,
                    // The products of a row grow in degree.
                    None => break,
                }
            }
        }
        Jet {
            order,
            coefficients,
        }
    }

    /// f(u) by its Taylor coefficients at the value of u, and Horner's scheme.
    fn compose(&self, argument: &Jet, taylor: &[f64]) -> Jet {
        let mut small = argument.clone();
        small.coefficients[0] = 0.0;
        let order = argument.order;
        let mut sum = Jet {
            order,
            coefficients: vec![0.0; argument.coefficients.len()],
        };
        sum.coefficients[0] = taylor[order];
        for coefficient in taylor[..order].iter().rev() {
            sum = self.times(&sum, &small);
            sum.coefficients[0] += coefficient;
        }
        sum
    }

    fn power(&mut self, base: &Jet, exponent: &Jet) -> Jet {
        let value = exponent.value();
        if !exponent.is_constant() {
            let logarithm = self.call(Function::Ln, base);
            let product = self.times(exponent, &logarithm);
            return self.call(Function::Exp, &product);
        }
        let is_small = value.fract() == 0.0 && (0.0..=64.0).contains(&value);
        if is_small {
            // Exact where the base is zero, unlike the series of a general power.
            let mut product = self.number(1.0);
            for _ in 0..value as usize {
                product = self.times(&product, base);
            }
            return product;
        }
        if base.value() == 0.0 && base.is_constant() && value > 0.0 {
            // Zero next to the point as well: so is its power, whatever derivatives that has at
            // zero.
            return base.clone();
        }
        self.compose(base, &binomial(base.value(), value, base.order))
    }
}

impl Algebra for Jets {
    type Number = Jet;

    fn number(&mut self, value: f64) -> Jet {
        let order = self.monomials.order;
        let mut coefficients = vec![0.0; self.monomials.counts[order]];
        coefficients[0] = value;
        Jet {
            order,
            coefficients,
        }
    }

    fn variable(&mut self, index: usize) -> Jet {
        let mut jet = self.number(self.point[index]);
        let mut first = [0; VARIABLES];
        first[index] = 1;
        if let Some(place) = self.monomials.places.get(&first) {
            jet.coefficients[*place] = 1.0;
        }
        jet
    }

    fn parameter(&mut self, index: usize) -> Jet {
        self.number(self.parameters[index])
    }

    fn binary(&mut self, operator: Binary, left: &Jet, right: &Jet) -> Jet {
        let sign = match operator {
            Binary::Add => 1.0,
            Binary::Subtract => -1.0,
            Binary::Multiply => return self.times(left, right),
            Binary::Divide => {
                let inverse = self.compose(right, &binomial(right.value(), -1.0, right.order));
                return self.times(left, &inverse);
            }
            Binary::Power => return self.power(left, right),
        };
        let pairs = left.coefficients.iter().zip(&right.coefficients);
        Jet {
            order: left.order.min(right.order),
            coefficients: pairs.map(|(a, b)| a + sign * b).collect(),
        }
    }

    fn call(&mut self, function: Function, argument: &Jet) -> Jet {
        self.compose(
            argument,
            &taylor(function, argument.value(), argument.order),
        )
    }

    fn choose(
        &mut self,
        comparison: Relation,
        compared: [&Jet; 2],
        then: &Jet,
        otherwise: &Jet,
    ) -> Jet {
        let [left, right] = compared.map(Jet::value);
        let is_true = comparison.holds(left, right);
        (if is_true { then } else { otherwise }).clone()
    }

    fn derivative(&mut self, of: &Jet, variable: usize) -> Jet {
        // An order that runs out would be a mistake of `Depth`: NaN makes it visible.
        let Some(order) = of.order.checked_sub(1) else {
            return self.number(f64::NAN);
        };
        let mut coefficients = vec![];
        for monomial in &self.monomials.exponents[..self.monomials.counts[order]] {
            let mut above = *monomial;
            above[variable] += 1;
            let place = self.monomials.places[&above];
            coefficients.push(f64::from(above[variable]) * of.coefficients[place]);
        }
        Jet {
            order,
            coefficients,
        }
    }

    fn rule(&self, variable: usize) -> Option<Vec<[f64; 2]>> {
        Some(self.rules[variable].clone())
    }

    fn move_to(&mut self, variable: usize, to: f64) -> f64 {
        std::mem::replace(&mut self.point[variable], to)
    }

    fn fixed(&mut self, body: &Jet, variable: usize, _at: f64) -> Jet {
        self.constant_part(body, variable)
    }

    fn integral(&mut self, body: &Jet, variable: usize) -> Result<Jet, String> {
        Ok(self.constant_part(body, variable))
    }
}

impl Jets {
    /// The part of the series that does not change with the variable.
    fn constant_part(&self, body: &Jet, variable: usize) -> Jet {
        let mut part = body.clone();
        for (coefficient, monomial) in part.coefficients.iter_mut().zip(&self.monomials.exponents) {
            if monomial[variable] > 0 {
                *coefficient = 0.0;
            }
        }
        part
    }
}

/// Taylor coefficients of x^p at x.
fn binomial(x: f64, p: f64, order: usize) -> Vec<f64> {
    let mut series = vec![x.powf(p)];
    for k in 1..=order {
        let k = k as f64;
        series.push(series[series.len() - 1] * (p - k + 1.0) / (k * x));
    }
    series
}

/// Taylor coefficients of a function at x.
fn taylor(function: Function, x: f64, order: usize) -> Vec<f64> {
    match function {
        Function::Sin => cycle([x.sin(), x.cos(), -x.sin(), -x.cos()], order),
        Function::Cos => cycle([x.cos(), -x.sin(), -x.cos(), x.sin()], order),
        Function::Sinh => cycle([x.sinh(), x.cosh(), x.sinh(), x.cosh()], order),
        Function::Cosh => cycle([x.cosh(), x.sinh(), x.cosh(), x.sinh()], order),
        Function::Exp => cycle([x.exp(); 4], order),
        Function::Sqrt => binomial(x, 0.5, order),
        Function::Ln => primitive(x.ln(), &binomial(x, -1.0, order), 1.0),
        Function::Log10 => {
            let scale = 1.0 / std::f64::consts::LN_10;
            primitive(x.log10(), &binomial(x, -1.0, order), scale)
        }
        Function::Tan => riccati(x.tan(), 1.0, order),
        Function::Tanh => riccati(x.tanh(), -1.0, order),
        Function::Atan => {
            let slope = quadratic_power([1.0 + x * x, 2.0 * x, 1.0], -1.0, order);
            primitive(x.atan(), &slope, 1.0)
        }
        Function::Asin | Function::Acos => {
            let slope = quadratic_power([1.0 - x * x, -2.0 * x, -1.0], -0.5, order);
            if function == Function::Asin {
                primitive(x.asin(), &slope, 1.0)
            } else {
                primitive(x.acos(), &slope, -1.0)
            }
        }
    }
}

/// Derivatives that repeat after four, divided by the factorials.
fn cycle(derivatives: [f64; 4], order: usize) -> Vec<f64> {
    let mut factorial = 1.0;
    let mut series = vec![];
    for k in 0..=order {
        factorial *= k.max(1) as f64;
        series.push(derivatives[k % 4] / factorial);
    }
    series
}

/// Coefficients of the function with that value and slope.
fn primitive(value: f64, slope: &[f64], scale: f64) -> Vec<f64> {
    let rest = slope[..slope.len() - 1].iter().enumerate();
    let rest = rest.map(|(k, c)| scale * c / (k + 1) as f64);
    std::iter::once(value).chain(rest).collect()
}

/// y' = 1 + sign y².
fn riccati(value: f64, sign: f64, order: usize) -> Vec<f64> {
    let mut y = vec![value];
    for k in 0..order {
        let square: f64 = (0..=k).map(|i| y[i] * y[k - i]).sum();
        let constant = if k == 0 { 1.0 } else { 0.0 };
        y.push((constant + sign * square) / (k + 1) as f64);
    }
    y
}

/// The power p of a quadratic polynomial q: g' q = p q' g.
fn quadratic_power(q: [f64; 3], p: f64, order: usize) -> Vec<f64> {
    let mut g = vec![q[0].powf(p)];
    for k in 1..=order {
        let term = |i: usize| (p * i as f64 - (k - i) as f64) * q[i] * g[k - i];
        let sum: f64 = (1..=k.min(2)).map(term).sum();
        g.push(sum / (k as f64 * q[0]));
    }
    g
}
