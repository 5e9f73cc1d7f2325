use thermobeam_study::studies::equilibria::{AtRest, Nearest, study};

use super::*;

fn near(end: &mut AtRest) -> &mut Nearest {
    end.nearest.as_mut().expect("a steady state")
}

#[test]
fn every_claim_about_end_states_can_fail_and_no_number_may_be_nan() {
    let sound = Sound::checked(study().kind);
    // Of an end that is straight no order is known.
    let bent = "paper-2-beta-5, n = 160";
    let reason = "straight, so that the mesh causes no error";
    sound.leaves_one_out(bent, ["ends for the order", reason], |end| {
        let state = &mut near(end).state;
        (state.u_tip, state.phi_tip) = (0.0, 0.0);
    });
    sound.never_passes(
        bent,
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
    sound.never_passes(
        "paper-2-beta-5, n = 40",
        defects!(|end| [near(end).errors[0] = 1e-5]),
    );
    sound.never_passes(
        "paper-1-beta-0, n = 160",
        defects!(|end| [near(end).errors[0] = 2e-6]),
    );
    sound.never_passes(
        "paper-2-beta-5, 1 x p = 24, q = 1",
        defects!(|end| [near(end).errors[0] = 2e-13, near(end).errors[1] = 2e-13]),
    );
    for case in 0..sound.runs.len() {
        sound.fails(
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
