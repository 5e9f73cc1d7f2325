use super::typed::{changed, passes_but_not_without_each_case};
use convergence_study::{Kind, Outcome, Verdict};
use thermobeam::mesh::Mesh;
use thermobeam_exact::projection::{Projected, Target};
use thermobeam_study::studies::projection::{self, graded, study};

type Projection = projection::Projection;

fn failing(outcome: &Outcome) -> Vec<String> {
    let failing = outcome.checks.iter();
    let failing = failing.filter(|check| check.verdict != Verdict::Pass);
    failing.map(|check| check.statement()).collect()
}

#[test]
fn the_studies_pass_but_not_without_each_case() {
    for study in [study(), graded()] {
        passes_but_not_without_each_case(&study.kind);
    }
}

/// u = 0.01 x (x - 2) with a share h² x added: the order is 2 in values and 1 in slopes, as that of
/// the projection.
#[test]
fn values_that_are_no_projections_fail_at_the_same_orders() {
    let study = study().kind;
    let u = |x: f64| [0.01 * x * (x - 2.0), 0.02 * (x - 1.0), 0.02];
    for share in [0.0, 1e-2] {
        let planted = changed::<Projection>(&study.run_here(), |case, found| {
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
        assert!((failing.iter()).all(|claim| claim.starts_with("u: ")));
    }
}

#[test]
fn each_number_can_fail() {
    let study = study().kind;
    let sound = study.run_here();
    let claims = |change: &dyn Fn(&mut Projected)| {
        let planted = changed::<Projection>(&sound, |_, found| change(&mut found[4]));
        let outcome = study.judge(&planted);
        assert_ne!(outcome.verdict, Verdict::Pass);
        failing(&outcome).join("\n")
    };
    assert!(claims(&|theta| theta.residual = f64::NAN).contains("theta: largest residual"));
    assert!(claims(&|theta| theta.function_slope /= 10.0).contains("theta: of the bound (3.4)"));
    assert!(claims(&|theta| theta.function_curvature /= 2.0).contains("theta: of the bound (3.5)"));
    assert!(claims(&|theta| theta.leading_slope *= 1.01).contains("theta: slope, measured"));
    assert!(claims(&|theta| theta.value = f64::NAN).contains("theta: of the bound (3.4)"));
}
