//! The coarse level of the solver: an affine motion for each group of nodes [Vanek1996].
//!
//! With the rows of collocation scaled like virtual work, the transposed prolongation is a good restriction.

use super::aggregates::{Aggregates, NO_GROUP};
use super::block_rows::{Block, BlockRows};
use super::sparse_lu::{ScalarRows, SparseLu};
use crate::error::Result;
use crate::math::{Matrix, Vector};
use rayon::prelude::*;

/// Modes of a group count as dependent if the others leave less than this share of their square.
const DEPENDENT: f64 = 1e-8;

/// Affine motions of groups, with the factored matrix of their amplitudes.
pub struct CoarseLevel<const D: usize> {
    groups: Aggregates,
    /// Factors of the modes at each node: one and the coordinates from the center of its group.
    factors: Vec<[f64; 4]>,
    free: Vec<Matrix<D>>,
    is_used: Vec<bool>,
    n_border: usize,
    factor: SparseLu,
    image: Image,
}

/// What the matrix makes of the modes: for each node the groups that it meets, with `D` numbers for each of their modes.
#[derive(Default)]
struct Image {
    starts: Vec<usize>,
    groups: Vec<u32>,
    factors: Vec<f64>,
}

/// Groups that a group meets, with the block of each.
type GroupRow = Vec<(u32, Vec<f64>)>;

/// Modes of a group.
const fn n_modes<const D: usize>() -> usize {
    D * (D + 1)
}

impl<const D: usize> CoarseLevel<D> {
    /// Restricts a matrix, to which the products of `border` with itself are added, and factors it.
    ///
    /// # Errors
    /// [`crate::Error::Factorization`] if the coarse matrix is singular.
    pub fn new(
        matrix: &BlockRows<D>,
        positions: &[Vector<D>],
        fixed: &[Matrix<D>],
        groups: Aggregates,
        border: &[Vec<f64>],
    ) -> Result<Self> {
        let free: Vec<Matrix<D>> = fixed.iter().map(|f| Matrix::identity() - f).collect();
        let factors = factors(positions, &groups);
        let is_used = independent_modes(&groups, &factors, &free);
        let parts = Parts { matrix, groups: &groups, factors: &factors, free: &free };
        let n_groups = groups.members.len();
        let rows: Vec<(GroupRow, Image)> = (0..n_groups)
            .into_par_iter()
            .map_init(|| vec![u32::MAX; n_groups], |slots, g| parts.row(g, slots))
            .collect();
        let (blocks, images): (Vec<_>, Vec<_>) = rows.into_iter().unzip();
        let image = Image::joined::<D>(positions.len(), &groups, &images);
        drop(images);
        let m = n_modes::<D>();
        let mut edge = vec![vec![0.0; n_groups * m]; border.len()];
        for (edge, border) in edge.iter_mut().zip(border) {
            restrict::<D, 1>(&groups, &factors, &free, border, edge);
            edge.iter_mut().zip(&is_used).filter(|(_, used)| !**used).for_each(|(e, _)| *e = 0.0);
        }
        let factor = SparseLu::new(scalar_rows(&blocks, &is_used, &edge, m))?;
        Ok(Self { groups, factors, free, is_used, n_border: border.len(), factor, image })
    }

    /// Number of unknowns.
    pub fn n_unknowns(&self) -> usize {
        self.is_used.len()
    }

    /// `z = P A_c⁻¹ Pᵀ r` for `W` vectors at once, whose entries stand side by side, and what that leaves of `r` but for
    /// the border.
    pub fn correct<const W: usize>(&self, r: &[f64], z: &mut [f64], rest: &mut [f64]) {
        let mut amplitudes = vec![0.0; (self.is_used.len() + self.n_border) * W];
        restrict::<D, W>(&self.groups, &self.factors, &self.free, r, &mut amplitudes);
        let unused = amplitudes.chunks_exact_mut(W).zip(&self.is_used).filter(|(_, used)| !**used);
        unused.for_each(|(a, _)| a.fill(0.0));
        self.factor.solve_in_place::<W>(&mut amplitudes);
        let m = n_modes::<D>();
        z.par_chunks_exact_mut(D * W).enumerate().for_each(|(i, z)| {
            let group = self.groups.of_node[i];
            if group == NO_GROUP {
                z.fill(0.0);
                return;
            }
            let own = &amplitudes[group as usize * m * W..(group as usize + 1) * m * W];
            for lane in 0..W {
                let amplitude = |l: usize, a: usize| self.factors[i][l] * own[(l * D + a) * W + lane];
                let motion = Vector::<D>::from_fn(|a, _| (0..=D).map(|l| amplitude(l, a)).sum());
                let moved = self.free[i] * motion;
                (0..D).for_each(|a| z[a * W + lane] = moved[a]);
            }
        });
        rest.par_chunks_exact_mut(D * W).zip(r.par_chunks_exact(D * W)).enumerate().for_each(|(i, (rest, r))| {
            rest.copy_from_slice(r);
            self.image.subtract::<D, W>(i, &amplitudes, rest);
        });
    }
}

impl Image {
    /// Puts what was found group by group in the order of the nodes.
    fn joined<const D: usize>(n: usize, groups: &Aggregates, images: &[Self]) -> Self {
        let size = D * n_modes::<D>();
        let mut source = vec![(0u32, 0u32); n];
        for (g, members) in groups.members.iter().enumerate() {
            members.iter().enumerate().for_each(|(k, &i)| source[i as usize] = (g as u32, k as u32));
        }
        let total: usize = images.iter().map(|m| m.groups.len()).sum();
        let mut joined =
            Self { starts: vec![0], groups: Vec::with_capacity(total), factors: Vec::with_capacity(total * size) };
        for (i, (g, k)) in source.into_iter().enumerate() {
            if groups.of_node[i] != NO_GROUP {
                let (own, k) = (&images[g as usize], k as usize);
                let range = own.starts[k]..own.starts[k + 1];
                joined.groups.extend(&own.groups[range.clone()]);
                joined.factors.extend(&own.factors[range.start * size..range.end * size]);
            }
            joined.starts.push(joined.groups.len());
        }
        joined
    }

    /// Subtracts the image of amplitudes at a node.
    #[inline]
    fn subtract<const D: usize, const W: usize>(&self, node: usize, amplitudes: &[f64], rest: &mut [f64]) {
        let m = n_modes::<D>();
        let range = self.starts[node]..self.starts[node + 1];
        let factors = self.factors[range.start * D * m..range.end * D * m].chunks_exact(D * m);
        for (&group, factors) in self.groups[range].iter().zip(factors) {
            let own = &amplitudes[group as usize * m * W..(group as usize + 1) * m * W];
            for (rest, row) in rest.chunks_exact_mut(W).zip(factors.chunks_exact(m)) {
                for (factor, own) in row.iter().zip(own.chunks_exact(W)) {
                    (0..W).for_each(|l| rest[l] -= factor * own[l]);
                }
            }
        }
    }
}

fn factors<const D: usize>(positions: &[Vector<D>], groups: &Aggregates) -> Vec<[f64; 4]> {
    let mut factors = vec![[0.0; 4]; positions.len()];
    for members in groups.members.iter().filter(|m| !m.is_empty()) {
        let n = members.len() as f64;
        let center = members.iter().fold(Vector::<D>::zeros(), |s, &i| s + positions[i as usize]) / n;
        let spread = members.iter().map(|&i| (positions[i as usize] - center).norm_squared()).sum::<f64>() / n;
        let scale = if spread > 0.0 { 1.0 / spread.sqrt() } else { 0.0 };
        for &i in members {
            let d = (positions[i as usize] - center) * scale;
            factors[i as usize][0] = 1.0;
            factors[i as usize][1..=D].copy_from_slice(d.as_slice());
        }
    }
    factors
}

/// Which modes of each group the others do not make up for.
fn independent_modes<const D: usize>(groups: &Aggregates, factors: &[[f64; 4]], free: &[Matrix<D>]) -> Vec<bool> {
    let m = n_modes::<D>();
    let of_group = |members: &Vec<u32>| {
        let mut gram = vec![vec![0.0; m]; m];
        for &i in members {
            let (w, q) = (&factors[i as usize], &free[i as usize]);
            for p in 0..m {
                for s in 0..=p {
                    gram[p][s] += w[p / D] * w[s / D] * q[(p % D, s % D)];
                }
            }
        }
        let mut used = vec![true; m];
        for k in 0..m {
            let before = gram[k][k];
            let mut pivot = before;
            for j in (0..k).filter(|&j| used[j]) {
                pivot -= gram[k][j] * gram[k][j];
            }
            used[k] = pivot > DEPENDENT * before;
            if !used[k] {
                continue;
            }
            let root = pivot.sqrt();
            gram[k][k] = root;
            for i in k + 1..m {
                let known: f64 = (0..k).filter(|&j| used[j]).map(|j| gram[i][j] * gram[k][j]).sum();
                gram[i][k] = (gram[i][k] - known) / root;
            }
        }
        used
    };
    groups.members.iter().flat_map(of_group).collect()
}

/// What the coarse matrix is made of.
struct Parts<'a, const D: usize> {
    matrix: &'a BlockRows<D>,
    groups: &'a Aggregates,
    factors: &'a [[f64; 4]],
    free: &'a [Matrix<D>],
}

impl<const D: usize> Parts<'_, D> {
    /// The blocks of a group with those it meets, in the order of their numbers, and the image at its nodes.
    fn row(&self, group: usize, slots: &mut [u32]) -> (GroupRow, Image) {
        let m = n_modes::<D>();
        let mut image = Image { starts: vec![0], ..Image::default() };
        let mut found: Vec<(u32, Vec<f64>)> = vec![];
        let mut sums: Vec<f64> = vec![];
        for &i in &self.groups.members[group] {
            let i = i as usize;
            sums.clear();
            sums.resize(found.len() * D * m, 0.0);
            let (columns, blocks) = self.matrix.row(i);
            for (&j, block) in columns.iter().zip(blocks) {
                let other = self.groups.of_node[j as usize];
                if other == NO_GROUP {
                    continue;
                }
                if slots[other as usize] == u32::MAX {
                    slots[other as usize] = found.len() as u32;
                    found.push((other, vec![0.0; m * m]));
                    sums.resize(found.len() * D * m, 0.0);
                }
                let start = slots[other as usize] as usize * D * m;
                let sum = &mut sums[start..start + D * m];
                let (w, q) = (&self.factors[j as usize], &self.free[j as usize]);
                let block = if q.is_identity(0.0) { *block } else { times(block, q) };
                for (sum, row) in sum.chunks_exact_mut(m).zip(&block) {
                    for (sum, w) in sum.chunks_exact_mut(D).zip(w) {
                        for b in 0..D {
                            sum[b] += row[b] * w;
                        }
                    }
                }
            }
            for ((other, _), sum) in
                found.iter().zip(sums.chunks_exact(D * m)).filter(|f| f.1.iter().any(|v| *v != 0.0))
            {
                image.groups.push(*other);
                image.factors.extend(sum.iter());
            }
            image.starts.push(image.groups.len());
            let (w, q) = (&self.factors[i], &self.free[i]);
            for ((_, target), sum) in found.iter_mut().zip(sums.chunks_exact(D * m)) {
                for a in 0..D {
                    for p in 0..m {
                        let v: f64 = (0..D).map(|c| q[(a, c)] * sum[c * m + p]).sum();
                        (0..=D).for_each(|l| target[(l * D + a) * m + p] += v * w[l]);
                    }
                }
            }
        }
        found.iter().for_each(|f| slots[f.0 as usize] = u32::MAX);
        found.sort_unstable_by_key(|f| f.0);
        (found, image)
    }
}

fn times<const D: usize>(block: &Block<D>, q: &Matrix<D>) -> Block<D> {
    std::array::from_fn(|a| std::array::from_fn(|b| (0..D).map(|c| block[a][c] * q[(c, b)]).sum()))
}

/// `Pᵀ r` for `W` vectors at once, into the first entries of `amplitudes`.
fn restrict<const D: usize, const W: usize>(
    groups: &Aggregates,
    factors: &[[f64; 4]],
    free: &[Matrix<D>],
    r: &[f64],
    amplitudes: &mut [f64],
) {
    let m = n_modes::<D>() * W;
    amplitudes[..groups.members.len() * m].par_chunks_exact_mut(m).zip(&groups.members).for_each(|(own, members)| {
        for &i in members {
            let i = i as usize;
            for lane in 0..W {
                let force = free[i] * Vector::<D>::from_fn(|a, _| r[(i * D + a) * W + lane]);
                for l in 0..=D {
                    (0..D).for_each(|a| own[(l * D + a) * W + lane] += factors[i][l] * force[a]);
                }
            }
        }
    });
}

/// The coarse matrix, with the border and minus the identity in its corner.
fn scalar_rows(blocks: &[GroupRow], is_used: &[bool], edge: &[Vec<f64>], m: usize) -> ScalarRows {
    let n = is_used.len();
    let mut rows = ScalarRows::default();
    for (group, found) in blocks.iter().enumerate() {
        for p in 0..m {
            let own = group * m + p;
            if !is_used[own] {
                rows.columns.push(own);
                rows.values.push(1.0);
                rows.end();
                continue;
            }
            for (other, block) in found {
                for q in (0..m).filter(|q| is_used[*other as usize * m + q]) {
                    rows.columns.push(*other as usize * m + q);
                    rows.values.push(block[p * m + q]);
                }
            }
            rows.columns.extend((0..edge.len()).map(|k| n + k));
            rows.values.extend(edge.iter().map(|e| e[own]));
            rows.end();
        }
    }
    rows.border_below(edge, n);
    rows
}
