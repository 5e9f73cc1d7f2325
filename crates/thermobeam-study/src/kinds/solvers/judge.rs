//! The maps: claims, the table of boundaries, guarded numbers, and the figures.

use convergence_study::plots::{Axis, Series, Surface};

use super::FixedPointStep;
use super::map::{Boundary, Map, NewtonSteps, Parameter, Point, spaced};
use crate::kinds::prelude::*;
use crate::kinds::runs::watch::of_allowed;

/// A factor for which the map's iterations suffice, with a margin for the mean force, which is not
/// known in advance.
const SLOW: f64 = 0.8;
/// γ up to which α alone decides.
const ALONE: f64 = 0.01;
/// Maximum number of Newton iterations in a step.
const MOST: usize = 30;
/// Smaller contractions are shown as this value: after a few iterations the ratio is no longer
/// meaningful.
const FASTEST: f64 = 1e-6;
/// Smaller residuals are shown as this value, a hundredth of a rounding error.
const EXACT: f64 = 1e-18;

/// Results, each with its value of the second parameter.
type MapRows<'r> = [(f64, &'r [Point])];
type Lines<'r> = [(f64, &'r Boundary)];

impl Map {
    pub(super) fn judge(&self, rows: &MapRows<'_>, lines: &Lines<'_>) -> Outcome {
        let mut checks = vec![self.complete(rows), in_contact(rows), as_predicted(rows)];
        checks.extend([self.newton_completes(rows), newton_is_quick(rows)]);
        checks.extend(energy(rows));
        checks.extend(
            lines
                .iter()
                .map(|(value, line)| self.check_boundary(*value, line)),
        );
        let converged = points(rows).filter(|point| point.step.converged).count();
        let completes = points(rows).filter(|point| point.newton_completes).count();
        let worst = largest_of(lines.iter().filter_map(|(_, line)| line.distance_alone()));
        let boundary = worst.map_or("no boundary".to_owned(), |worst| {
            format!("boundary within {:.2} % of alpha = 1", 100.0 * worst)
        });
        let residual = largest_of(newton(rows).map(|newton| newton.worst.residual));
        let residual = residual.map_or("no residual".to_owned(), |residual| {
            format!("residual at most {residual:.1e} of the energy")
        });
        let all = self.points * self.points;
        let points = format!(
            "{all} points: the fixed point converges at {converged}, Newton's method at {completes}"
        );
        let summary = format!("{points}; {boundary} where gamma <= {ALONE}; {residual}");
        Outcome {
            headline: format!("{boundary}, {residual}"),
            coverage: self.coverage(rows, lines),
            tables: vec![self.boundaries(lines)],
            figures: self.figures(rows, lines),
            quantities: self.quantities(lines, converged as f64),
            ..Outcome::new(summary, vec![], checks)
        }
    }

    /// The points and boundaries that each statement judges.
    fn coverage(&self, rows: &MapRows<'_>, lines: &Lines<'_>) -> Vec<Coverage> {
        let points: Vec<&Point> = points(rows).collect();
        let missing = (self.points * self.points).saturating_sub(points.len());
        let of_points = |items: &str, reason: fn(&Point) -> Option<&'static str>| {
            let reasons = points.iter().map(|point| reason(point));
            Coverage::of(
                items,
                reasons.chain(std::iter::repeat_n(Some(NO_RESULT), missing)),
            )
        };
        let not_run = self.lines.len().saturating_sub(lines.len());
        let reasons = lines.iter().map(|(_, line)| line.not_alone());
        vec![
            of_points("points for convergence", |point| {
                let between = prediction(&point.step).is_none();
                between.then_some("factors near 1, which predict nothing")
            }),
            of_points("points for the balance", |point| {
                let failed = point.newton.is_none();
                failed.then_some("no step by Newton's method")
            }),
            Coverage::of(
                "boundaries for alpha = 1 alone",
                reasons.chain(std::iter::repeat_n(Some(NO_RESULT), not_run)),
            ),
        ]
    }

    fn complete(&self, rows: &MapRows<'_>) -> Check {
        let (found, expected) = (points(rows).count(), self.points * self.points);
        Check::that(
            found == expected,
            "both solvers were run at every point",
            format!("{found} of {expected}"),
        )
        .about(Subject::of("points"))
    }

    /// Newton's method must converge wherever its operator is known to be definite.
    fn newton_completes(&self, rows: &MapRows<'_>) -> Check {
        let (mut known, mut wrong, mut failed) = (0, 0, 0);
        for (value, row) in rows {
            let beam = self.beam(*value);
            for point in *row {
                failed += usize::from(!point.newton_completes);
                if BUCKLING * (beam.zeta + 0.5 * point.step.dt) + 0.5 * beam.beta * point.step.dt
                    > 0.0
                {
                    known += 1;
                    wrong += usize::from(!point.newton_completes);
                }
            }
        }
        Check::that(
            wrong == 0 && known > 0,
            "Newton's method converges wherever B (zeta + dt/2) + beta dt/2 > 0",
            format!(
                "fails at {wrong} of {known} such points, and at {} others",
                failed - wrong
            ),
        )
        .about(Subject::of("convergence of Newton's method"))
    }

    /// The contact's factor at the boundary found is 1, up to a share of γ.
    fn check_boundary(&self, value: f64, line: &Boundary) -> Check {
        let subject = Subject::of("boundary")
            .in_case(format!("{} = {}", self.over.name(), plain_text(value)))
            .by(ItemMethod::FixedPoint);
        let claim = "the fixed point fails from alpha = 1 on";
        let (
            FixedPointStep {
                dt, alpha, gamma, ..
            },
            predicted,
        ) = match *line {
            Boundary {
                found: Some(found),
                predicted: Some(predicted),
            } => (found, predicted),
            Boundary {
                found: None,
                predicted: None,
            } => {
                let claim = "no boundary on the map, as predicted";
                return Check::that(true, claim, "the fixed point behaves alike at both ends")
                    .about(subject);
            }
            Boundary { found, .. } => {
                let [here, not] = if found.is_some() {
                    ["found", "predicted"]
                } else {
                    ["predicted", "found"]
                };
                return Check::that(
                    false,
                    claim,
                    format!("a boundary is {here} on the map, but none is {not}"),
                )
                .about(subject);
            }
        };
        let difference = 100.0 * (dt / predicted - 1.0);
        let [from, expected] = [dt, predicted].map(plain_text);
        let boundary = format!("from dt = {from} on, predicted {expected} ({difference:+.2} %)");
        let evidence = format!("{boundary}; alpha {alpha:.4} there, gamma {gamma:.1e}");
        Check::that(
            (alpha - 1.0).abs() <= self.agreement + gamma,
            claim,
            evidence,
        )
        .about(subject)
    }

    fn boundaries(&self, lines: &Lines<'_>) -> Table {
        let row = |(value, line): &(f64, &Boundary)| {
            let Boundary { predicted, found } = **line;
            let difference = found
                .zip(predicted)
                .map(|(at, predicted)| 100.0 * (at.dt / predicted - 1.0));
            let readings = vec![
                Reading::new("dt where alpha = 1", predicted).scientific(4),
                Reading::new("dt found", found.map(|at| at.dt)).scientific(4),
                Reading::new("difference", difference).shown(|percent| format!("{percent:+.3} %")),
                Reading::new("alpha there", found.map(|at| at.alpha)).fixed(4),
                Reading::new("gamma there", found.map(|at| at.gamma)).scientific(1),
            ];
            (vec![plain_text(*value)], readings)
        };
        let title = "Boundary of the fixed point's convergence, by bisection in dt";
        readings::table(
            title,
            &[self.over.name()],
            &lines.iter().map(row).collect::<Vec<_>>(),
        )
    }

    fn quantities(&self, lines: &Lines<'_>, converged: f64) -> Vec<Quantity> {
        let found = |(value, line): &(f64, &Boundary)| {
            let name = format!("boundary at {} = {value:e}", self.over.name());
            let subject = Subject::of("boundary")
                .by(ItemMethod::FixedPoint)
                .at(format!("{} = {value:e}", self.over.name()));
            line.found
                .map(|at| Quantity::new(name, at.dt, 1e-2).about(subject))
        };
        let mut quantities: Vec<Quantity> = lines.iter().filter_map(found).collect();
        // A point next to the boundary may fall on either side.
        let points = "points with a fixed point";
        let subject = Subject::of(points).by(ItemMethod::FixedPoint);
        quantities.push(Quantity::new(points, converged, 1e-2).about(subject));
        quantities
    }
}

fn points<'r>(rows: &MapRows<'r>) -> impl Iterator<Item = &'r Point> {
    rows.iter().flat_map(|(_, row)| *row)
}

fn newton<'r>(rows: &MapRows<'r>) -> impl Iterator<Item = &'r NewtonSteps> {
    points(rows).filter_map(|point| point.newton.as_ref())
}

fn largest(rows: &MapRows<'_>, number: impl Fn(&NewtonSteps) -> f64) -> f64 {
    newton(rows).map(number).fold(f64::NEG_INFINITY, max_or_nan)
}

fn in_contact(rows: &MapRows<'_>) -> Check {
    let least = -largest(rows, |newton| -newton.contact_force);
    let holds = least > 0.0 && newton(rows).next().is_some();
    Check::that(
        holds,
        "the first step ends in contact",
        format!("least contact force {least:.2e}"),
    )
    .about(Subject::of("contact"))
}

/// Whether α and γ predict convergence or failure; `None` where they are near 1 and predict
/// nothing.
fn prediction(&FixedPointStep { alpha, gamma, .. }: &FixedPointStep) -> Option<bool> {
    if alpha < SLOW && gamma < SLOW {
        return Some(true);
    }
    // An infinite α means that the operator A_u of the step is not definite.
    (alpha == f64::INFINITY || alpha > 1.0 + gamma + (1.0 - SLOW)).then_some(false)
}

impl Boundary {
    /// Why α alone does not decide where the boundary is; `None` if it does.
    fn not_alone(&self) -> Option<&'static str> {
        match self.found {
            None => Some("no boundary on the map"),
            Some(crossing) => (!(crossing.gamma <= ALONE)).then_some("gamma takes part"),
        }
    }

    /// Relative distance of the boundary to α = 1, where α alone decides.
    fn distance_alone(&self) -> Option<f64> {
        let crossing = self.found.filter(|_| self.not_alone().is_none())?;
        Some((crossing.dt / self.predicted.unwrap_or(f64::NAN) - 1.0).abs())
    }
}

/// The map against α and γ: convergence where both are well below 1, no convergence where α exceeds
/// 1 by more than γ.
fn as_predicted(rows: &MapRows<'_>) -> Check {
    let (mut fast, mut beyond, mut wrong) = (0, 0, 0);
    for step in points(rows).map(|point| &point.step) {
        if let Some(converges) = prediction(step) {
            *(if converges { &mut fast } else { &mut beyond }) += 1;
            wrong += usize::from(step.converged != converges);
        }
    }
    let claim = "on the map the fixed point converges where alpha and gamma are below 0.8, and not where alpha > 1.2 + gamma";
    let points = format!("{fast} points with small factors, {beyond} with a large alpha");
    Check::that(
        wrong == 0 && fast > 0 && beyond > 0,
        claim,
        format!("{points}, {wrong} of them against the prediction"),
    )
    .about(Subject::of("convergence of the fixed point").by(ItemMethod::FixedPoint))
}

fn newton_is_quick(rows: &MapRows<'_>) -> Check {
    let most = newton(rows).map(|newton| newton.iterations).max();
    let evidence = most.map_or("no step was done".to_owned(), |most| {
        format!("at most {most}")
    });
    let claim = format!("Newton's method takes at most {MOST} iterations in any step");
    Check::that(most.is_some_and(|most| most <= MOST), claim, evidence)
        .about(Subject::of("iterations of Newton's method"))
}

fn energy(rows: &MapRows<'_>) -> [Check; 2] {
    // A row without a single Newton step shows nothing.
    let every_row = rows
        .iter()
        .all(|(_, row)| row.iter().any(|point| point.newton.is_some()));
    let check = |claim: &str, number: fn(&NewtonSteps) -> f64, share: fn(&NewtonSteps) -> f64| {
        let share = largest(rows, share);
        let evidence = format!(
            "{:.1e} of the energy, {}",
            largest(rows, number),
            of_allowed(share)
        );
        Check::that(every_row && share <= 1.0, claim, evidence)
    };
    let closes = "the balance closes to 1e-12 of the energy, or to what rounding errors explain";
    [
        check(
            "the energy never rises beyond rounding errors",
            |newton| newton.worst.rise,
            |newton| newton.worst.risen,
        )
        .about(Subject::of("energy")),
        check(
            closes,
            |newton| newton.worst.residual,
            |newton| newton.worst.open,
        )
        .about(Subject::of("balance")),
    ]
}

impl Map {
    /// A map of `value`; where there is none the solver fails, and the map is hatched.
    ///
    /// * `colours`: the axis of the values, the label of the hatched part, boundaries.
    fn surface(
        &self,
        rows: &MapRows<'_>,
        colours: Surface,
        value: &dyn Fn(&Point) -> Option<f64>,
    ) -> String {
        let cells: Vec<Vec<_>> = rows
            .iter()
            .map(|(_, row)| row.iter().map(value).collect())
            .collect();
        let number = |cell: &Option<f64>| cell.unwrap_or(f64::NAN);
        plots::surface(&Surface {
            x: Axis::log("time step dt"),
            y: self.second_axis(),
            x_values: self.time_steps(),
            y_values: rows.iter().map(|(value, _)| *value).collect(),
            values: cells
                .iter()
                .map(|row| row.iter().map(number).collect())
                .collect(),
            marked: cells
                .iter()
                .map(|row| row.iter().map(Option::is_none).collect())
                .collect(),
            ..colours
        })
    }

    fn figures(&self, rows: &MapRows<'_>, lines: &Lines<'_>) -> Vec<Figure> {
        let over = self.over.name();
        let draw = |file: &str,
                    title: &str,
                    caption: String,
                    colours: Surface,
                    value: &dyn Fn(&Point) -> Option<f64>| {
            let colours = Surface {
                title: Some(title.to_owned()),
                ..colours
            };
            Figure::new(file, caption, self.surface(rows, colours, value))
        };
        let colours = |z, fails: &str, boundaries| Surface {
            z,
            marked_label: fails.to_owned(),
            boundaries,
            ..Surface::default()
        };
        let fixed_point = |z| {
            colours(
                z,
                "the fixed point fails",
                vec![predicted(rows), self.found(lines)],
            )
        };
        let newton = |z, boundaries| colours(z, "operator not definite", boundaries);
        let step = |point: &Point| point.step.converged.then_some(point.step);
        let steps = |point: &Point, of: fn(&NewtonSteps) -> f64| {
            point
                .newton_completes
                .then(|| point.newton.as_ref().map_or(f64::NAN, of))
        };
        vec![
            draw(
                "contraction",
                "The fixed point fails where α reaches 1",
                format!(
                    "Contraction factor of the fixed point over dt and {over}; it fails from alpha = 1 on."
                ),
                fixed_point(Axis::log("contraction per iteration")),
                &|point| {
                    Some(max_or_nan(
                        step(point)?.contraction.unwrap_or(f64::NAN),
                        FASTEST,
                    ))
                },
            ),
            draw(
                "iterations",
                "The iterations of the fixed point grow towards α = 1",
                format!("Iterations of the fixed point in a step over dt and {over}."),
                fixed_point(Axis::log("iterations of the fixed point")),
                &|point| Some(step(point)?.iterations.max(1) as f64),
            ),
            draw(
                "newton",
                "Newton's method needs few iterations at every step",
                format!("Most iterations of Newton's method in a step over dt and {over}."),
                newton(
                    Axis::linear("most Newton iterations in a step"),
                    self.definite(),
                ),
                &|point| steps(point, |steps| steps.iterations.max(1) as f64),
            ),
            draw(
                "balance",
                "The balance of the energy closes to round-off at every step",
                format!(
                    "Largest residual of the energy balance in a step of Newton's method over dt and {over}."
                ),
                newton(
                    Axis::log("largest residual / energy"),
                    vec![predicted(rows)],
                ),
                &|point| steps(point, |steps| max_or_nan(steps.worst.residual, EXACT)),
            ),
        ]
    }

    fn second_axis(&self) -> Axis {
        match self.over {
            Parameter::Epsilon => Axis::log("compliance ε (dimensionless)"),
            Parameter::Beta => Axis::linear("axial force at rest β (dimensionless)"),
            Parameter::Zeta => Axis::log("viscosity ζ (dimensionless)"),
            Parameter::Width => Axis::log("mesh width h (dimensionless)"),
        }
    }

    /// The boundaries found, line by line.
    fn found(&self, lines: &Lines<'_>) -> Series {
        let points = lines
            .iter()
            .filter_map(|(value, line)| Some((line.found?.dt, *value)));
        let mut found = Series::new(
            "found by bisection",
            points.filter(|(_, value)| self.over.is_linear() || *value > 0.0),
        );
        found.points.sort_by(|a, b| a.1.total_cmp(&b.1));
        found
    }

    /// For β above this line the operator is definite.
    fn definite(&self) -> Vec<Series> {
        if self.over != Parameter::Beta {
            return vec![];
        }
        let zeta = Beam::default().zeta;
        let force = |&dt: &f64| (dt, -BUCKLING * (1.0 + 2.0 * zeta / dt));
        let [low, high] = self.range;
        let dts = spaced(self.dt, 400, false);
        let points = dts
            .iter()
            .map(force)
            .filter(|(_, beta)| (low..high).contains(beta));
        vec![Series::new("definite above: β = -B (1 + 2ζ/dt)", points)]
    }
}

/// α = 1, row by row between the two time steps on either side, on logarithmic scales.
fn predicted(rows: &MapRows<'_>) -> Series {
    let crossing = |(value, row): &(f64, &[Point])| {
        let finite: Vec<_> = row
            .iter()
            .map(|point| point.step)
            .filter(|step| step.alpha.is_finite())
            .collect();
        let pair = finite
            .windows(2)
            .find(|pair| pair[0].alpha < 1.0 && pair[1].alpha >= 1.0)?;
        let [below, above] = [pair[0], pair[1]];
        let share = -below.alpha.ln() / (above.alpha / below.alpha).ln();
        Some((below.dt * (above.dt / below.dt).powf(share), *value))
    };
    Series::new("predicted: α = 1", rows.iter().filter_map(crossing))
}
