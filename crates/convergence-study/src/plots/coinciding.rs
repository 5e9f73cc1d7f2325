//! Curves that lie on each other: only the last one drawn can be seen, so a note names them all.

use super::canvas::Point;
use super::curve::Curve;
use super::ruler::Ruler;
use super::style;

/// Curves closer than this everywhere look like one, in px.
const CLOSE: f64 = 3.0;

/// A note for each set of coinciding data curves: compared by points if they have equally many,
/// else as lines.
pub(super) fn notes(curves: &[Curve], x: &Ruler, y: &Ruler) -> Vec<String> {
    let is_shown = |curve: &&Curve| curve.is_data && curve.points.len() > 1;
    let data: Vec<&Curve> = curves.iter().filter(is_shown).collect();
    let mut sets: Vec<Vec<&Curve>> = vec![];
    for curve in data {
        let set = sets.iter_mut().find(|set| coincide(set[0], curve, x, y));
        match set {
            Some(set) if set.iter().all(|known| known.noted() != curve.noted()) => set.push(curve),
            Some(_) => {}
            None => sets.push(vec![curve]),
        }
    }
    let mut notes: Vec<String> = vec![];
    for set in sets.iter().filter(|set| set.len() > 1) {
        let names: Vec<&str> = set.iter().map(|curve| curve.noted()).collect();
        let note = format!("{} coincide", names.join(" and "));
        if !notes.contains(&note) {
            notes.push(note);
        }
    }
    notes
}

fn coincide(a: &Curve, b: &Curve, x: &Ruler, y: &Ruler) -> bool {
    // The plot is somewhat narrower than the page.
    let (x, y) = (
        x.laid_out(0.0, style::WIDTH),
        y.laid_out(0.0, style::PLOT_HEIGHT),
    );
    let near = |ruler: &Ruler, a: f64, b: f64| match (ruler.px(a), ruler.px(b)) {
        (Some(a), Some(b)) => (a - b).abs() < CLOSE,
        (None, None) => true,
        _ => false,
    };
    let mut pairs = a.points.iter().zip(&b.points);
    if a.points.len() == b.points.len() {
        return pairs.all(|(p, q)| near(&x, p.0, q.0) && near(&y, p.1, q.1));
    }
    let line = |curve: &Curve| {
        let points = curve
            .points
            .iter()
            .map(|point| Some((x.px(point.0)?, y.px(point.1)?)));
        let points: Vec<Point> = points
            .collect::<Option<_>>()
            .filter(|_| curve.width > 0.0 && curve.fit.is_none())?;
        points.is_sorted_by(|p, q| p.0 <= q.0).then_some(points)
    };
    let (Some(a), Some(b)) = (line(a), line(b)) else {
        return false;
    };
    let ends = [(a.first(), b.first()), (a.last(), b.last())];
    let begin_and_end = ends
        .iter()
        .all(|ends| matches!(ends, (Some(p), Some(q)) if (p.0 - q.0).abs() < CLOSE));
    begin_and_end && follows(&a, &b) && follows(&b, &a)
}

/// Whether every point lies on the line, which is straight from point to point and level beyond its
/// ends; x ascending.
fn follows(points: &[Point], line: &[Point]) -> bool {
    let height = |x: f64| {
        let next = line.partition_point(|p| p.0 < x).min(line.len() - 1);
        let (p, q) = (line[next.saturating_sub(1)], line[next]);
        let share = if q.0 > p.0 {
            ((x - p.0) / (q.0 - p.0)).clamp(0.0, 1.0)
        } else {
            1.0
        };
        p.1 + share * (q.1 - p.1)
    };
    points
        .iter()
        .all(|point| (point.1 - height(point.0)).abs() < CLOSE)
}
