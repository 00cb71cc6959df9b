//! Rainflow counting of load histories [ASTME1049, section 5.4].

use super::spectrum::LoadCycle;

/// Cycles of a history that is run through once, half cycles included [ASTME1049, section 5.4.4].
///
/// - `history`: loads in the order of time; only peaks, valleys, the first and the last value matter
/// - returns one entry per counted range, with `count` 1 or 0.5, in the order of counting
pub fn count(history: &[f64]) -> Vec<LoadCycle> {
    let mut cycles = vec![];
    let mut open: Vec<f64> = vec![];
    for point in turning_points(history.iter().copied()) {
        open.push(point);
        while let [.., a, b, c] = open[..]
            && (c - b).abs() >= (b - a).abs()
        {
            if open.len() == 3 {
                // The range contains the starting point.
                cycles.push(cycle(a, b, 0.5));
                open.remove(0);
            } else {
                cycles.push(cycle(a, b, 1.0));
                open.truncate(open.len() - 3);
                open.push(c);
            }
        }
    }
    cycles.extend(open.windows(2).map(|pair| cycle(pair[0], pair[1], 0.5)));
    cycles
}

/// Cycles in one repetition of a history that repeats, all of them closed [ASTME1049, section 5.4.5].
///
/// - `history`: loads in the order of time, of one repetition; only peaks and valleys matter
/// - returns one entry per cycle, with `count` 1, in the order of counting from the highest peak on; none if the load
///   does not vary
pub fn count_repeating(history: &[f64]) -> Vec<LoadCycle> {
    let Some(start) = (0..history.len()).max_by(|&i, &j| history[i].total_cmp(&history[j])) else { return vec![] };
    // From the highest peak back to it.
    let round = history[start..].iter().chain(&history[..=start]).copied();
    let mut cycles = vec![];
    let mut open: Vec<f64> = vec![];
    for point in turning_points(round) {
        open.push(point);
        while let [.., a, b, c] = open[..]
            && (c - b).abs() >= (b - a).abs()
        {
            cycles.push(cycle(a, b, 1.0));
            open.truncate(open.len() - 3);
            open.push(c);
        }
    }
    cycles
}

fn cycle(a: f64, b: f64, count: f64) -> LoadCycle {
    LoadCycle { minimum: a.min(b), maximum: a.max(b), count }
}

/// First and last value and the reversals between them; equal neighbors count as one.
fn turning_points(history: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut points: Vec<f64> = vec![];
    for value in history {
        match points[..] {
            [.., last] if value == last => continue,
            [.., before, last] if (last > before) == (value > last) => {
                points.pop();
            }
            _ => {}
        }
        points.push(value);
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    /// Counts by range; all histories here hold whole numbers.
    fn by_range(cycles: &[LoadCycle]) -> Vec<(i64, f64)> {
        let mut counts = BTreeMap::new();
        for cycle in cycles {
            *counts.entry((cycle.maximum - cycle.minimum) as i64).or_insert(0.0) += cycle.count;
        }
        counts.into_iter().collect()
    }

    /// [ASTME1049, Fig. 6]: the history ABCDEFGHI.
    const STANDARD: [f64; 9] = [-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0];

    /// [ASTME1049, Fig. 6]: the table beside the drawing, and the events in the order of the text of section 5.4.4.
    #[test]
    fn the_example_of_the_standard_is_met() {
        let cycles = count(&STANDARD);
        assert_eq!(by_range(&cycles), [(3, 0.5), (4, 1.5), (6, 0.5), (8, 1.0), (9, 0.5)]);
        let events: Vec<_> = cycles.iter().map(|c| (c.minimum, c.maximum, c.count)).collect();
        let expected = [
            (-2.0, 1.0, 0.5),
            (-3.0, 1.0, 0.5),
            (-1.0, 3.0, 1.0),
            (-3.0, 5.0, 0.5),
            (-4.0, 5.0, 0.5),
            (-4.0, 4.0, 0.5),
            (-2.0, 4.0, 0.5),
        ];
        assert_eq!(events, expected);
    }

    /// [ASTME1049, Fig. 7]: the same history repeating, started at D; ranges E-F, A-B, H-C and D-G.
    #[test]
    fn the_repeating_example_of_the_standard_is_met() {
        let cycles = count_repeating(&STANDARD);
        assert_eq!(by_range(&cycles), [(3, 1.0), (4, 1.0), (7, 1.0), (9, 1.0)]);
        let events: Vec<_> = cycles.iter().map(|c| (c.minimum, c.maximum)).collect();
        assert_eq!(events, [(-1.0, 3.0), (-2.0, 1.0), (-3.0, 4.0), (-4.0, 5.0)]);
    }

    #[test]
    fn the_start_of_a_repeating_history_does_not_matter() {
        let mut expected = count_repeating(&STANDARD);
        let order = |c: &LoadCycle| (c.minimum as i64, c.maximum as i64);
        expected.sort_by_key(order);
        for shift in 1..9 {
            let mut history = STANDARD;
            history.rotate_left(shift);
            let mut cycles = count_repeating(&history);
            cycles.sort_by_key(order);
            assert_eq!(cycles, expected, "{shift}");
        }
    }

    #[test]
    fn points_between_peaks_and_valleys_do_not_matter() {
        let record = [-2.0, 0.0, 1.0, 1.0, 0.0, -3.0, -3.0, 2.0, 5.0, -1.0, 3.0, 1.0, -4.0, -4.0, 4.0, 0.0, -2.0, -2.0];
        assert_eq!(count(&record), count(&STANDARD));
        assert_eq!(count_repeating(&record), count_repeating(&STANDARD));
    }

    #[test]
    fn histories_without_cycles_are_no_problem() {
        for history in [&[][..], &[1.0], &[1.0, 1.0, 1.0]] {
            assert_eq!(count(history), [], "{history:?}");
            assert_eq!(count_repeating(history), [], "{history:?}");
        }
        assert_eq!(count(&[0.0, 2.0]), [cycle(0.0, 2.0, 0.5)]);
        assert_eq!(count_repeating(&[0.0, 2.0]), [cycle(0.0, 2.0, 1.0)]);
    }

    /// What a repeating history counts, by another rule: a range closes as soon as the ranges before and after it are
    /// both at least as large; on the ring of turning points the order of closing does not matter.
    fn count_on_ring(history: &[f64]) -> Vec<(i64, f64)> {
        let mut ring: Vec<f64> = vec![];
        for i in 0..history.len() {
            let (before, here) = (history[(i + history.len() - 1) % history.len()], history[i]);
            let after = history[(i + 1) % history.len()];
            if (here - before) * (after - here) < 0.0 {
                ring.push(here);
            }
        }
        let mut cycles = vec![];
        while ring.len() > 2 {
            let n = ring.len();
            let range = |i: usize| (ring[(i + 1) % n] - ring[i % n]).abs();
            let inner = (0..n).find(|&i| range(i) <= range(i + 1) && range(i) <= range(i + n - 1)).expect("smallest");
            cycles.push(cycle(ring[inner], ring[(inner + 1) % n], 1.0));
            let gone = [inner, (inner + 1) % n];
            ring = (0..n).filter(|i| !gone.contains(i)).map(|i| ring[i]).collect();
        }
        cycles.push(cycle(ring[0], ring[1], 1.0));
        by_range(&cycles)
    }

    #[test]
    fn random_histories_are_counted_as_by_another_rule() {
        let mut state = 12345_u64;
        let mut random = move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            ((state >> 33) % 41) as f64 - 20.0
        };
        for length in 2..200 {
            let mut history: Vec<f64> = (0..length).map(|_| random()).collect();
            history.dedup();
            if history.len() > 1 && history[0] == history[history.len() - 1] {
                history.pop();
            }
            if history.len() < 2 {
                continue;
            }
            assert_eq!(by_range(&count_repeating(&history)), count_on_ring(&history), "{history:?}");
            // Each range between neighboring turning points is half a cycle.
            let half_cycles: f64 = count(&history).iter().map(|c| 2.0 * c.count).sum();
            assert_eq!(half_cycles, turning_points(history.iter().copied()).len() as f64 - 1.0);
        }
    }
}
