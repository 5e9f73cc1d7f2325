//! Limits on what a file may request: all in one place, each with its reason. `document` limits the
//! size of the file itself.
//!
//! All limits are far beyond practical use and far below what overloads a machine. They are checked
//! when a file is read: a typing error gives a message with its line, not a process that the
//! operating system kills after an hour.

use convergence_study::file::{Count, Refusal};

/// Time steps of a run: a quarter of an hour for one element, a week for a thousand. More is a
/// typing error.
pub(crate) const STEPS: usize = 10_000_000_000;

/// Time steps of a run that records every step: some 64 bytes each, 640 MB.
pub(crate) const RECORDED_STEPS: usize = 10_000_000;

/// Bytes per element of a run: blocks of the matrix and of its factors, and the vectors of three
/// fields. Measured: 486 at a million elements, everything included.
const BYTES_PER_ELEMENT: usize = 500;

/// Bytes that a run may need.
const RUN_BYTES: usize = 4 << 30;

/// Cases of a study, each with a label, a result and a row in the report.
const CASES: usize = 1_000_000;

/// Bytes of such a case, excluding its curves.
const BYTES_PER_CASE: usize = 1000;

/// Points along an axis of a map: more would exceed the pixels of a figure, and each point keeps
/// eight numbers.
pub(crate) const MAP_POINTS: usize = 400;

/// Elements of a mesh whose modes are found by a dense method: six matrices of (2n)² numbers, 1.5
/// GiB.
pub(crate) const DENSE_ELEMENTS: usize = 3000;

/// Modes of vibration: the mesh has ten times as many nodes, and beyond some thousand, neighbouring
/// modes hardly differ.
pub(crate) const MODES: usize = 10_000;

/// Largest number of cases of a sweep.
pub(crate) const SWEEP_CASES: usize = 100_000_000;

/// Values of one key of a sweep's grid.
pub(crate) const SWEEP_VALUES: usize = 1_000_000;

/// Bytes that a running sweep keeps for each case: its number, once for running it and once for
/// writing its line.
const BYTES_PER_SWEEP_CASE: usize = 16;

/// A number of bytes, in words.
fn memory(bytes: f64) -> String {
    const GIB: f64 = (1u64 << 30) as f64;
    format!("about {:.1} GiB of memory", bytes / GIB)
}

/// Maximum number of elements of a mesh.
pub(crate) const ELEMENTS: usize = RUN_BYTES / BYTES_PER_ELEMENT;

/// A number of elements that fits into memory.
pub(crate) type Elements = Count<1, ELEMENTS>;

/// Refuses a mesh whose run by dG(q) on elements of degree p does not fit into memory; the message
/// names the field at `path`.
///
/// A block of the unknowns takes 29 (q + 1) + 20 numbers, a matrix of the elimination 9 (q + 1)²:
/// three for each node, and 14 + 3p for each length of elements, in at least two factorisations.
///
/// * `lengths`: the number of different element lengths.
pub(crate) fn memory_of_dg(
    path: &str,
    elements: usize,
    lengths: usize,
    p: usize,
    q: usize,
) -> Result<(), Refusal> {
    let (elements, stages) = (elements as f64, (q + 1) as f64);
    let blocks = elements * (1 + 2 * (p / 2)) as f64;
    let numbers = blocks * (29.0 * stages + 20.0)
        + 18.0 * stages * stages * (3.0 * elements + (14 + 3 * p) as f64 * lengths as f64);
    if 8.0 * numbers <= RUN_BYTES as f64 {
        return Ok(());
    }
    let more = format!(", which would take {}", memory(8.0 * numbers));
    let most = RUN_BYTES >> 30;
    let allowed = format!("a mesh that takes at most {most} GiB with degree p = {p} and q = {q}");
    Err(Refusal::written_and(path, more, allowed))
}

/// Refuses more than `most` steps from 0 to `t_end`; the message names the field at `path`.
pub(crate) fn steps_to(path: &str, t_end: f64, dt: f64, most: usize) -> Result<(), Refusal> {
    let steps = (t_end / dt).round();
    if steps <= most as f64 {
        return Ok(());
    }
    let more = format!(", which is {steps:.3e} steps of {dt:?} to t = {t_end:?}");
    let allowed = format!("at most {:e} steps", most as f64);
    Err(Refusal::written_and(path, more, allowed))
}

/// Refuses a mesh that is too fine for a dense method; the message names the field at `path`.
pub(crate) fn dense(path: &str, elements: usize) -> Result<(), Refusal> {
    if elements <= DENSE_ELEMENTS {
        return Ok(());
    }
    let bytes = memory(6.0 * (2.0 * elements as f64).powi(2) * 8.0);
    let found = format!("{elements}, whose modes would take {bytes}");
    let allowed =
        format!("at most {DENSE_ELEMENTS}, where time is isolated by the modes of the mesh");
    Err(Refusal::new(path, found, allowed))
}

/// Refuses a study with too many cases; the message names the field at `path`.
pub(crate) fn case_count(path: &str, factors: &[usize]) -> Result<(), Refusal> {
    let cases: f64 = factors.iter().map(|&factor| factor as f64).product();
    if cases <= CASES as f64 {
        return Ok(());
    }
    let bytes = memory(cases * BYTES_PER_CASE as f64);
    let more = format!(", which makes {cases:.3e} cases and would take {bytes}");
    Err(Refusal::written_and(
        path,
        more,
        format!("at most {CASES} cases"),
    ))
}

/// The refusal of a sweep with too many cases, at the field `path`.
pub(crate) fn too_many_cases(path: &str, cases: f64) -> Refusal {
    let bytes = memory(cases * BYTES_PER_SWEEP_CASE as f64);
    let found = format!("{cases:.3e} cases, which would take {bytes}");
    Refusal::new(path, found, format!("at most {SWEEP_CASES} cases"))
}
