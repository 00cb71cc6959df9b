//! Integration points along crack faces: each sees the body from both sides.

use super::cells::edge_rule;
use super::rules::graded_line;
use super::settings::{IntegrationSettings, Scheme, TipRule};
use crate::geometry::aabb::Aabb;
use crate::math::{Vector2, turn_left};
use crate::model::Model;
use crate::nodes::chains::{Chains, CrackPiece};
use crate::nodes::triangulation::SIGHT_SHIFT;

/// Pieces at each end of a crack over which a contact pressure is linear.
///
/// The faces of a computed mode II overlap and gape within a few spacings of the tip. A pressure that is fitted to that
/// from point to point oscillates and makes a K_I of up to a quarter of K_II; over 2, 4, 8 pieces the openings average
/// out, and 0.17, 0.05, 0.014 of K_II are left.
const PIECES_AT_END: usize = 8;
/// The same between the ends. Twice as many miss K of a partly closed crack by 0.6 %, these by 0.1 %.
const PIECES_BETWEEN: usize = 2;

/// A piece of a crack between two neighboring points.
#[derive(Clone, Debug)]
pub struct CrackFaceElement {
    /// Index of the crack.
    pub crack: usize,
    /// Both ends, in the direction of the path.
    pub ends: [Vector2; 2],
    /// The stretch that it is part of: from the knot of this number to the next one.
    pub stretch: usize,
    /// Where both ends lie in the stretch, from 0 to 1 by length.
    pub range: [f64; 2],
    /// Gauss points, the same positions as on the edges of the cells on both sides.
    pub points: Vec<CrackFacePoint>,
}

/// An integration point on both faces of a crack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrackFacePoint {
    /// Position.
    pub position: Vector2,
    /// From where visibility is asked: slightly to the left and to the right of the path.
    pub sights: [Vector2; 2],
    /// Unit normal to the left of the path: out of the body on the right face.
    pub normal: Vector2,
    /// Integration weight [length].
    pub weight: f64,
    /// Where it lies in its stretch, from 0 to 1.
    pub along: f64,
}

impl CrackFaceElement {
    /// The least box around the points.
    pub fn bounds(&self) -> Aabb<2> {
        Aabb::of_points(self.points.iter().flat_map(|p| [p.position, p.sights[0], p.sights[1]]))
    }
}

/// Elements along every crack whose faces something acts on, in the order of cracks and paths.
pub fn crack_face_elements(model: &Model, chains: &Chains, settings: &IntegrationSettings) -> Vec<CrackFaceElement> {
    let rule = Rule::new(model, settings);
    let mut elements: Vec<CrackFaceElement> = vec![];
    let ends = |p: &CrackPiece| p.points.map(|i| chains.positions[i as usize]);
    for (pieces, knots) in stretches(model, chains, ends) {
        let first = elements.last().map_or(0, |e| e.stretch + 2);
        for (k, knots) in knots.windows(2).enumerate() {
            let of_stretch = &pieces[knots[0]..knots[1]];
            let length = |p: &CrackPiece| (ends(p)[1] - ends(p)[0]).norm();
            let total: f64 = of_stretch.iter().map(length).sum();
            let mut start = 0.0;
            for piece in of_stretch {
                let range = [start / total, (start + length(piece)) / total];
                elements.push(element(piece.crack, ends(piece), (first + k, range), &rule));
                start += length(piece);
            }
        }
    }
    elements
}

/// Runs of pieces of one crack that something acts on, each with the places of its knots.
///
/// Of a cohesive crack a run ends where a notch begins: a function of a knot that reached into it would act on less than its
/// faces.
fn stretches<'c>(
    model: &Model,
    chains: &'c Chains,
    ends: impl Fn(&CrackPiece) -> [Vector2; 2],
) -> Vec<(&'c [CrackPiece], Vec<usize>)> {
    let mut result = vec![];
    for pieces in chains.crack_pieces.chunk_by(|a, b| a.crack == b.crack) {
        let crack = pieces[0].crack;
        if let Some(cohesive) = model.cohesive_crack(crack) {
            let is_tied = |p: &CrackPiece| {
                let [a, b] = ends(p);
                !cohesive.is_notch((a + b) * 0.5)
            };
            let runs = pieces.chunk_by(|a, b| is_tied(a) == is_tied(b)).filter(|run| is_tied(&run[0]));
            result.extend(runs.map(|run| (run, even_knots(run.len()))));
        } else if model.loads_faces(crack) {
            result.push((pieces, knots(pieces.len())));
        }
    }
    result
}

/// Points along pieces as the cells beside them have them.
struct Rule {
    line: Vec<(f64, f64)>,
    /// From a tip on, where they are graded.
    graded: Vec<(f64, f64)>,
    tips: Vec<Vector2>,
}

impl Rule {
    fn new(model: &Model, settings: &IntegrationSettings) -> Self {
        let (line, graded) = (edge_rule(settings), graded_line(settings.tip_points));
        let is_graded = settings.tip_rule == TipRule::Graded && !matches!(settings.scheme, Scheme::Nodal { .. });
        let tips = if is_graded { model.tips().iter().map(|t| t.1.position).collect() } else { vec![] };
        Self { line, graded, tips }
    }

    fn between(&self, ends: [Vector2; 2]) -> Vec<(f64, f64)> {
        match ends.map(|end| self.tips.contains(&end)) {
            [true, _] => self.graded.clone(),
            [false, true] => self.graded.iter().map(|(t, w)| (1.0 - t, *w)).collect(),
            [false, false] => self.line.clone(),
        }
    }
}

/// Where stretches begin and end among the pieces of a crack.
fn knots(n_pieces: usize) -> Vec<usize> {
    let at_end = PIECES_AT_END.min(n_pieces / 2);
    let inner = even_knots(n_pieces - 2 * at_end).into_iter().map(|k| at_end + k);
    let mut knots: Vec<usize> = std::iter::once(0).chain(inner).chain([n_pieces]).collect();
    knots.dedup();
    knots
}

/// The same where pressures are even along the crack.
fn even_knots(n_pieces: usize) -> Vec<usize> {
    let n = (n_pieces / PIECES_BETWEEN).max(1);
    let mut knots: Vec<usize> = (0..=n).map(|k| k * n_pieces / n).collect();
    knots.dedup();
    knots
}

fn element(crack: usize, ends: [Vector2; 2], (stretch, range): (usize, [f64; 2]), rule: &Rule) -> CrackFaceElement {
    let e = ends[1] - ends[0];
    let left = turn_left(e);
    let point = |&(t, w): &(f64, f64)| {
        let position = ends[0] + e * t;
        CrackFacePoint {
            position,
            sights: [position + left * SIGHT_SHIFT, position - left * SIGHT_SHIFT],
            normal: left.normalize(),
            weight: w * e.norm(),
            along: range[0] + (range[1] - range[0]) * t,
        }
    };
    CrackFaceElement { crack, ends, stretch, range, points: rule.between(ends).iter().map(point).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn knots_cover_every_piece_once() {
        for n in 1..100 {
            let knots = knots(n);
            assert!(knots[0] == 0 && knots[knots.len() - 1] == n, "{n}: {knots:?}");
            assert!(knots.windows(2).all(|w| w[0] < w[1]), "{n}: {knots:?}");
        }
        assert_eq!(knots(21), [0, 8, 10, 13, 21]);
        assert_eq!(even_knots(7), [0, 2, 4, 7]);
        assert_eq!(even_knots(1), [0, 1]);
    }
}
