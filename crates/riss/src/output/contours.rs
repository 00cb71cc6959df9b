//! Outlines of the regions of a triangulation where a field is at least a level.
//!
//! Only these outlines are drawn, each over the one before: pictures grow with their contour lines, not with the
//! number of triangles, and have no seams.

use super::svg::Pixel;
use std::collections::{BTreeMap, HashMap};

/// Triangles with a value at every corner, seen in a picture.
pub(super) struct Surface<'a> {
    pixels: &'a [Pixel],
    values: &'a [f64],
    triangles: Vec<[u32; 3]>,
    /// Edges of one triangle only, with the body to the left.
    boundary: Vec<[u32; 2]>,
}

impl<'a> Surface<'a> {
    /// The triangles with finite values.
    pub fn new(pixels: &'a [Pixel], values: &'a [f64], triangles: &[[u32; 3]]) -> Self {
        let is_finite = |t: &&[u32; 3]| t.iter().all(|&v| values[v as usize].is_finite());
        let triangles: Vec<[u32; 3]> = triangles.iter().filter(is_finite).copied().collect();
        let mut uses: HashMap<[u32; 2], u32> = HashMap::new();
        let edges = || triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        for [a, b] in edges() {
            *uses.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
        let boundary = edges().filter(|&[a, b]| uses[&[a.min(b), a.max(b)]] == 1).collect();
        Self { pixels, values, triangles, boundary }
    }

    /// Closed outlines around all triangles.
    pub fn outline(&self) -> Vec<Vec<Pixel>> {
        loops(self.boundary.iter().map(|e| e.map(|v| self.pixels[v as usize])), 0)
    }

    /// Closed outlines of the region with values of at least `level`, without those smaller than `speck` units;
    /// filled by nonzero winding.
    pub fn region(&self, level: f64, speck: i32) -> Vec<Vec<Pixel>> {
        let is_in = |v: u32| self.values[v as usize] >= level;
        let pixel = |v: u32| self.pixels[v as usize];
        let inside = self.triangles.iter().filter_map(|t| {
            // Around the corners, the outline goes from where the region is left to where it is entered again.
            let [a, b, c] = t.map(is_in);
            let left = if a && !b {
                (t[0], t[1])
            } else if b && !c {
                (t[1], t[2])
            } else {
                (t[2], t[0])
            };
            let entered = if !a && b {
                (t[0], t[1])
            } else if !b && c {
                (t[1], t[2])
            } else {
                (t[2], t[0])
            };
            (a != b || b != c).then(|| [self.crossing(left, level), self.crossing(entered, level)])
        });
        let along = self.boundary.iter().filter_map(|&[a, b]| match (is_in(a), is_in(b)) {
            (true, true) => Some([pixel(a), pixel(b)]),
            (true, false) => Some([pixel(a), self.crossing((a, b), level)]),
            (false, true) => Some([self.crossing((a, b), level), pixel(b)]),
            (false, false) => None,
        });
        loops(inside.chain(along), speck)
    }

    /// Where an edge has the level; the same from both of its triangles.
    fn crossing(&self, (a, b): (u32, u32), level: f64) -> Pixel {
        let (a, b) = (a.min(b) as usize, a.max(b) as usize);
        let t = (level - self.values[a]) / (self.values[b] - self.values[a]);
        let (p, q) = (self.pixels[a], self.pixels[b]);
        let mix = |x: i32, y: i32| (f64::from(x) + t * (f64::from(y) - f64::from(x))).round() as i32;
        (mix(p.0, q.0), mix(p.1, q.1))
    }
}

/// Joins segments that together are closed; where several go on, any choice fills the same region.
fn loops(segments: impl Iterator<Item = [Pixel; 2]>, speck: i32) -> Vec<Vec<Pixel>> {
    let mut next: BTreeMap<Pixel, Vec<Pixel>> = BTreeMap::new();
    for [from, to] in segments.filter(|[from, to]| from != to) {
        next.entry(from).or_default().push(to);
    }
    let mut loops = vec![];
    while let Some((&start, _)) = next.first_key_value() {
        let mut line = vec![];
        let mut at = start;
        while let Some(ends) = next.get_mut(&at) {
            push_straight(&mut line, at);
            let to = ends.pop().expect("lists with no end are removed");
            if ends.is_empty() {
                next.remove(&at);
            }
            at = to;
        }
        let span = |of: fn(&Pixel) -> i32| {
            line.iter().map(of).max().unwrap_or_default() - line.iter().map(of).min().unwrap_or_default()
        };
        if line.len() > 2 && span(|p| p.0).max(span(|p| p.1)) >= speck {
            loops.push(line);
        }
    }
    loops
}

/// Adds a point; the one before goes if it lies straight on the way.
fn push_straight(line: &mut Vec<Pixel>, point: Pixel) {
    if let [.., a, b] = line[..] {
        let step = |p: Pixel, q: Pixel| (i64::from(q.0) - i64::from(p.0), i64::from(q.1) - i64::from(p.1));
        let (d, e) = (step(a, b), step(b, point));
        if d.0 * e.1 == d.1 * e.0 && d.0 * e.0 + d.1 * e.1 > 0 {
            line.pop();
        }
    }
    line.push(point);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twice the area, with y downwards.
    fn area(loops: &[Vec<Pixel>]) -> i64 {
        let pairs = loops.iter().flat_map(|l| (0..l.len()).map(|k| (l[k], l[(k + 1) % l.len()])));
        pairs.map(|(p, q)| i64::from(p.0) * i64::from(q.1) - i64::from(p.1) * i64::from(q.0)).sum::<i64>().abs()
    }

    #[test]
    fn regions_of_a_linear_field_have_its_area() {
        // Cells of 100 units; values are x, so that the region beyond a level is a strip.
        let n = 10;
        let pixels: Vec<Pixel> = (0..=n).flat_map(|j| (0..=n).map(move |i| (100 * i, -100 * j))).collect();
        let values: Vec<f64> = pixels.iter().map(|p| p.0 as f64).collect();
        let at = |i: i32, j: i32| (j * (n + 1) + i) as u32;
        let cells = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
        let triangles: Vec<[u32; 3]> = cells
            .flat_map(|(i, j)| [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]])
            .collect();
        let mut surface = Surface::new(&pixels, &values, &triangles);
        assert_eq!(surface.outline().len(), 1);
        assert_eq!(area(&surface.outline()), 2_000_000);
        for level in [0, 250, 300, 999] {
            assert_eq!(area(&surface.region(level.into(), 0)), 2 * 1000 * i64::from(1000 - level), "level {level}");
        }
        assert!(surface.region(1001.0, 0).is_empty());
        // A hole: around the value NaN there is nothing.
        let mut holed = values.clone();
        holed[60] = f64::NAN;
        surface = Surface::new(&pixels, &holed, &triangles);
        assert_eq!(area(&surface.region(-1.0, 0)), 2 * (1_000_000 - 30_000));
    }
}
