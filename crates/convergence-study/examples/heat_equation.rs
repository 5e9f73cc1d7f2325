//! The heat equation u_t = u_xx on (0, 1) by central differences and explicit Euler steps dt =
//! h²/4, judged by the harness.

use std::{env, error::Error, f64::consts::PI, path::Path};

use convergence_study::{Finished, Header, Project, VerificationError, levels};

/// The errors at t = 1/8 on n cells; the exact solution is exp(-π² t) sin(π x).
fn errors(n: usize) -> [(&'static str, f64); 2] {
    let (h, t_end) = (1.0 / n as f64, 0.125);
    let mut u: Vec<f64> = (0..=n).map(|i| (PI * i as f64 * h).sin()).collect();
    for _ in 0..(4.0 * t_end / (h * h)).round() as usize {
        let old = u.clone();
        (1..n).for_each(|i| u[i] += 0.25 * (old[i - 1] - 2.0 * old[i] + old[i + 1]));
    }
    let error = |i: usize| (u[i] - (-PI * PI * t_end).exp() * (PI * i as f64 * h).sin()).abs();
    let mean_square = (0..=n).map(|i| h * error(i).powi(2)).sum::<f64>().sqrt();
    [
        ("mean square", mean_square),
        (
            "maximum",
            (0..=n)
                .map(error)
                .max_by(f64::total_cmp)
                .unwrap_or(f64::NAN),
        ),
    ]
}

fn run(folder: &Path) -> Result<Finished, VerificationError> {
    let header = Header::new(
        "heat-equation",
        "with dt = h²/4, explicit Euler is of second order in h",
    );
    let study = levels([8, 16, 32, 64, 128], errors)
        .described(header)
        .claim("mean square", 2.0)
        .claim("maximum", 2.0);
    let found = study.run();
    let project = Project::new("heat-equation", "cargo run --example heat_equation");
    project.write_report(std::slice::from_ref(&found), folder)?;
    Ok(found)
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = env::args_os()
        .nth(1)
        .map_or_else(|| env::temp_dir().join("heat-equation"), Into::into);
    println!(
        "{}: see {}",
        run(&folder)?.outcome.verdict,
        folder.join("index.html").display()
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::run;
    use convergence_study::Verdict;

    #[test]
    fn the_report_says_that_the_scheme_is_of_second_order() {
        let folder = tempfile::tempdir().unwrap();
        let reports = folder.path().join("new/report");
        let outcome = run(&reports).unwrap().outcome;
        assert_eq!(outcome.verdict, Verdict::Pass, "{outcome:?}");
        let rates: Vec<f64> = outcome
            .rates
            .iter()
            .map(|named| named.rate.fitted.unwrap())
            .collect();
        assert!(
            rates.len() == 2 && rates.iter().all(|rate| (rate - 2.0).abs() < 0.01),
            "{rates:?}"
        );
        let page = std::fs::read_to_string(reports.join("README.md")).unwrap();
        assert!(
            page.starts_with("# Verification report\n\n**pass**: the study passes"),
            "{page}"
        );
        let files = [
            "index.html",
            "results.json",
            "junit.xml",
            "figures/heat-equation-errors.svg",
        ];
        assert!(files.iter().all(|file| reports.join(file).is_file()));
    }
}
