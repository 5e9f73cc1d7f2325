//! Taylor tests of derivatives that Python computes.

use convergence_judge::adjoint::{AdjointProducts, Product};
use convergence_study::{TaylorFindings, TaylorTest};
use pyo3::prelude::*;

use crate::values::refuse;

/// Where and how a derivative is tested.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Options {
    at: Vec<f64>,
    scales: Option<Vec<f64>>,
    along: Option<Vec<Vec<f64>>>,
    drawn: usize,
    seed: u64,
    to: f64,
}

/// What a Taylor test has found: its verdict, it in words, and it in JSON.
///
/// * `value`: J of a list of numbers; `slope`: dJ·d of a list of numbers, `curvature` d'Hd.
#[pyfunction]
pub(crate) fn taylor(
    value: &Bound<'_, PyAny>,
    slope: &Bound<'_, PyAny>,
    curvature: Option<&Bound<'_, PyAny>>,
    options: Options,
) -> PyResult<(&'static str, String, String)> {
    let mut test = TaylorTest::at(&options.at).to(options.to);
    if let Some(scales) = &options.scales {
        test = test.scales(scales);
    }
    test = match &options.along {
        Some(along) => test.along(&along.iter().map(Vec::as_slice).collect::<Vec<_>>()),
        None => test.drawn(options.drawn, options.seed),
    };
    let mut second = |direction: &[f64]| match curvature {
        Some(curvature) => called(curvature, direction),
        None => Ok(f64::NAN),
    };
    let found: TaylorFindings = test.try_run(
        |m| called(value, m),
        |direction| called(slope, direction),
        if curvature.is_some() {
            Some(&mut second)
        } else {
            None
        },
    )?;
    let json = serde_json::to_string(&found).map_err(refuse)?;
    Ok((found.verdict().name(), found.to_string(), json))
}

/// The number that a function of Python returns at a point.
fn called(function: &Bound<'_, PyAny>, point: &[f64]) -> PyResult<f64> {
    function.call1((point.to_vec(),))?.extract()
}

/// Why an operator is not shown to be the adjoint of another; None if it is.
///
/// * `forward`, `backward`: `<w, A v>` and `<At w, v>`, each with the sum of the absolute values of
///   its terms.
#[pyfunction]
pub(crate) fn adjoint(forward: (f64, f64), backward: (f64, f64), to: f64) -> Option<String> {
    let [forward, backward] = [forward, backward].map(|(value, size)| Product { value, size });
    let products = AdjointProducts {
        forward,
        backward,
        to,
    };
    (!products.verdict().is_pass()).then(|| products.to_string())
}
