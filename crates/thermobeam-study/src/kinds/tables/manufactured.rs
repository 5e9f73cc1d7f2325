//! The table `[exact]`: sums of products of a function of x and a function of t.

use crate::expression::Variable;
use crate::kinds::prelude::*;
use crate::scene::tables::FunctionField;

/// The sources hold second derivatives, in space and in time.
const DERIVATIVES: usize = 2;

/// The table `[exact]`.
pub(crate) fn manufactured(root: &Section<'_>, beam: &Beam, t_end: f64) -> Result<Manufactured, InputError> {
    let allowed = "a table with at least one of u, phi, theta";
    let section = root.require("exact", allowed)?.section()?;
    section.allow(&["u", "phi", "theta"])?;
    let exact = Manufactured {
        u: clamped_products(&section, "u", t_end)?,
        phi: clamped_products(&section, "phi", t_end)?,
        theta: products(&section, "theta", t_end)?.into_iter().map(|(_, product)| product).collect(),
    };
    if exact.u.is_empty() && exact.phi.is_empty() && exact.theta.is_empty() {
        return Err(root.refuse("exact", "an empty table", allowed));
    }
    for (x, expected) in [(0.0, beam.theta_a), (1.0, 0.0)] {
        temperature_meets(&section, &exact.theta, x, expected, t_end)?;
    }
    Ok(exact)
}

/// The products of a field that vanishes at x = 0.
fn clamped_products(section: &Section<'_>, key: &str, t_end: f64) -> Result<Vec<Product>, InputError> {
    let products = products(section, key, t_end)?;
    for (field, product) in &products {
        let found = product.x.eval(0.0);
        if found.abs() > product.x.roundoff(1.0) {
            return Err(field.refuse(format!("{found:?} at x = 0"), "0 at x = 0, the clamped end"));
        }
    }
    Ok(products.into_iter().map(|(_, product)| product).collect())
}

/// The products of a field, each with the place of its function of x.
fn products<'a>(section: &Section<'a>, key: &str, t_end: f64) -> Result<Vec<(Field<'a>, Product)>, InputError> {
    let allowed = "a list of at least one { x = \"...\", t = \"...\" }";
    let Some(field) = section.get(key) else { return Ok(Vec::new()) };
    let items = field.items(allowed)?;
    if items.is_empty() {
        return Err(field.refuse_as_written(allowed));
    }
    items.iter().map(|item| product(&item.section()?, t_end)).collect()
}

fn product<'a>(section: &Section<'a>, t_end: f64) -> Result<(Field<'a>, Product), InputError> {
    section.allow(&["x", "t"])?;
    let factor = |key: &str, variable: Variable, end: f64| {
        let field = section.require(key, &format!("a function of {} in quotes", variable.name()))?;
        let function = field.expression(variable)?;
        field.finite(&function, end, DERIVATIVES)?;
        Ok::<_, InputError>((field, function))
    };
    let (field, x) = factor("x", Variable::X, 1.0)?;
    let (_, t) = factor("t", Variable::T, t_end)?;
    Ok((field, Product { x: x.into(), t: t.into() }))
}

/// θ(x, t) = `expected` at an end of the beam, at some times, up to round-off.
fn temperature_meets(
    section: &Section<'_>,
    theta: &[Product],
    x: f64,
    expected: f64,
    t_end: f64,
) -> Result<(), InputError> {
    // Not a number of periods that a study is likely to last.
    const TIMES: u32 = 7;
    // A value of X is as wrong as X is large, and T magnifies it; the other way round, too.
    let slack: f64 = theta.iter().map(|p| 2.0 * p.x.roundoff(1.0) * p.t.size(t_end)).sum();
    for time in (0..=TIMES).map(|i| t_end * f64::from(i) / f64::from(TIMES)) {
        // `sum` of nothing is -0, which would be shown.
        let found = theta.iter().fold(0.0, |sum, p| sum + p.x.eval(x) * p.t.eval(time));
        if (found - expected).abs() > slack {
            let found = format!("theta = {found:?} at x = {x}, t = {time:?}");
            let end = if x == 0.0 { "beam.theta_a at x = 0" } else { "0 at x = 1" };
            return Err(section.refuse("theta", found, format!("theta = {expected:?}: it must be {end} at all times")));
        }
    }
    Ok(())
}
