//! Study files that are refused, with place, value found and values allowed.

use convergence_study::{Document, FromFile as _, Header};
use convergence_study_tests::refusals::each_is_refused;
use thermobeam_study::kinds::orders::Orders;
use thermobeam_study::kinds::orders::manufactured::Convergence;
use thermobeam_study::kinds::tables::Perturbation;

use super::super::says;
use super::{EXACT, EXPECT, REFINE, STUDY, refine, spec};

const SPACE: &str = "axis = \"space\"\nelements = [4, 8]\nsteps = 2\n";

#[test]
fn what_breaks_a_rule_is_named_with_its_place_and_what_is_allowed() {
    each_is_refused(include_str!("refused.txt"), |case| {
        let new = format!("{}\n", case.new);
        let text = match case.kind {
            "before [exact]" => [STUDY, &new, EXACT, REFINE, EXPECT].concat(),
            "[exact]" => [STUDY, "[exact]\n", &new, REFINE, EXPECT].concat(),
            "[refine]" => [STUDY, EXACT, &refine(&new), EXPECT].concat(),
            "[refine] in space" => [STUDY, EXACT, &refine(SPACE), &new, EXPECT].concat(),
            "before [[expect]]" => [STUDY, EXACT, REFINE, &new, EXPECT].concat(),
            "expect" => [&new, STUDY, EXACT, REFINE].concat(),
            _ => case.new.clone(),
        };
        if case.kind == "a header" {
            let header = Document::parse(&text, "s.toml", Header::from_document);
            says(&header.expect_err(&text).to_string(), case.words);
        }
        let error = Orders::<Convergence>::parse(&text, "s.toml".as_ref()).expect_err(&text);
        let message = error.to_string();
        assert!((1..=3).contains(&message.lines().count()), "{message}");
        message
    });
}

#[test]
fn a_perturbation_without_a_seed_has_that_of_zero() {
    let seeded = spec(&[STUDY, EXACT, &refine(SPACE), "perturb = 0.5\n", EXPECT]);
    let expected = Perturbation {
        amount: 0.5,
        seed: 0,
    };
    assert_eq!(seeded.refine.layout.perturbation, Some(expected));
}
