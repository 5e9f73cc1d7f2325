use super::planted::{place, verdict_with};
use super::typed::{leaves_one_out, passes_but_not_without_each_case};
use convergence_study::{Kind as _, Verdict};
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
    type Defect = fn(&mut AtRest);
    let defects: [(&str, &[Defect]); 4] = [
        (
            "paper-2-beta-5, n = 160",
            &[
                |end| near(end).errors[0] = 2e-6,
                |end| near(end).errors[1] = 2e-6,
                |end| end.tip[0] = 0.0141797,
                |end| {
                    let contact = &mut near(end).state.contact;
                    *contact = if *contact == Phase::Upper {
                        Phase::Lower
                    } else {
                        Phase::Upper
                    };
                },
            ],
        ),
        (
            "paper-2-beta-5, n = 40",
            &[|end| near(end).errors[0] = 1e-5],
        ),
        (
            "paper-1-beta-0, n = 160",
            &[|end| near(end).errors[0] = 2e-6],
        ),
        (
            "paper-2-beta-5, 1 x p = 24, q = 1",
            &[
                |end| near(end).errors[0] = 2e-13,
                |end| near(end).errors[1] = 2e-13,
            ],
        ),
    ];
    for (label, defects) in defects {
        for (k, defect) in defects.iter().enumerate() {
            let verdict = verdict_with(&study, &sound, place(&sound, label), defect);
            assert_ne!(verdict, Verdict::Pass, "defect {k}: {label}");
        }
    }
}

#[test]
fn no_number_may_be_nan() {
    let study = study().kind;
    let sound = study.run_here();
    let numbers: [fn(&mut AtRest) -> &mut f64; 7] = [
        |end| &mut end.t,
        |end| &mut end.tip[0],
        |end| &mut end.tip[1],
        |end| &mut near(end).state.u_tip,
        |end| &mut near(end).state.phi_tip,
        |end| &mut near(end).errors[0],
        |end| &mut near(end).errors[1],
    ];
    for case in 0..sound.len() {
        for (k, number) in numbers.into_iter().enumerate() {
            let found = verdict_with(&study, &sound, case, |end| *number(end) = f64::NAN);
            assert_eq!(found, Verdict::Fail, "number {k} of case {case}");
        }
    }
}
