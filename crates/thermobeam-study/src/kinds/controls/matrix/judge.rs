//! Every fault must make some study fail, and no study may fail without one.

use convergence_study::judge::verdict::Verdict;
use convergence_study::study::levels::completion;
use convergence_study::study::{Check, Outcome, Ran, Table};

use super::super::fault::{BROKEN, verdicts};
use super::super::without_a_fault;
use super::{Controls, Fault, LevelOf, Planted};

type Levels = [Ran<LevelOf, Vec<Planted>>];

pub(super) fn judge(study: &Controls, ran: &Levels) -> Outcome {
    let mut checks = vec![completion(ran, |found| not_finite(found))];
    let (mut rows, mut detected, mut faults) = (vec![], 0, 0);
    for fault in Fault::all() {
        let verdicts: Vec<_> = (0..study.studies.len()).map(|k| verdict(study, k, fault, ran)).collect();
        if fault == Fault::None {
            let ids = study.studies.iter().map(|spec| spec.header.id.as_str());
            checks.push(without_a_fault(ids.zip(verdicts.iter().map(|verdict| *verdict == Some(Verdict::Pass)))));
        } else {
            let failed = verdicts.iter().filter(|verdict| **verdict == Some(Verdict::Fail)).count();
            faults += 1;
            detected += usize::from(failed > 0);
            let evidence = format!("{failed} of {} studies notice it", verdicts.len());
            checks.push(Check::that(failed > 0, format!("{} is detected", fault.name()), evidence));
        }
        let cell = |verdict: Option<Verdict>| verdict.map_or("n/a", Verdict::name).to_owned();
        rows.push([vec![fault.name().to_owned()], verdicts.into_iter().map(cell).collect()].concat());
    }
    let headline = format!("{detected} of {faults} planted faults detected");
    let summary = format!("{headline}, coefficients being off by {:e}", study.relative);
    let head = ["fault"].into_iter().chain(study.studies.iter().map(|spec| spec.header.id.as_str()));
    let table = Table {
        title: "Verdict of each study under each fault: `fail` detects it; n/a: term absent".to_owned(),
        head: head.map(str::to_owned).collect(),
        rows,
    };
    Outcome { headline, tables: vec![table], ..Outcome::new(summary, vec![], checks) }
}

/// An honest run has finite errors; of a wrong one a number that is not finite is a detection.
fn not_finite(found: &[Planted]) -> Vec<String> {
    let honest = found.iter().find(|planted| planted.fault == Fault::None);
    let finite = honest.is_some_and(|planted| planted.errors.iter().all(|(_, error)| error.is_finite()));
    if finite { vec![] } else { vec!["an error without a fault".to_owned()] }
}

/// The verdict of one study under one fault, the worst over its norms; `None` where the fault cannot be planted.
fn verdict(study: &Controls, number: usize, fault: Fault, ran: &Levels) -> Option<Verdict> {
    let spec = &study.studies[number];
    fault.plant(spec, study.relative)?;
    let level = |ran: &Ran<LevelOf, Vec<Planted>>| {
        let LevelOf { elements, steps, .. } = ran.case.data;
        let planted = ran.ok().and_then(|found| found.iter().find(|planted| planted.fault == fault));
        ((elements, steps), planted.map_or(BROKEN, |planted| planted.errors))
    };
    let levels: Vec<_> = ran.iter().filter(|ran| ran.case.data.study == number).map(level).collect();
    Some(Verdict::worst(verdicts(spec, &levels)))
}
