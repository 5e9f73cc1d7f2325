//! Curves of many points as lines of few: an envelope that loses no spike.

use super::canvas::Point;

/// Lines through positions, broken where a position is missing.
///
/// A series longer than four positions per column is reduced to first, lowest, highest and last of
/// each column of pixels, in their order; no eye can see the difference. Positions must then run
/// along x.
pub(super) fn lines(positions: &[Option<Point>], columns: usize) -> Vec<Vec<Point>> {
    if positions.len() <= 4 * columns {
        let runs = positions
            .split(Option::is_none)
            .filter(|run| !run.is_empty());
        return runs
            .map(|run| run.iter().flatten().copied().collect())
            .collect();
    }
    envelope(positions, columns)
}

fn envelope(positions: &[Option<Point>], columns: usize) -> Vec<Vec<Point>> {
    let xs = positions.iter().flatten().map(|p| p.0);
    let left = xs.clone().fold(f64::INFINITY, f64::min);
    let width = xs.fold(f64::NEG_INFINITY, f64::max) - left;
    let column = |x: f64| ((x - left) / width * columns as f64).min(columns as f64 - 1.0) as usize;
    let mut lines = vec![Vec::new()];
    let mut group: Vec<Point> = Vec::new();
    let mut missing = 0_usize;
    for position in positions {
        let Some(p) = *position else {
            missing += 1;
            continue;
        };
        if group
            .last()
            .is_some_and(|last| column(last.0) != column(p.0))
        {
            extend_with_extremes(&mut lines, &group);
            group.clear();
            // A gap is drawn only if it is as wide as a column: narrower ones would cost more bytes
            // than they show.
            if missing > positions.len() / columns {
                lines.push(Vec::new());
            }
        }
        missing = 0;
        group.push(p);
    }
    extend_with_extremes(&mut lines, &group);
    lines.retain(|line| !line.is_empty());
    lines
}

fn extend_with_extremes(lines: &mut [Vec<Point>], group: &[Point]) {
    let Some(line) = lines.last_mut() else { return };
    let lowest = (0..group.len()).min_by(|a, b| group[*a].1.total_cmp(&group[*b].1));
    let highest = (0..group.len()).max_by(|a, b| group[*a].1.total_cmp(&group[*b].1));
    let mut indices = [Some(0), lowest, highest, group.len().checked_sub(1)];
    indices.sort_unstable();
    let mut previous = None;
    for k in indices.into_iter().flatten().filter(|&k| k < group.len()) {
        if previous != Some(k) {
            line.push(group[k]);
        }
        previous = Some(k);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_single_spike_survives() {
        let mut positions: Vec<_> = (0..100_000)
            .map(|k| Some((f64::from(k) * 7e-3, 100.0)))
            .collect();
        positions[54_321] = Some((54_321.0 * 7e-3, 3.0));
        let lines = lines(&positions, 700);
        assert_eq!(lines.len(), 1);
        assert!(lines[0].len() <= 2800);
        assert!(lines[0].iter().any(|p| p.1 == 3.0));
    }

    #[test]
    fn a_missing_position_breaks_a_short_line() {
        let p = |x: f64| Some((x, 0.0));
        assert_eq!(
            lines(&[p(0.0), p(1.0), None, None, p(2.0)], 100),
            [vec![(0.0, 0.0), (1.0, 0.0)], vec![(2.0, 0.0)]]
        );
    }

    #[test]
    fn a_wide_gap_breaks_a_long_line() {
        let positions: Vec<_> = (0..10_000)
            .map(|k| (!(4000..6000).contains(&k)).then_some((f64::from(k), 0.0)))
            .collect();
        assert_eq!(lines(&positions, 100).len(), 2);
        assert!(lines(&[None; 1000], 10).is_empty());
    }
}
