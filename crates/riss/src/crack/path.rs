//! A crack in the plane: a polyline from its start to its end.

use super::tip::TipFrame;
use crate::geometry::predicates::distance_to_segment;
use crate::math::Vector2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// One of the two ends of a crack path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum End {
    /// The first vertex.
    Start,
    /// The last vertex.
    End,
}

impl End {
    /// 0 for the start, 1 for the end.
    pub fn index(self) -> usize {
        match self {
            Self::Start => 0,
            Self::End => 1,
        }
    }
}

/// What an end of a crack path is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum EndKind {
    /// A crack tip.
    Tip,
    /// On the boundary of the body.
    Mouth,
    /// On a crack, which has a vertex there.
    Junction,
}

/// A polyline whose ends are tips, unless they lie on the boundary of the body or on a crack.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CrackPath {
    /// Name in the case file and the results.
    pub name: String,
    /// Vertices in order, at least two, no two neighbors equal. An end on the boundary is exactly on it.
    pub vertices: Vec<Vector2>,
    /// What the first and the last vertex are.
    pub ends: [EndKind; 2],
}

impl CrackPath {
    /// The segments in order.
    pub fn segments(&self) -> impl Iterator<Item = (Vector2, Vector2)> + '_ {
        self.vertices.windows(2).map(|w| (w[0], w[1]))
    }

    /// Length of the path.
    pub fn length(&self) -> f64 {
        self.segments().map(|(a, b)| (b - a).norm()).sum()
    }

    /// The crack length `a` of handbooks: half of the path if both ends are tips, all of it otherwise.
    pub fn handbook_length(&self) -> f64 {
        if self.ends == [EndKind::Tip; 2] { 0.5 * self.length() } else { self.length() }
    }

    /// Ends that are tips.
    pub fn tip_ends(&self) -> impl Iterator<Item = End> {
        let ends = self.ends;
        [End::Start, End::End].into_iter().filter(move |e| ends[e.index()] == EndKind::Tip)
    }

    /// What an end is.
    pub fn end_kind(&self, end: End) -> EndKind {
        self.ends[end.index()]
    }

    /// Position of an end.
    pub fn end_position(&self, end: End) -> Vector2 {
        match end {
            End::Start => self.vertices[0],
            End::End => self.vertices[self.vertices.len() - 1],
        }
    }

    /// Ends on the boundary of the body.
    pub fn mouths(&self) -> impl Iterator<Item = Vector2> + '_ {
        let is_mouth = |e: &End| self.end_kind(*e) == EndKind::Mouth;
        [End::Start, End::End].into_iter().filter(is_mouth).map(|e| self.end_position(e))
    }

    /// Frame of an end, growth direction outward along the last segment there.
    pub fn frame(&self, end: End) -> TipFrame {
        let backwards = self.from_end(end);
        let d = backwards[0] - backwards[1];
        TipFrame { position: backwards[0], angle: d.y.atan2(d.x) }
    }

    /// Lengthens the path beyond a tip by the given vertices; the new end is of the given kind.
    pub fn extend(&mut self, end: End, vertices: &[Vector2], kind: EndKind) {
        match end {
            End::Start => {
                self.vertices.splice(0..0, vertices.iter().rev().copied());
            }
            End::End => self.vertices.extend_from_slice(vertices),
        }
        self.ends[end.index()] = kind;
    }

    /// Makes a point of the path a vertex, for a crack that ends there. An end of the path there is a tip no longer.
    pub fn join_at(&mut self, p: Vector2) {
        for end in [End::Start, End::End] {
            if self.end_position(end) == p && self.end_kind(end) == EndKind::Tip {
                self.ends[end.index()] = EndKind::Junction;
            }
        }
        let away = |k: &usize| distance_to_segment(p, self.vertices[*k], self.vertices[k + 1]);
        let inside = (0..self.vertices.len() - 1).filter(|&k| self.vertices[k] != p && self.vertices[k + 1] != p);
        let Some(nearest) = inside.min_by(|a, b| away(a).total_cmp(&away(b))) else { return };
        // A path that returns to itself has its end there, too.
        if !self.vertices.contains(&p) || away(&nearest) <= 1e-9 * self.length() {
            self.vertices.insert(nearest + 1, p);
        }
    }

    /// The vertices in order from an end into the crack.
    pub fn from_end(&self, end: End) -> Vec<Vector2> {
        match end {
            End::Start => self.vertices.clone(),
            End::End => self.vertices.iter().rev().copied().collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_point_out_of_the_crack() {
        let crack = CrackPath {
            name: "c".into(),
            vertices: vec![Vector2::new(0.0, 0.0), Vector2::new(1.0, 0.0), Vector2::new(1.0, 2.0)],
            ends: [EndKind::Tip; 2],
        };
        assert!((crack.frame(End::Start).x1() - Vector2::new(-1.0, 0.0)).norm() < 1e-15);
        assert!((crack.frame(End::End).x1() - Vector2::new(0.0, 1.0)).norm() < 1e-15);
        assert_eq!(crack.handbook_length(), 1.5);
        let frame = crack.frame(End::End);
        let p = Vector2::new(0.3, -0.8);
        assert!((frame.global(frame.local(p)) - p).norm() < 1e-15);
    }
}
