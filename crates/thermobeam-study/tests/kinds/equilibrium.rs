use super::planted::{defects, each_fails, none_passes, place};
use super::typed::{leaves_one_out, passes_but_not_without_each_case};
use convergence_study::Kind as _;
use thermobeam_exact::equilibrium::Phase;
use thermobeam_study::studies::equilibria::{AtRest, Nearest, study};

fn near(end: &mut AtRest) -> &mut Nearest {
    end.nearest.as_mut().expect("a steady state")
}

#[test]
fn the_file_passes_but_not_without_each_case() {
    let study = study().kind;
    let sound = passes_but_not_without_each_case(&study);
    // Of an end that is straight no order is known.
    let bent = place(&sound, "paper-2-beta-5, n = 160");
    let items = [
        "ends for the order",
        "straight, so that the mesh causes no error",
    ];
    leaves_one_out(&study, &sound, bent, items, |end| {
        let state = &mut near(end).state;
        (state.u_tip, state.phi_tip) = (0.0, 0.0);
    });
}

#[test]
fn every_claim_about_end_states_can_fail() {
    let study = study().kind;
    let sound = study.run_here();
    none_passes(
        &study,
        &sound,
        "paper-2-beta-5, n = 160",
        defects!(|end| [
            near(end).errors[0] = 2e-6,
            near(end).errors[1] = 2e-6,
            end.tip[0] = 0.0141797,
            near(end).state.contact = match near(end).state.contact {
                Phase::Upper => Phase::Lower,
                _ => Phase::Upper,
            },
        ]),
    );
    none_passes(
        &study,
        &sound,
        "paper-2-beta-5, n = 40",
        defects!(|end| [near(end).errors[0] = 1e-5]),
    );
    none_passes(
        &study,
        &sound,
        "paper-1-beta-0, n = 160",
        defects!(|end| [near(end).errors[0] = 2e-6]),
    );
    none_passes(
        &study,
        &sound,
        "paper-2-beta-5, 1 x p = 24, q = 1",
        defects!(|end| [near(end).errors[0] = 2e-13, near(end).errors[1] = 2e-13,]),
    );
}

#[test]
fn no_number_may_be_nan() {
    let study = study().kind;
    let sound = study.run_here();
    for case in 0..sound.len() {
        each_fails(
            &study,
            &sound,
            case,
            defects!(|end| [
                end.t = f64::NAN,
                end.tip[0] = f64::NAN,
                end.tip[1] = f64::NAN,
                near(end).state.u_tip = f64::NAN,
                near(end).state.phi_tip = f64::NAN,
                near(end).errors[0] = f64::NAN,
                near(end).errors[1] = f64::NAN,
            ]),
        );
    }
}
