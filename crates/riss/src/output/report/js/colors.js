// Color maps: `sequential(stops)`, `diverging`, each with a table of 256 colors for pixels and a gradient for the legend.

// RdBu of ColorBrewer, blue for negative values: both arms are even in brightness.
const RED_BLUE = [
  [5, 48, 97], [33, 102, 172], [67, 147, 195], [146, 197, 222], [209, 229, 240], [247, 247, 247],
  [253, 219, 199], [244, 165, 130], [214, 96, 77], [178, 24, 43], [103, 0, 31],
];
const N_COLORS = 256;
const N_BANDS = 12;

/** The color at a place between 0 and 1. */
function colorAt(stops, place) {
  const at = Math.min(Math.max(place, 0), 1) * (stops.length - 1);
  const k = Math.min(Math.floor(at), stops.length - 2);
  return stops[k].map((c, i) => Math.round(c + (at - k) * (stops[k + 1][i] - c)));
}

/** Places of the colors of bands, or of a smooth scale. */
const places = (bands) => (bands ? N_BANDS : N_COLORS);

/** 256 pixels, as the bytes of an image lie in memory on all machines that have browsers: least byte first. */
function pixelTable(stops, bands) {
  const n = places(bands);
  return Uint32Array.from({ length: N_COLORS }, (_, k) => {
    const place = bands ? (Math.floor((k * n) / N_COLORS) + 0.5) / n : k / (N_COLORS - 1);
    const [r, g, b] = colorAt(stops, place);
    return ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;
  });
}

/** For the style of the legend. */
function gradient(stops, bands, direction) {
  const css = ([r, g, b]) => `rgb(${r} ${g} ${b})`;
  if (!bands) return `linear-gradient(${direction}, ${stops.map(css).join(", ")})`;
  const parts = Array.from({ length: N_BANDS }, (_, k) => {
    const color = css(colorAt(stops, (k + 0.5) / N_BANDS));
    return `${color} ${(100 * k) / N_BANDS}% ${(100 * (k + 1)) / N_BANDS}%`;
  });
  return `linear-gradient(${direction}, ${parts.join(", ")})`;
}
