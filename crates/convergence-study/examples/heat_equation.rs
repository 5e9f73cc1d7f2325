//! The heat equation u_t = u_xx on (0, 1) by central differences and explicit Euler steps dt = h²/4, judged by the harness.

use std::{env, error::Error, f64::consts::PI, path::Path};

use convergence_study::project::Project;
use convergence_study::study::{Axis, ErrorsOverLevels, Header, NamedErrors, Refinement, erased};
use convergence_study::text::number::max_or_nan;
use convergence_study::verify::{Verification, VerificationError, run_and_report};

/// The errors at t = 1/8 on n cells; the exact solution is exp(-π² t) sin(π x).
fn errors(n: usize) -> NamedErrors {
    let (h, t_end) = (1.0 / n as f64, 0.125);
    let mut u: Vec<f64> = (0..=n).map(|i| (PI * i as f64 * h).sin()).collect();
    for _ in 0..(4.0 * t_end / (h * h)).round() as usize {
        let old = u.clone();
        (1..n).for_each(|i| u[i] += 0.25 * (old[i - 1] - 2.0 * old[i] + old[i + 1]));
    }
    let error = |i: usize| (u[i] - (-PI * PI * t_end).exp() * (PI * i as f64 * h).sin()).abs();
    let mean_square = (0..=n).map(|i| h * error(i).powi(2)).sum::<f64>().sqrt();
    vec![("mean square", mean_square), ("maximum", (0..=n).map(error).fold(0.0, max_or_nan))]
}

fn report(folder: &Path) -> Result<Verification, VerificationError> {
    let header = Header::new("heat-equation", "with dt = h²/4, explicit Euler is of second order in h");
    let levels = Refinement::counted("cells", [8, 16, 32, 64, 128], |n| 1.0 / n as f64);
    let study = ErrorsOverLevels::new(header, Axis::Space, levels, |&n| Ok(errors(n)))
        .claiming("mean square", 2.0, 0.05)
        .claiming("maximum", 2.0, 0.05);
    run_and_report(&Project::new("heat-equation", "cargo run --example heat_equation"), &[erased(study)], folder)
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = env::args_os().nth(1).map_or_else(|| env::temp_dir().join("heat-equation"), Into::into);
    let found = report(&folder)?;
    println!("{}: see {}", found.verdict, folder.join("index.html").display());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::report;
    use convergence_study::judge::verdict::Verdict;

    #[test]
    fn the_report_says_that_the_scheme_is_of_second_order() {
        let folder = tempfile::tempdir().unwrap();
        let found = report(&folder.path().join("new/report")).unwrap();
        assert_eq!(found.verdict, Verdict::Pass, "{:?}", found.finished[0].outcome);
        let rates: Vec<f64> = found.finished[0].outcome.rates.iter().map(|(_, rate)| rate.fitted.unwrap()).collect();
        assert!(rates.len() == 2 && rates.iter().all(|rate| (rate - 2.0).abs() < 0.01), "{rates:?}");
        let page = std::fs::read_to_string(found.reports.join("README.md")).unwrap();
        assert!(page.starts_with("# Verification report\n\n**pass**: the study passes"), "{page}");
        let files = ["index.html", "results.json", "junit.xml", "errors.csv", "figures/heat-equation-errors.svg"];
        assert!(files.iter().all(|file| found.reports.join(file).is_file()));
    }

    #[test]
    fn the_example_is_short() {
        let program = include_str!("heat_equation.rs").split("\n#[cfg(test)]").next().unwrap();
        assert!(program.lines().count() <= 40, "{} lines", program.lines().count());
    }
}
