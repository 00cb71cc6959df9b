//! The color map viridis: even in brightness, readable in gray and for the color-blind [Smith and van der Walt].

/// Colors at equal steps of the value.
const VIRIDIS: [[f64; 3]; 11] = [
    [68., 1., 84.],
    [72., 36., 117.],
    [65., 68., 135.],
    [53., 95., 141.],
    [42., 120., 142.],
    [33., 145., 140.],
    [34., 168., 132.],
    [68., 191., 112.],
    [122., 209., 81.],
    [189., 223., 38.],
    [253., 231., 37.],
];

/// Color of a value between 0 and 1.
pub(super) fn viridis(value: f64) -> String {
    shaded_viridis(value, 1.0)
}

/// The same, darker by a factor.
pub(super) fn shaded_viridis(value: f64, brightness: f64) -> String {
    let at = value.clamp(0.0, 1.0) * 10.0;
    let k = (at as usize).min(9);
    let [r, g, b] = [0, 1, 2]
        .map(|c| (brightness * (VIRIDIS[k][c] + (at - k as f64) * (VIRIDIS[k + 1][c] - VIRIDIS[k][c]))).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}
