//! Numbers in two or three bytes each, prepared so that DEFLATE finds little left to say.
//!
//! A channel becomes whole numbers, these the differences of neighbors, their bytes planes: all lowest bytes first.

use serde::Serialize;

/// How values become whole numbers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Scale {
    /// Even steps from the least to the greatest value.
    Linear,
    /// Even steps of the inverse hyperbolic sine: as fine for most values as for those beside a singularity.
    Asinh {
        /// Value up to which steps are about even.
        unit: f64,
    },
}

impl Scale {
    /// For values of which few are much greater than the others.
    pub fn for_singular(values: &[f64]) -> Self {
        let mut sizes: Vec<f64> = values.iter().map(|v| v.abs()).filter(|v| v.is_finite() && *v > 0.0).collect();
        if sizes.is_empty() {
            return Self::Linear;
        }
        let middle = sizes.len() / 2;
        Self::Asinh { unit: *sizes.select_nth_unstable_by(middle, f64::total_cmp).1 }
    }

    fn forward(self, value: f64) -> f64 {
        match self {
            Self::Linear => value,
            Self::Asinh { unit } => (value / unit).asinh(),
        }
    }
}

/// What the browser needs to know to make values of whole numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Channel {
    pub name: &'static str,
    pub scale: Scale,
    /// Ends of the scale, after [`Scale::forward`].
    pub low: f64,
    pub high: f64,
    /// Bytes of each value. The greatest whole number stands for what is not finite.
    pub bytes: u32,
}

/// Appends the planes of a channel to `data`.
pub(super) fn push_channel(
    name: &'static str,
    values: &[f64],
    scale: Scale,
    bytes: u32,
    data: &mut Vec<u8>,
) -> Channel {
    let scaled: Vec<f64> = values.iter().map(|v| scale.forward(*v)).collect();
    let finite = || scaled.iter().copied().filter(|v| v.is_finite());
    let (low, high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
    let mask = u32::MAX >> (32 - 8 * bytes);
    let steps = f64::from(mask - 1) / if high > low { high - low } else { 1.0 };
    let whole = |v: f64| if v.is_finite() { ((v - low) * steps).round() as u32 } else { mask };
    let mut last = 0;
    let differences: Vec<u32> = scaled
        .iter()
        .map(|v| {
            let now = whole(*v);
            let difference = now.wrapping_sub(last) & mask;
            last = now;
            zigzag(difference, bytes)
        })
        .collect();
    for plane in 0..bytes {
        data.extend(differences.iter().map(|d| (d >> (8 * plane)) as u8));
    }
    Channel { name, scale, low, high, bytes }
}

/// Small numbers of either sign as small numbers: 0, -1, 1, -2, ... become 0, 1, 2, 3, ...
fn zigzag(difference: u32, bytes: u32) -> u32 {
    let unused = 32 - 8 * bytes;
    let signed = ((difference << unused) as i32) >> unused;
    ((signed << 1) ^ (signed >> 31)) as u32 & (u32::MAX >> unused)
}

/// Appends triangles: each vertex by how far it lies before the first one that was not named yet.
///
/// Vertices must be numbered in the order in which the triangles name them.
pub(super) fn push_triangles(triangles: &[[u32; 3]], data: &mut Vec<u8>) {
    let mut next = 0;
    for &vertex in triangles.iter().flatten() {
        let mut back = next - vertex;
        next += u32::from(back == 0);
        while back >= 128 {
            data.push(back as u8 | 128);
            back >>= 7;
        }
        data.push(back as u8);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the browser does.
    fn read(channel: &Channel, data: &[u8], n: usize) -> Vec<f64> {
        let mask = u32::MAX >> (32 - 8 * channel.bytes);
        let mut last = 0_u32;
        (0..n)
            .map(|i| {
                let z = (0..channel.bytes).fold(0, |z, p| z | u32::from(data[p as usize * n + i]) << (8 * p));
                last = last.wrapping_add((z >> 1) ^ (z & 1).wrapping_neg()) & mask;
                let at = channel.low + f64::from(last) * (channel.high - channel.low) / f64::from(mask - 1);
                match channel.scale {
                    _ if last == mask => f64::NAN,
                    Scale::Linear => at,
                    Scale::Asinh { unit } => at.sinh() * unit,
                }
            })
            .collect()
    }

    #[test]
    fn values_come_back_within_half_a_step() {
        let values: Vec<f64> = (0..500).map(|k| (f64::from(k) * 0.7).sin() * f64::from(k)).collect();
        for bytes in [2, 3] {
            let mut data = vec![];
            let channel = push_channel("a", &values, Scale::Linear, bytes, &mut data);
            let half = 0.5 * (channel.high - channel.low) / f64::from((1_u32 << (8 * bytes)) - 2);
            for (v, r) in values.iter().zip(read(&channel, &data, values.len())) {
                assert!((v - r).abs() <= half * (1.0 + 1e-9), "{v} {r}");
            }
        }
    }

    #[test]
    fn singular_values_keep_the_others_fine() {
        // As 1/√r, the stress at a tip: from 1 to 1000.
        let values: Vec<f64> =
            (1..=1000).map(|k| (1e6 / f64::from(k * k * k)).sqrt()).chain([f64::NAN, -3.0]).collect();
        let mut data = vec![];
        let channel = push_channel("a", &values, Scale::for_singular(&values), 2, &mut data);
        let back = read(&channel, &data, values.len());
        assert!(back[1000].is_nan());
        // Half a step of asinh, over a range of less than 20, is 1.6e-4; it is the relative error above the unit.
        for (v, r) in values.iter().zip(back).filter(|(v, _)| v.is_finite()) {
            assert!((v - r).abs() <= 1.6e-4 * (v * v + 0.1).sqrt().max(v.abs()), "{v} {r}");
        }
    }

    #[test]
    fn one_value_and_none_at_all() {
        let mut data = vec![];
        let channel = push_channel("a", &[7.5, 7.5], Scale::Linear, 2, &mut data);
        assert_eq!(read(&channel, &data, 2), [7.5, 7.5]);
        assert_eq!(Scale::for_singular(&[0.0, f64::NAN]), Scale::Linear);
        let nothing = push_channel("a", &[f64::INFINITY], Scale::Linear, 2, &mut data);
        assert_eq!((nothing.low, nothing.high), (0.0, 0.0));
    }

    #[test]
    fn triangles_count_back_from_the_next_new_vertex() {
        let mut data = vec![];
        push_triangles(&[[0, 1, 2], [0, 2, 3]], &mut data);
        assert_eq!(data, [0, 0, 0, 3, 1, 0]);
        let mut far = vec![];
        let fan: Vec<[u32; 3]> = (0..100).map(|k| [0, k + 1, k + 2]).collect();
        push_triangles(&fan, &mut far);
        // 300 bytes for indices, and one more for each of those that count 128 or more back: none in a fan of 100.
        assert_eq!(far.len(), 300);
    }
}
