//! Cells that lie together, whose matrices are summed up where they are small before they go to the matrix of all.

use super::discretization::Discretization;
use crate::geometry::aabb::Aabb;
use crate::math::Vector2;
use rayon::prelude::*;

/// Most cells of a patch.
const MOST_CELLS: usize = 64;
/// Most nodes of a patch of several cells: its blocks stay in the cache of a core.
const MOST_NODES: usize = 192;

/// Some cells.
#[derive(Clone, Debug, Default)]
pub(super) struct Patch {
    /// Cells.
    pub cells: Vec<u32>,
    /// Neighbors of all cells, ascending.
    pub nodes: Vec<u32>,
}

/// Puts all cells into patches, along a Morton curve [Morton1966].
pub(super) fn patches(discrete: &Discretization) -> Vec<Patch> {
    let mut result: Vec<Patch> = vec![];
    let mut open = Patch::default();
    let mut patch_of = vec![u32::MAX; discrete.n_functions()];
    for cell in cell_order(discrete) {
        let list = discrete.cell_nodes.get(cell as usize);
        let number = result.len() as u32;
        let n_new = list.iter().filter(|i| patch_of[**i as usize] != number).count();
        let is_full = open.cells.len() == MOST_CELLS || open.nodes.len() + n_new > MOST_NODES;
        if is_full && !open.cells.is_empty() {
            result.push(std::mem::take(&mut open));
        }
        let number = result.len() as u32;
        for &i in list {
            if std::mem::replace(&mut patch_of[i as usize], number) != number {
                open.nodes.push(i);
            }
        }
        open.cells.push(cell);
    }
    if !open.cells.is_empty() {
        result.push(open);
    }
    result.par_iter_mut().for_each(|patch| patch.nodes.sort_unstable());
    result
}

/// Cells along a Morton curve; those without points first.
fn cell_order(discrete: &Discretization) -> Vec<u32> {
    let cells = &discrete.cells;
    let bounds = Aabb::of_points(cells.points.iter().map(|p| p.position));
    let scale = f64::from(u32::MAX) / bounds.size().max().max(f64::MIN_POSITIVE);
    let key = |p: Vector2| {
        let [x, y] = [0, 1].map(|d| ((p[d] - bounds.lower[d]) * scale) as u32);
        spread(x) | spread(y) << 1
    };
    let of_cell = |(i, range): (usize, &std::ops::Range<u32>)| {
        (cells.points[range.start as usize..range.end as usize].first().map_or(0, |p| key(p.position)), i as u32)
    };
    let mut order: Vec<(u64, u32)> = cells.point_ranges.par_iter().enumerate().map(of_cell).collect();
    order.par_sort_unstable();
    order.into_iter().map(|o| o.1).collect()
}

/// The bits of a number with a gap after each.
fn spread(number: u32) -> u64 {
    let mut bits = u64::from(number);
    bits = (bits | bits << 16) & 0x0000_ffff_0000_ffff;
    bits = (bits | bits << 8) & 0x00ff_00ff_00ff_00ff;
    bits = (bits | bits << 4) & 0x0f0f_0f0f_0f0f_0f0f;
    bits = (bits | bits << 2) & 0x3333_3333_3333_3333;
    (bits | bits << 1) & 0x5555_5555_5555_5555
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_spread() {
        for number in [0, 1, 2, 0b1011, u32::MAX, 0x8000_0001] {
            let naive = (0..32).map(|k| u64::from(number >> k & 1) << (2 * k)).sum::<u64>();
            assert_eq!(spread(number), naive);
        }
    }
}
