//! VTK XML files: unstructured grids with compressed arrays, and collections of steps [VTK file formats, XML].
//!
//! Written here because the crate `vtkio` 0.6 brings a C compiler (lzma) and outdated parsers for what are 150 lines.
//! Arrays stand inline as Base64 over zlib, so that files are valid XML and every reader takes them.

use crate::math::{Matrix, Matrix2, Vector2, Vector3};
use std::fmt::Write;

/// Bytes compressed at once.
const BLOCK: usize = 1 << 18;
/// Digits of noise hardly compress, whatever the effort.
const COMPRESSION: u8 = 1;

/// Shape of all cells of a grid, by the number of the format.
#[derive(Clone, Copy, Debug)]
pub(super) enum CellType {
    Vertex = 1,
    Line = 3,
    Triangle = 5,
}

/// Cells of one shape.
pub(super) struct Cells {
    pub cell_type: CellType,
    /// Points of all cells, one after another.
    pub points: Vec<u32>,
    /// Number of points of each cell.
    pub sizes: Vec<usize>,
}

/// Named values at points or cells.
pub(super) struct Array {
    name: &'static str,
    number: &'static str,
    components: &'static [&'static str],
    bytes: Vec<u8>,
}

impl Array {
    pub fn scalars(name: &'static str, values: impl IntoIterator<Item = f64>) -> Self {
        Self::floats(name, &[""], values)
    }

    /// Vectors in the plane, with z = 0.
    pub fn vectors(name: &'static str, values: impl IntoIterator<Item = Vector2>) -> Self {
        Self::floats(name, &["x", "y", "z"], values.into_iter().flat_map(|v| [v.x, v.y, 0.0]))
    }

    /// Symmetric tensors from their part in the plane and their component normal to it.
    pub fn tensors(name: &'static str, values: impl IntoIterator<Item = (Matrix2, f64)>) -> Self {
        let components =
            values.into_iter().flat_map(|(m, zz)| [m[(0, 0)], m[(1, 1)], zz, 0.5 * (m[(0, 1)] + m[(1, 0)]), 0.0, 0.0]);
        Self::floats(name, &["xx", "yy", "zz", "xy", "yz", "xz"], components)
    }

    /// Vectors in space.
    pub fn spatial_vectors(name: &'static str, values: impl IntoIterator<Item = Vector3>) -> Self {
        Self::floats(name, &["x", "y", "z"], values.into_iter().flat_map(|v| [v.x, v.y, v.z]))
    }

    /// Symmetric tensors in space.
    pub fn spatial_tensors(name: &'static str, values: impl IntoIterator<Item = Matrix<3>>) -> Self {
        let upper = |m: Matrix<3>| [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)].map(|ij| m[ij]);
        Self::floats(name, &["xx", "yy", "zz", "xy", "yz", "xz"], values.into_iter().flat_map(upper))
    }

    /// Three numbers at each place.
    pub fn triples(
        name: &'static str,
        components: &'static [&'static str; 3],
        values: impl IntoIterator<Item = [f64; 3]>,
    ) -> Self {
        Self::floats(name, components, values.into_iter().flatten())
    }

    pub fn integers(name: &'static str, values: impl IntoIterator<Item = i64>) -> Self {
        let bytes = values.into_iter().flat_map(i64::to_le_bytes).collect();
        Self { name, number: "Int64", components: &[""], bytes }
    }

    fn floats(name: &'static str, components: &'static [&'static str], values: impl IntoIterator<Item = f64>) -> Self {
        Self { name, number: "Float64", components, bytes: values.into_iter().flat_map(f64::to_le_bytes).collect() }
    }

    fn write(&self, text: &mut String) {
        let _ = write!(text, "<DataArray type=\"{}\" Name=\"{}\"", self.number, self.name);
        if self.components.len() > 1 {
            let _ = write!(text, " NumberOfComponents=\"{}\"", self.components.len());
            for (k, name) in self.components.iter().enumerate() {
                let _ = write!(text, " ComponentName{k}=\"{name}\"");
            }
        }
        text.push_str(" format=\"binary\">");
        compress(&self.bytes, text);
        text.push_str("</DataArray>\n");
    }
}

/// An unstructured grid in the plane z = 0 (`.vtu`).
pub(super) fn grid(positions: &[Vector2], cells: &Cells, point_arrays: &[Array], cell_arrays: &[Array]) -> Vec<u8> {
    let points = Array::vectors("Points", positions.iter().copied());
    grid_of(&points, positions.len(), cells, point_arrays, cell_arrays)
}

/// An unstructured grid in space (`.vtu`).
pub(super) fn spatial_grid(
    positions: &[Vector3],
    cells: &Cells,
    point_arrays: &[Array],
    cell_arrays: &[Array],
) -> Vec<u8> {
    let points = Array::spatial_vectors("Points", positions.iter().copied());
    grid_of(&points, positions.len(), cells, point_arrays, cell_arrays)
}

fn grid_of(points: &Array, n_points: usize, cells: &Cells, point_arrays: &[Array], cell_arrays: &[Array]) -> Vec<u8> {
    let mut text = header("UnstructuredGrid", " header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\"");
    let n_cells = cells.sizes.len();
    let _ = write!(text, "<Piece NumberOfPoints=\"{n_points}\" NumberOfCells=\"{n_cells}\">\n<Points>\n");
    points.write(&mut text);
    text.push_str("</Points>\n<Cells>\n");
    Array::integers("connectivity", cells.points.iter().map(|&p| p.into())).write(&mut text);
    Array::integers("offsets", ends(&cells.sizes)).write(&mut text);
    let types = vec![cells.cell_type as u8; n_cells];
    Array { name: "types", number: "UInt8", components: &[""], bytes: types }.write(&mut text);
    text.push_str("</Cells>\n<PointData>\n");
    point_arrays.iter().for_each(|a| a.write(&mut text));
    text.push_str("</PointData>\n<CellData>\n");
    cell_arrays.iter().for_each(|a| a.write(&mut text));
    text.push_str("</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
    text.into_bytes()
}

/// Polylines in the plane z = 0 (`.vtp`); `sizes` are their numbers of points, which follow one another.
pub(super) fn lines(positions: &[Vector2], sizes: &[usize], point_arrays: &[Array], cell_arrays: &[Array]) -> Vec<u8> {
    let mut text = header("PolyData", " header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\"");
    let (n_points, n_lines) = (positions.len(), sizes.len());
    let _ = writeln!(
        text,
        "<Piece NumberOfPoints=\"{n_points}\" NumberOfVerts=\"0\" NumberOfLines=\"{n_lines}\" NumberOfStrips=\"0\" \
         NumberOfPolys=\"0\">\n<PointData>"
    );
    point_arrays.iter().for_each(|a| a.write(&mut text));
    text.push_str("</PointData>\n<CellData>\n");
    cell_arrays.iter().for_each(|a| a.write(&mut text));
    text.push_str("</CellData>\n<Points>\n");
    Array::vectors("Points", positions.iter().copied()).write(&mut text);
    text.push_str("</Points>\n<Lines>\n");
    Array::integers("connectivity", 0..n_points as i64).write(&mut text);
    Array::integers("offsets", ends(sizes)).write(&mut text);
    text.push_str("</Lines>\n</Piece>\n</PolyData>\n</VTKFile>\n");
    text.into_bytes()
}

/// Triangles in space (`.vtp`).
pub(super) fn triangles(positions: &[Vector3], corners: &[[u32; 3]], cell_arrays: &[Array]) -> Vec<u8> {
    let mut text = header("PolyData", " header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\"");
    let (n_points, n_triangles) = (positions.len(), corners.len());
    let _ = writeln!(
        text,
        "<Piece NumberOfPoints=\"{n_points}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" \
         NumberOfPolys=\"{n_triangles}\">\n<PointData>\n</PointData>\n<CellData>"
    );
    cell_arrays.iter().for_each(|a| a.write(&mut text));
    text.push_str("</CellData>\n<Points>\n");
    Array::spatial_vectors("Points", positions.iter().copied()).write(&mut text);
    text.push_str("</Points>\n<Polys>\n");
    Array::integers("connectivity", corners.iter().flatten().map(|c| i64::from(*c))).write(&mut text);
    Array::integers("offsets", ends(&vec![3; n_triangles])).write(&mut text);
    text.push_str("</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n");
    text.into_bytes()
}

/// Where each cell ends in the list of points.
fn ends(sizes: &[usize]) -> impl Iterator<Item = i64> {
    sizes.iter().scan(0, |end, &size| {
        *end += size as i64;
        Some(*end)
    })
}

/// Files by step (`.pvd`); names need no escapes.
pub(super) fn collection(files: &[(usize, String)]) -> Vec<u8> {
    let mut text = header("Collection", "");
    for (step, file) in files {
        let _ = writeln!(text, "<DataSet timestep=\"{step}\" part=\"0\" file=\"{file}\"/>");
    }
    text.push_str("</Collection>\n</VTKFile>\n");
    text.into_bytes()
}

fn header(kind: &str, attributes: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\"{attributes}>\n<{kind}>\n"
    )
}

/// The number of blocks, their size, that of the last one if it is smaller, all compressed sizes; then the blocks.
fn compress(bytes: &[u8], text: &mut String) {
    let blocks: Vec<Vec<u8>> =
        bytes.chunks(BLOCK).map(|b| miniz_oxide::deflate::compress_to_vec_zlib(b, COMPRESSION)).collect();
    let sizes = [blocks.len(), BLOCK, bytes.len() % BLOCK].into_iter().chain(blocks.iter().map(Vec::len));
    let head: Vec<u8> = sizes.flat_map(|n| (n as u64).to_le_bytes()).collect();
    push_base64(&head, text);
    push_base64(&blocks.concat(), text);
}

pub(super) fn push_base64(bytes: &[u8], text: &mut String) {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    text.reserve(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let bits = (0..3).fold(0_u32, |bits, k| bits << 8 | u32::from(group.get(k).copied().unwrap_or(0)));
        for k in 0..4 {
            let digit = DIGITS[(bits >> (18 - 6 * k)) as usize & 63];
            text.push(if k > group.len() { '=' } else { digit.into() });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_of_rfc_4648() {
        for (plain, coded) in [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")] {
            let mut text = String::new();
            push_base64(plain.as_bytes(), &mut text);
            assert_eq!(text, coded);
        }
    }
}
