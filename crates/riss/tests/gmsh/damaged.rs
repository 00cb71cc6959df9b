//! Damaged files give an error or a body, never a panic.

use crate::two_holes::{FILES, bytes};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use riss::case::gmsh::{GmshError, Place, read_gmsh};

fn read_to_the_end(bytes: &[u8]) {
    if let Ok(model) = read_gmsh(bytes) {
        let n = model.vertices.len();
        assert!(model.boundary.iter().flatten().all(|e| (e.start as usize) < n && (e.end as usize) < n));
        model.into_domain().unwrap();
    }
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: RngSeed::Fixed(41), failure_persistence: None, ..ProptestConfig::with_cases(300) })]

    #[test]
    fn changed_bytes(file in 0..FILES.len(), changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..12)) {
        let mut bytes = bytes(FILES[file]);
        for (at, value) in changes {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        read_to_the_end(&bytes);
    }

    #[test]
    fn digits_for_digits(file in 0..FILES.len(), at in any::<prop::sample::Index>(), digit in b'0'..=b'9') {
        let mut bytes = bytes(FILES[file]);
        let digits: Vec<usize> = (0..bytes.len()).filter(|&k| bytes[k].is_ascii_digit()).collect();
        bytes[digits[at.index(digits.len())]] = digit;
        read_to_the_end(&bytes);
    }

    #[test]
    fn pieces_cut_out_or_doubled(file in 0..FILES.len(), from in any::<prop::sample::Index>(), length in 1..400_usize, doubled: bool) {
        let bytes = bytes(FILES[file]);
        let from = from.index(bytes.len());
        let to = (from + length).min(bytes.len());
        let rest = if doubled { from } else { to };
        read_to_the_end(&[&bytes[..to - if doubled { 0 } else { to - from }], &bytes[rest..]].concat());
    }

    #[test]
    fn any_bytes(tail in prop::collection::vec(any::<u8>(), 0..200)) {
        read_to_the_end(&tail);
        read_to_the_end(&[b"$MeshFormat\n4.1 1 8\n\x01\0\0\0\n$EndMeshFormat\n$Entities\n", &tail[..]].concat());
    }
}

#[test]
fn truncated_files_are_errors_with_a_place() {
    for name in FILES {
        let bytes = bytes(name);
        // Complete up to the end of the last section.
        let end = bytes.len() - "$EndElements\n".len();
        for length in (0..end).step_by(97) {
            let error = read_gmsh(&bytes[..length]).unwrap_err();
            match error {
                GmshError::Content { place: Place::Line(_), .. } => {}
                GmshError::Content { place: Place::Byte(at), .. } => assert!(name.contains("binary") && at <= length),
                // Cut within the version, or between sections.
                GmshError::Version { .. } | GmshError::NoSurface => {}
                other => panic!("{name}, {length} bytes: {other}"),
            }
        }
    }
}

#[test]
fn byte_order_is_that_of_the_file() {
    // Only the format section: a big-endian file without content has no surface.
    let big = b"$MeshFormat\n4.1 1 8\n\0\0\0\x01\n$EndMeshFormat\n";
    assert_eq!(read_gmsh(big), Err(GmshError::NoSurface));
}
