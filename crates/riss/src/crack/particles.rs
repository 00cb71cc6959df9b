//! A crack as particles, each with a segment of two straight halves [CPM, section 2.2].
//!
//! A half runs from its particle half-way to the neighbor on that side, so the segments of all particles join: their
//! union is the crack, kinked at particles only [CPM, Fig. 1].

use super::path::{CrackPath, EndKind};
use crate::geometry::predicates::distance_to_segment;
use crate::math::Vector2;

/// Particles this close to the line between their neighbors lie on it, over the length of the crack: some roundings.
const STRAIGHT: f64 = 1e-13;

/// How the shape functions meet a crack.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CrackForm {
    /// As the path that is given; nodes that stand on it are split.
    #[default]
    Path,
    /// As the segments of particles that are put along the path.
    Particles,
}

/// A particle on a crack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrackParticle {
    /// Where it stands.
    pub position: Vector2,
    /// Ends of its segment towards the particle before and the one after; `None` at the ends of the crack.
    pub halves: [Option<Vector2>; 2],
}

impl CrackParticle {
    /// The straight halves of its segment, in the direction of the crack.
    pub fn segment(&self) -> impl Iterator<Item = [Vector2; 2]> {
        let [before, after] = self.halves;
        let before = before.map(|end| [end, self.position]);
        before.into_iter().chain(after.map(|end| [self.position, end]))
    }

    /// Turn of the crack at the particle, counterclockwise [rad].
    pub fn turn(&self) -> f64 {
        let [Some(before), Some(after)] = self.halves else { return 0.0 };
        let (a, b) = (self.position - before, after - self.position);
        crate::math::cross(a, b).atan2(a.dot(&b))
    }
}

/// All particles of a crack, in its direction.
#[derive(Clone, Debug, PartialEq)]
pub struct CrackParticles {
    /// Name of the crack.
    pub name: String,
    /// At least two.
    pub particles: Vec<CrackParticle>,
    /// What the first and the last one stand at: a tip, the boundary, another crack.
    pub ends: [EndKind; 2],
}

impl CrackParticles {
    /// The segments of particles at given places along a crack.
    ///
    /// - `positions`: in the direction of the crack, from end to end, every kink of the crack among them
    pub fn new(crack: &CrackPath, positions: &[Vector2]) -> Self {
        // The same bits from both sides, so that no gap is left.
        let middle = |a: Vector2, b: Vector2| (a + b) * 0.5;
        let particle = |k: usize| CrackParticle {
            position: positions[k],
            halves: [
                k.checked_sub(1).map(|before| middle(positions[before], positions[k])),
                positions.get(k + 1).map(|after| middle(positions[k], *after)),
            ],
        };
        Self { name: crack.name.clone(), particles: (0..positions.len()).map(particle).collect(), ends: crack.ends }
    }

    /// The union of all segments. Halves in one line are joined, so that sight lines meet few.
    pub fn union(&self) -> CrackPath {
        let positions: Vec<Vector2> = self.particles.iter().map(|p| p.position).collect();
        let length: f64 = positions.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
        let mut vertices = vec![positions[0]];
        for w in positions.windows(2).skip(1) {
            let start = vertices[vertices.len() - 1];
            // A crack that turns back is not straight, though the particle lies on the line.
            let goes_on = (w[1] - w[0]).dot(&(w[0] - start)) > 0.0;
            if !goes_on || distance_to_segment(w[0], start, w[1]) > STRAIGHT * length {
                vertices.push(w[0]);
            }
        }
        vertices.push(positions[positions.len() - 1]);
        CrackPath { name: self.name.clone(), vertices, ends: self.ends }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use EndKind::{Mouth, Tip};

    fn crack(vertices: &[[f64; 2]]) -> CrackPath {
        let vertices = vertices.iter().map(|v| Vector2::from(*v)).collect();
        CrackPath { name: "c".into(), vertices, ends: [Mouth, Tip] }
    }

    /// Particles at the vertices and at unequal places between.
    fn particles(crack: &CrackPath) -> CrackParticles {
        let between = |(a, b): (Vector2, Vector2)| [0.0, 0.13, 0.4, 0.55, 0.95].map(|t| a + (b - a) * t);
        let mut positions: Vec<Vector2> = crack.segments().flat_map(between).collect();
        positions.extend(crack.vertices.last());
        CrackParticles::new(crack, &positions)
    }

    const BENT: [[f64; 2]; 5] = [[0.1, 0.3], [1.7, 0.4], [2.3, -0.9], [2.1, -2.2], [3.3, 0.7]];

    #[test]
    fn segments_join_to_the_crack() {
        let bent = crack(&BENT);
        let found = particles(&bent);
        let halves: Vec<[Vector2; 2]> = found.particles.iter().flat_map(CrackParticle::segment).collect();
        assert_eq!((halves[0][0], halves[halves.len() - 1][1]), (bent.vertices[0], bent.vertices[4]));
        assert!(halves.windows(2).all(|w| w[0][1] == w[1][0]), "a gap: {halves:?}");
        let length: f64 = halves.iter().map(|[a, b]| (b - a).norm()).sum();
        assert!((length - bent.length()).abs() < 1e-14 * length);
        for end in halves.concat() {
            let distance = bent.segments().map(|(a, b)| distance_to_segment(end, a, b)).fold(f64::INFINITY, f64::min);
            assert!(distance < 1e-15, "{end}: {distance}");
        }
    }

    #[test]
    fn the_union_is_the_path() {
        for vertices in [&BENT[..], &BENT[..2], &BENT[1..4]] {
            let bent = crack(vertices);
            assert_eq!(particles(&bent).union(), bent);
        }
        // There and back again.
        let back = crack(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]]);
        assert_eq!(particles(&back).union(), back);
    }

    #[test]
    fn a_particle_turns_where_the_crack_does() {
        let turns: Vec<f64> = particles(&crack(&BENT)).particles.iter().map(CrackParticle::turn).collect();
        assert_eq!(turns.len(), 21);
        for (k, turn) in turns.iter().enumerate() {
            let is_vertex = k % 5 == 0 && k > 0 && k < 20;
            assert!(if is_vertex { turn.abs() > 0.1 } else { turn.abs() < 1e-12 }, "{k}: {turn}");
        }
        // From -1 to 0.6 rad is to the left.
        assert!(turns[15] > 0.0 && turns[5] < 0.0);
    }

    /// The unit circle: chords between neighbors stay within h²/8 of the arc.
    #[test]
    fn an_arc_is_followed_to_second_order() {
        for n in [8, 16, 32] {
            let step = 1.5 / n as f64;
            let positions: Vec<Vector2> = (0..=n).map(|k| crate::math::direction(k as f64 * step)).collect();
            let path = CrackPath { vertices: positions.clone(), ..crack(&BENT) };
            let union = CrackParticles::new(&path, &positions).union();
            assert_eq!(union.vertices.len(), n + 1);
            let off = union.segments().map(|(a, b)| 1.0 - ((a + b) * 0.5).norm()).fold(0.0, f64::max);
            assert!(off < step * step / 8.0 && off > 0.99 * step * step / 8.0, "{n}: {off}");
        }
    }
}
