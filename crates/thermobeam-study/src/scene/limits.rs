//! What a file may ask for: all limits in one place, each with its reason. How large it may be
//! itself is for `document` to say.
//!
//! Every number is far beyond use and far below what brings a machine down. They are checked when a file is read, so that
//! a typing error is a complaint with its line, and not a process that the operating system ends after an hour.

use convergence_study::input::{Field, InputError};

/// Time steps of a run: a quarter of an hour for one element, a week for a thousand. More is a typing error.
pub(crate) const STEPS: usize = 10_000_000_000;

/// Time steps of a run that keeps numbers of each of them: some 64 bytes, 640 MB.
pub(crate) const RECORDED_STEPS: usize = 10_000_000;

/// Bytes that a run needs per element: blocks of the matrix and of its factors, and the vectors of three fields.
/// Measured: 486 at a million elements, everything included.
const BYTES_PER_ELEMENT: usize = 500;

/// Bytes that a run may need.
const RUN_BYTES: usize = 4 << 30;

/// Cases of a study, each with a label, a result and a row in the report.
const CASES: usize = 1_000_000;

/// Bytes of such a case, its curves left out.
const BYTES_PER_CASE: usize = 1000;

/// Points along an axis of a map: a figure has fewer pixels for more, and each point keeps eight numbers.
pub(crate) const MAP_POINTS: usize = 400;

/// Elements of a mesh whose modes are found by a dense method: six matrices of (2n)² numbers, 1.5 GiB.
pub(crate) const DENSE_ELEMENTS: usize = 3000;

/// Modes of vibration: the mesh has ten times as many nodes, and beyond some thousand a mode is the next one's neighbour.
pub(crate) const MODES: usize = 10_000;

/// Largest number of cases of a sweep.
pub(crate) const SWEEP_CASES: usize = 100_000_000;

/// Values of one key of a sweep's grid.
pub(crate) const SWEEP_VALUES: usize = 1_000_000;

/// Samples of a sweep drawn at random: all are drawn when the file is read, 16 bytes a key each.
pub(crate) const SWEEP_SAMPLES: usize = 10_000_000;

/// Bytes that a sweep keeps of a case while it runs: its number, whether it is done, where its line is.
const BYTES_PER_SWEEP_CASE: usize = 40;

/// So many bytes, in words.
pub(crate) fn memory(bytes: f64) -> String {
    const GIB: f64 = (1u64 << 30) as f64;
    format!("about {:.1} GiB of memory", bytes / GIB)
}

/// The most elements that a mesh may have.
pub(crate) const ELEMENTS: usize = RUN_BYTES / BYTES_PER_ELEMENT;

/// A number of elements that fits into memory.
pub(crate) fn elements(field: &Field<'_>) -> Result<usize, InputError> {
    let elements = field.count(1..=usize::MAX)?;
    if elements <= ELEMENTS {
        return Ok(elements);
    }
    let found = format!("{elements}, which would take {}", memory_of_elements(elements as f64));
    Err(field.refuse(found, format!("a whole number >= 1 and <= {ELEMENTS} ({} GiB)", RUN_BYTES >> 30)))
}

/// Refuses a mesh whose run by dG(q) on elements of degree p does not fit into memory; `field` is what is to blame.
///
/// A block of the unknowns takes 29 (q + 1) + 20 numbers, a matrix of the elimination 9 (q + 1)²: three for each node, and
/// 14 + 3p for each length of elements, of at least two factorisations.
///
/// * `lengths`: how many different lengths the elements have.
pub(crate) fn any_order_memory(
    field: &Field<'_>,
    elements: usize,
    lengths: usize,
    p: usize,
    q: usize,
) -> Result<(), InputError> {
    let (elements, stages) = (elements as f64, (q + 1) as f64);
    let blocks = elements * (1 + 2 * (p / 2)) as f64;
    let numbers = blocks * (29.0 * stages + 20.0)
        + 18.0 * stages * stages * (3.0 * elements + (14 + 3 * p) as f64 * lengths as f64);
    if 8.0 * numbers <= RUN_BYTES as f64 {
        return Ok(());
    }
    let found = format!("{}, which would take {}", field.as_written(), memory(8.0 * numbers));
    Err(field
        .refuse(found, format!("a mesh that takes at most {} GiB with degree p = {p} and q = {q}", RUN_BYTES >> 30)))
}

/// The memory that a run with `elements` elements takes, in words.
pub(crate) fn memory_of_elements(elements: f64) -> String {
    memory(elements * BYTES_PER_ELEMENT as f64)
}

/// Refuses the steps from 0 to `t_end` where there are more than `most`; `field` is what is to blame.
pub(crate) fn steps_until(field: &Field<'_>, t_end: f64, dt: f64, most: usize) -> Result<(), InputError> {
    let steps = (t_end / dt).round();
    if steps <= most as f64 {
        return Ok(());
    }
    let found = format!("{}, which is {steps:.3e} steps of {dt:?} to t = {t_end:?}", field.as_written());
    Err(field.refuse(found, format!("at most {:e} steps", most as f64)))
}

/// Refuses a mesh that is too fine for a dense method; `field` is what is to blame.
pub(crate) fn dense(field: &Field<'_>, elements: usize) -> Result<(), InputError> {
    if elements <= DENSE_ELEMENTS {
        return Ok(());
    }
    let bytes = memory(6.0 * (2.0 * elements as f64).powi(2) * 8.0);
    let found = format!("{elements}, whose modes would take {bytes}");
    Err(field.refuse(found, format!("at most {DENSE_ELEMENTS}, where time is isolated by the modes of the mesh")))
}

/// Refuses a study of more cases than can be listed; `field` is what is to blame.
pub(crate) fn cases(field: &Field<'_>, factors: &[usize]) -> Result<(), InputError> {
    let cases: f64 = factors.iter().map(|&factor| factor as f64).product();
    if cases <= CASES as f64 {
        return Ok(());
    }
    let found = format!(
        "{}, which makes {cases:.3e} cases and would take {}",
        field.as_written(),
        memory(cases * BYTES_PER_CASE as f64)
    );
    Err(field.refuse(found, format!("at most {CASES} cases")))
}

/// What is said of a sweep with too many cases: what was found, and what is allowed.
pub(crate) fn sweep_refusal(cases: f64) -> (String, String) {
    let bytes = memory(cases * BYTES_PER_SWEEP_CASE as f64);
    (format!("{cases:.3e} cases, which would take {bytes}"), format!("at most {SWEEP_CASES} cases"))
}
