use super::refused::refusal;
use super::typed::{changed, passes_but_not_without_each_case};
use super::{file, text};
use convergence_study::internal::study::kind::run_cases_here;
use convergence_study::{FromFile, Kind, Outcome, Verdict};
use thermobeam::mesh::Mesh;
use thermobeam_exact::projection::{Projected, Target};
use thermobeam_study::kinds::orders::{ErrorSource as _, Orders, projection};

type Projection = Orders<projection::Projection>;

fn study(name: &str) -> Projection {
    Projection::read(file(name)).unwrap_or_else(|error| panic!("{error}"))
}

fn failing(outcome: &Outcome) -> Vec<String> {
    let failing = outcome.checks.iter();
    let failing = failing.filter(|check| check.verdict != Verdict::Pass);
    failing.map(|check| check.claim.to_string()).collect()
}

#[test]
fn the_files_pass_but_not_without_each_case() {
    for name in ["projection.toml", "projection-graded.toml"] {
        passes_but_not_without_each_case(&study(name));
    }
}

/// u = 0.01 x (x - 2) with a share h² x added: the order is 2 in values and 1 in slopes, as that of
/// the projection.
#[test]
fn values_that_are_no_projections_fail_at_the_same_orders() {
    let study = study("projection.toml");
    let u = |x: f64| [0.01 * x * (x - 2.0), 0.02 * (x - 1.0), 0.02];
    for share in [0.0, 1e-2] {
        let planted = changed::<Projection>(&run_cases_here(&study), |case, found| {
            let mesh = Mesh::uniform(16 << case).expect("a mesh");
            let h = mesh.nodes()[1];
            let nodal: Vec<f64> = (mesh.nodes().iter())
                .map(|&x| u(x)[0] + share * h * h * x)
                .collect();
            found[0] = Projected::measure(&u, &mesh, &nodal, Target::Clamped);
        });
        let outcome = study.judge(&planted);
        assert!(
            (outcome.rates.iter()).all(|named| named.rate.verdict == Verdict::Pass),
            "{}",
            outcome.summary
        );
        let failing = failing(&outcome);
        assert_eq!(failing.is_empty(), share == 0.0, "{failing:?}");
        assert!((failing.iter()).all(|claim| claim.starts_with("u ") || claim.starts_with("u:")));
    }
}

#[test]
fn each_number_can_fail() {
    let study = study("projection.toml");
    let sound = run_cases_here(&study);
    let claims = |change: &dyn Fn(&mut Projected)| {
        let planted = changed::<Projection>(&sound, |_, found| change(&mut found[4]));
        let outcome = study.judge(&planted);
        assert_ne!(outcome.verdict, Verdict::Pass);
        failing(&outcome).join("\n")
    };
    assert!(claims(&|theta| theta.residual = f64::NAN).contains("starts from its projection"));
    assert!(claims(&|theta| theta.function_slope /= 10.0).contains("is within (3.4)"));
    assert!(claims(&|theta| theta.function_curvature /= 2.0).contains("is within (3.4)"));
    assert!(claims(&|theta| theta.leading_slope *= 1.01).contains("predicted"));
    assert!(claims(&|theta| theta.value = f64::NAN).contains("finite"));
    // A rough function claimed to be smooth.
    let smooth = text("projection.toml").replace("rough = [\"phi_t\"]\n", "");
    let smooth = Projection::parse(&smooth, "p.toml".as_ref()).expect("a study");
    let outcome = smooth.judge(&run_cases_here(&smooth));
    assert!(failing(&outcome).join("\n").contains("phi_t"));
}

#[test]
fn a_file_that_makes_no_sense_is_refused() {
    for (from, to, message) in [
        ("[16, 32", "[32, 16", "projection.elements"),
        ("[\"phi_t\"]", "[\"v\"]", "projection.rough"),
        ("u = \"0.01*x*(x-2)\"\n", "", "\"u\" without initial.u"),
        ("\"0.01*x*(x-2)\"", "\"1/(x-0.5)\"", "initial.u"),
        ("theta_a = 20.0", "theta_a = 19.0", "initial.theta"),
        ("error = \"u\"", "error = \"u_xx\"", "expect[0].error"),
    ] {
        let message_of = refusal(&projection::Projection::ROW, "projection.toml", from, to);
        assert!(message_of.contains(message), "{message_of}");
    }
}
