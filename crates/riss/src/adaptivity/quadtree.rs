//! Squares over a body, split into four where nodes shall be finer [CPM, Appendix A].
//!
//! Squares that touch, at a corner even, differ by a factor of two at most (2:1 balance): supports of neighboring nodes
//! stay alike.

use crate::geometry::aabb::Aabb;
use crate::math::Vector2;
use rustc_hash::FxHashSet;

/// Splits in a row; below that, positions have too few digits.
pub const MAX_LEVEL: u8 = 26;

/// A square of the tree: edge length `root / 2^level`, the `(i, j)`-th from the lower left.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Square {
    /// Number of splits above.
    pub level: u8,
    /// Column on its level.
    pub i: u64,
    /// Row on its level.
    pub j: u64,
}

impl Square {
    /// The four squares that it splits into.
    pub fn children(self) -> [Self; 4] {
        [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(a, b)| Self {
            level: self.level + 1,
            i: 2 * self.i + a,
            j: 2 * self.j + b,
        })
    }

    /// The square that it is a quarter of; a root has none.
    pub fn parent(self) -> Option<Self> {
        let level = self.level.checked_sub(1)?;
        Some(Self { level, i: self.i / 2, j: self.j / 2 })
    }
}

/// Squares without overlap that cover a box.
#[derive(Clone, Debug, PartialEq)]
pub struct Quadtree {
    lower: Vector2,
    /// Edge length of a root.
    root: f64,
    roots: [u64; 2],
    leaves: FxHashSet<Square>,
}

impl Quadtree {
    /// Equal squares over a box: as many as fit along its longer side, at least one.
    pub fn uniform(bounds: &Aabb<2>, size: f64) -> Self {
        let extent = bounds.size();
        let n = (extent.max() / size - 1e-9).ceil().max(1.0);
        let root = extent.max() / n;
        let roots = [extent.x, extent.y].map(|e| (e / root - 1e-9).ceil().max(1.0) as u64);
        let squares = (0..roots[1]).flat_map(|j| (0..roots[0]).map(move |i| Square { level: 0, i, j }));
        Self { lower: bounds.lower, root, roots, leaves: squares.collect() }
    }

    /// All squares that are not split, level by level.
    pub fn leaves(&self) -> Vec<Square> {
        let mut leaves: Vec<Square> = self.leaves.iter().copied().collect();
        leaves.sort_unstable();
        leaves
    }

    /// Number of squares that are not split.
    pub fn len(&self) -> usize {
        self.leaves.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.leaves.is_empty()
    }

    /// Edge length of a square [length].
    pub fn size(&self, square: Square) -> f64 {
        self.root / (1u64 << square.level) as f64
    }

    /// Where a square lies.
    pub fn bounds(&self, square: Square) -> Aabb<2> {
        let size = self.size(square);
        let lower = self.lower + Vector2::new(square.i as f64, square.j as f64) * size;
        Aabb { lower, upper: lower + Vector2::repeat(size) }
    }

    /// The square that holds a point of the box.
    pub fn leaf_at(&self, p: Vector2) -> Option<Square> {
        let at = (p - self.lower) / self.root;
        for level in 0..=MAX_LEVEL {
            let scale = (1u64 << level) as f64;
            let index = |d: usize| {
                let last = (self.roots[d] << level) - 1;
                ((at[d] * scale).floor().max(0.0) as u64).min(last)
            };
            let square = Square { level, i: index(0), j: index(1) };
            if self.leaves.contains(&square) {
                return Some(square);
            }
        }
        None
    }

    /// Splits squares until none is larger than what its center asks for, times √2: sizes are right in the mean.
    pub fn fit(&mut self, wanted: impl Fn(Vector2) -> f64) {
        let mut open = self.leaves();
        while let Some(square) = open.pop() {
            let limit = std::f64::consts::SQRT_2 * wanted(self.bounds(square).center());
            if self.size(square) > limit && square.level < MAX_LEVEL {
                self.leaves.remove(&square);
                self.leaves.extend(square.children());
                open.extend(square.children());
            }
        }
        self.balance(self.leaves());
    }

    /// Splits squares into four, and those around them that would be more than twice as large; returns how many were split.
    pub fn refine(&mut self, squares: &[Square]) -> usize {
        let before = self.leaves.len();
        let mut made = vec![];
        for square in squares.iter().filter(|s| s.level < MAX_LEVEL) {
            if self.leaves.remove(square) {
                self.leaves.extend(square.children());
                made.extend(square.children());
            }
        }
        self.balance(made);
        (self.leaves.len() - before) / 3
    }

    /// Joins four squares to the one they came from, where all four are given and 2:1 remains; returns how many were made.
    pub fn coarsen(&mut self, squares: &[Square]) -> usize {
        let given: FxHashSet<Square> = squares.iter().copied().collect();
        let mut parents: Vec<Square> = squares.iter().filter_map(|s| s.parent()).collect();
        parents.sort_unstable();
        parents.dedup();
        let mut joined = 0;
        // Finest first: only they can stand in the way of others.
        for parent in parents.into_iter().rev() {
            let children = parent.children();
            let whole = children.iter().all(|c| given.contains(c) && self.leaves.contains(c));
            if whole && !children.iter().any(|c| self.neighbors(*c).any(|n| self.is_split(n))) {
                children.iter().for_each(|c| {
                    self.leaves.remove(c);
                });
                self.leaves.insert(parent);
                joined += 1;
            }
        }
        joined
    }

    /// Squares of the same level around one, within the box.
    fn neighbors(&self, square: Square) -> impl Iterator<Item = Square> + use<> {
        let n = self.roots.map(|r| r << square.level);
        let around = [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)];
        around.into_iter().filter_map(move |(a, b)| {
            let (i, j) = (square.i.checked_add_signed(a)?, square.j.checked_add_signed(b)?);
            (i < n[0] && j < n[1]).then_some(Square { i, j, ..square })
        })
    }

    /// Whether a square is split: neither a leaf nor part of a larger one.
    fn is_split(&self, square: Square) -> bool {
        let mut current = Some(square);
        while let Some(s) = current {
            if self.leaves.contains(&s) {
                return false;
            }
            current = s.parent();
        }
        true
    }

    /// Splits what is more than twice as large as one of `made` beside it.
    fn balance(&mut self, mut made: Vec<Square>) {
        while let Some(square) = made.pop() {
            if !self.leaves.contains(&square) {
                continue;
            }
            for neighbor in self.neighbors(square) {
                // Twice as large is fine: look from the grandparent up.
                let mut larger = neighbor.parent().and_then(Square::parent);
                while let Some(s) = larger {
                    if self.leaves.remove(&s) {
                        self.leaves.extend(s.children());
                        made.extend(s.children());
                        made.push(square);
                        break;
                    }
                    larger = s.parent();
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn area(tree: &Quadtree) -> f64 {
        tree.leaves().iter().map(|s| tree.size(*s).powi(2)).sum()
    }

    fn check_balance(tree: &Quadtree) {
        let leaves = tree.leaves();
        for a in &leaves {
            for b in leaves.iter().filter(|b| b.level > a.level + 1) {
                // Closed boxes of dyadic corners: touching is exact.
                assert!(!tree.bounds(*a).intersects(&tree.bounds(*b)), "{a:?} {b:?}");
            }
        }
    }

    fn unit() -> Aabb<2> {
        Aabb { lower: Vector2::zeros(), upper: Vector2::new(1.0, 0.5) }
    }

    #[test]
    fn squares_cover_the_box() {
        let tree = Quadtree::uniform(&unit(), 0.3);
        // Four along the longer side.
        assert_eq!((tree.len(), tree.size(tree.leaves()[0])), (8, 0.25));
        assert_eq!(tree.leaf_at(Vector2::new(0.3, 0.5)), Some(Square { level: 0, i: 1, j: 1 }));
    }

    #[test]
    fn refinement_towards_a_point_grades_by_two_and_is_undone_by_coarsening() {
        let start = Quadtree::uniform(&unit(), 0.25);
        let mut tree = start.clone();
        for _ in 0..8 {
            let tip = tree.leaf_at(Vector2::new(0.5, 0.25)).unwrap();
            assert!(tree.refine(&[tip]) >= 1);
            check_balance(&tree);
        }
        assert!((area(&tree) - 0.5).abs() < 1e-15 && tree.leaves().last().unwrap().level == 8);
        for _ in 0..8 {
            tree.coarsen(&tree.leaves());
            check_balance(&tree);
        }
        assert_eq!(tree, start);
    }

    #[test]
    fn fit_meets_a_graded_spacing() {
        let mut tree = Quadtree::uniform(&unit(), 0.25);
        let wanted = |p: Vector2| 0.002 + 0.2 * (p - Vector2::new(0.4, 0.2)).norm();
        tree.fit(wanted);
        check_balance(&tree);
        for square in tree.leaves() {
            assert!(tree.size(square) <= 1.5 * wanted(tree.bounds(square).center()));
        }
    }

    proptest! {
        #[test]
        fn any_refinement_and_coarsening_keeps_area_and_balance(
            points in proptest::collection::vec((0.0..1.0f64, 0.0..0.5f64, proptest::bool::ANY), 1..60),
        ) {
            let mut tree = Quadtree::uniform(&unit(), 0.5);
            for (x, y, grows) in points {
                let leaf = tree.leaf_at(Vector2::new(x, y)).unwrap();
                let at = Vector2::new(x, y);
                let holds = tree.bounds(leaf).intersects(&Aabb { lower: at, upper: at });
                prop_assert!(holds);
                if grows {
                    tree.refine(&[leaf]);
                } else if let Some(parent) = leaf.parent() {
                    tree.coarsen(&parent.children());
                }
                check_balance(&tree);
                prop_assert!((area(&tree) - 0.5).abs() < 1e-14);
            }
        }
    }
}
