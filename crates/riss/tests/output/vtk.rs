//! Files for ParaView, decoded again. VTK itself and meshio read the same files (checked by hand with VTK 9.7).

use crate::sample;
use riss::analysis::StaticResult;
use riss::output::{OutputOptions, write_results};
use std::collections::BTreeMap;

/// Arrays of a grid by name, as numbers.
pub fn arrays(text: &str) -> BTreeMap<String, Vec<f64>> {
    let attribute = |tag: &str, name: &str| {
        let start = tag.find(&format!(" {name}=\"")).unwrap() + name.len() + 3;
        tag[start..].split('"').next().unwrap().to_string()
    };
    let mut arrays = BTreeMap::new();
    for piece in text.split("<DataArray").skip(1) {
        let (tag, rest) = piece.split_once('>').unwrap();
        let bytes = decompress(rest.split('<').next().unwrap());
        let numbers = match attribute(tag, "type").as_str() {
            "Float64" => bytes.chunks(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect(),
            "Int64" => bytes.chunks(8).map(|b| i64::from_le_bytes(b.try_into().unwrap()) as f64).collect(),
            "UInt8" => bytes.iter().map(|&b| b.into()).collect(),
            other => panic!("type {other}"),
        };
        arrays.insert(attribute(tag, "Name"), numbers);
    }
    arrays
}

/// Header in Base64 on its own, then all blocks.
fn decompress(text: &str) -> Vec<u8> {
    let number = |bytes: &[u8], k: usize| u64::from_le_bytes(bytes[8 * k..8 * k + 8].try_into().unwrap()) as usize;
    let n_blocks = number(&decode(&text[..32]), 0);
    let head_length = (24 + 8 * n_blocks).div_ceil(3) * 4;
    let head = decode(&text[..head_length]);
    let body = decode(&text[head_length..]);
    let (mut at, mut bytes) = (0, vec![]);
    for k in 0..n_blocks {
        let block = miniz_oxide::inflate::decompress_to_vec_zlib(&body[at..at + number(&head, 3 + k)]).unwrap();
        let full = k + 1 < n_blocks || number(&head, 2) == 0;
        assert_eq!(block.len(), number(&head, if full { 1 } else { 2 }));
        at += number(&head, 3 + k);
        bytes.extend(block);
    }
    assert_eq!(at, body.len());
    bytes
}

fn decode(text: &str) -> Vec<u8> {
    let digit = |c: u8| match c {
        b'A'..=b'Z' => c - b'A',
        b'a'..=b'z' => c - b'a' + 26,
        b'0'..=b'9' => c - b'0' + 52,
        b'+' => 62,
        b'/' => 63,
        b'=' => 0,
        _ => panic!("`{}` in Base64", c as char),
    };
    let mut bytes = vec![];
    for group in text.as_bytes().chunks(4) {
        let bits = group.iter().fold(0_u32, |bits, &c| bits << 6 | u32::from(digit(c)));
        let padding = group.iter().filter(|&&c| c == b'=').count();
        bytes.extend(&bits.to_be_bytes()[1..4 - padding]);
    }
    bytes
}

fn files(result: &StaticResult) -> BTreeMap<String, String> {
    let dir = tempfile::tempdir().unwrap();
    let options = OutputOptions { fields: true, nodes: true, integration_points: true };
    let paths = write_results(dir.path(), &sample::info(), result, &options).unwrap();
    let name = |p: &std::path::Path| p.file_name().unwrap().to_str().unwrap().to_string();
    paths.iter().map(|p| (name(p), std::fs::read_to_string(p).unwrap())).collect()
}

#[test]
fn body_has_every_field_at_every_vertex() {
    let result = sample::result(60);
    let fields = &result.fields;
    let n = fields.positions.len();
    // More than one compressed block.
    assert!(48 * n > 1 << 18);
    let arrays = arrays(&files(&result)["fields_0000.vtu"]);
    assert_eq!(arrays["connectivity"], fields.triangles.concat().iter().map(|&v| v.into()).collect::<Vec<f64>>());
    assert_eq!(arrays["offsets"].last(), Some(&(3.0 * fields.triangles.len() as f64)));
    assert!(arrays["types"].iter().all(|&t| t == 5.0));
    for v in (0..n).step_by(37) {
        let (u, s, e) = (fields.displacement[v], fields.stress[v], fields.strain[v]);
        assert_eq!(arrays["displacement"][3 * v..3 * v + 3], [u.x, u.y, 0.0]);
        let six = |m: riss::math::Matrix2, zz| [m[(0, 0)], m[(1, 1)], zz, 0.5 * (m[(0, 1)] + m[(1, 0)]), 0.0, 0.0];
        assert_eq!(arrays["stress"][6 * v..6 * v + 6], six(s, fields.out_of_plane_stress[v]));
        assert_eq!(arrays["strain"][6 * v..6 * v + 6], six(e, fields.out_of_plane_strain[v]));
        let (most, least) = (arrays["max_principal_stress"][v], arrays["min_principal_stress"][v]);
        let d = &arrays["max_principal_direction"][3 * v..3 * v + 2];
        let d = riss::math::Vector2::new(d[0], d[1]);
        assert!((s * d - d * most).norm() < 1e-12 * (1.0 + s.norm()));
        assert!((most + least - s.trace()).abs() < 1e-12 * (1.0 + s.norm()));
    }
    assert_eq!(arrays["von_mises"], fields.von_mises);
    assert_eq!(arrays["error_indicator"], fields.error_indicator);
}

#[test]
fn crack_faces_open() {
    let result = sample::result(2);
    let arrays = arrays(&files(&result)["cracks_0000.vtu"]);
    let n = result.fields.crack_faces[0].positions.len();
    assert_eq!(arrays["offsets"].len(), 2 * (n - 1));
    assert_eq!((arrays["face"][0], arrays["face"][n - 1]), (1.0, -1.0));
    assert_eq!(arrays["connectivity"][2 * (n - 1)..2 * n], [n as f64, n as f64 + 1.0]);
    let u = &arrays["displacement"];
    for k in 0..n {
        let jump = u[3 * k + 1] - u[3 * (n + k) + 1];
        assert_eq!(arrays["normal_opening"][k], jump);
        assert_eq!(arrays["opening"][3 * (n + k) + 1], jump);
        assert_eq!(jump > 1e-3, k + 1 < n, "open except at the tip");
    }
}

#[test]
fn nodes_and_integration_points_on_request() {
    let files = files(&sample::result(2));
    assert_eq!(arrays(&files["integration_points_0000.vtu"])["integration_weight"], [0.75, 0.5]);
    assert!(arrays(&files["nodes_0000.vtu"])["support_radius"].iter().all(|&r| r == 0.5));
    assert!(files["nodes.pvd"].contains("<DataSet timestep=\"0\" part=\"0\" file=\"nodes_0000.vtu\"/>"));
}

#[test]
fn empty_fields_are_files_too() {
    let mut result = sample::result(2);
    result.fields = Default::default();
    result.nodes.clear();
    let files = files(&result);
    assert!(arrays(&files["fields_0000.vtu"])["stress"].is_empty());
    assert!(!files.contains_key("cracks.pvd"));
}
