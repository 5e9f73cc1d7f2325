use thermobeam::mesh::Mesh;
use thermobeam_exact::projection::{Projected, Target};
use thermobeam_study::studies::projection::study;

use super::*;

/// u = 0.01 x (x - 2) with a share h² x added: the order is 2 in values and 1 in slopes, as that of
/// the projection.
#[test]
fn values_that_are_no_projections_fail_at_the_same_orders() {
    let sound = Sound::run(study().kind);
    let u = |x: f64| [0.01 * x * (x - 2.0), 0.02 * (x - 1.0), 0.02];
    for share in [0.0, 1e-2] {
        let outcome = sound.with(|case, found| {
            let mesh = Mesh::uniform(16 << case).expect("a mesh");
            let h = mesh.nodes()[1];
            let nodal: Vec<f64> = (mesh.nodes().iter())
                .map(|&x| u(x)[0] + share * h * h * x)
                .collect();
            found[0] = Projected::measure(&u, &mesh, &nodal, Target::Clamped);
        });
        let mut rates = outcome.rates.iter();
        let all_pass = rates.all(|named| named.rate.verdict == Verdict::Pass);
        assert!(all_pass, "{}", outcome.summary);
        let failing = not_passed(&outcome);
        assert_eq!(failing.is_empty(), share == 0.0, "{failing:?}");
        assert!((failing.iter()).all(|claim| claim.starts_with("u: ")));
    }
}

#[test]
fn each_number_can_fail() {
    let sound = Sound::checked(study().kind);
    let defects: Named<fn(&mut Projected), 5> = [
        ("largest residual", |theta| theta.residual = f64::NAN),
        ("of the bound (3.4)", |theta| theta.function_slope /= 10.0),
        ("of the bound (3.5)", |theta| {
            theta.function_curvature /= 2.0;
        }),
        ("slope, measured", |theta| theta.leading_slope *= 1.01),
        ("of the bound (3.4)", |theta| theta.value = f64::NAN),
    ];
    for (claim, defect) in defects {
        let outcome = sound.with(|_, found| defect(&mut found[4]));
        assert_ne!(outcome.verdict, Verdict::Pass, "{claim}");
        let failing = not_passed(&outcome).join("\n");
        assert!(failing.contains(&format!("theta: {claim}")), "{failing}");
    }
}
