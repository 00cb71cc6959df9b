//! Small meshes written by hand: names, merging, and every refusal.

use riss::case::gmsh::{GmshError, Place, read_gmsh};

/// Version 2.2 from `tag x y z` and `tag type tags… nodes…` lines.
fn msh2(names: &str, nodes: &[&str], elements: &[&str]) -> String {
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n{names}$Nodes\n{}\n{}\n$EndNodes\n$Elements\n{}\n{}\n$EndElements\n",
        nodes.len(),
        nodes.join("\n"),
        elements.len(),
        elements.join("\n")
    )
}

/// Corners and middle of the unit square.
const SQUARE: [&str; 6] = ["1 0 0 0", "2 1 0 0", "30 1 1 0", "4 0 1 0", "5 0.5 0.5 0", "99 7 7 7"];
/// Four triangles, one of them clockwise.
const FAN: [&str; 4] = ["1 2 2 0 1 1 2 5", "2 2 2 0 1 5 30 2", "3 2 2 0 1 30 4 5", "4 2 2 0 1 4 1 5"];

fn error(text: &str) -> GmshError {
    read_gmsh(text.as_bytes()).unwrap_err()
}

fn check_error(text: &str, message: &str) {
    let error = error(text).to_string();
    assert!(error.contains(message), "`{error}` does not say `{message}`");
}

#[test]
fn groups_become_parts_and_unused_nodes_vanish() {
    let lines = ["5 1 2 7 1 1 2", "6 1 2 8 1 2 30", "7 1 2 9 1 2 30", "8 1 2 9 1 30 4", "9 1 2 5 1 5 30"];
    let names = "$PhysicalNames\n2\n1 8 \"right side\"\n1 9 \"far\"\n$EndPhysicalNames\n";
    let text = msh2(names, &SQUARE, &[&FAN[..], &lines[..]].concat());
    let model = read_gmsh(text.as_bytes()).unwrap();
    assert_eq!((model.vertices.len(), model.triangles.len()), (5, 4));
    let domain = model.into_domain().unwrap();
    let parts: Vec<_> = domain.parts.iter().map(|p| (p.name.as_str(), p.edges.clone())).collect();
    // The group 5 lies inside the body.
    assert_eq!(parts, [("physical-7", vec![0]), ("right side", vec![1]), ("far", vec![1, 2])]);
    assert_eq!((domain.edges.len(), domain.area()), (4, 1.0));
}

#[test]
fn collinear_edges_merge_only_within_one_part() {
    let nodes = ["1 0 0 0", "2 1 0 0", "3 2 0 0", "4 2 1 0", "5 1 1 0", "6 0 1 0"];
    let cells = ["1 3 2 0 1 1 2 5 6", "2 3 2 0 1 2 3 4 5"];
    let edges = |lines: &[&str]| {
        let text = msh2("", &nodes, &[&cells, lines].concat());
        read_gmsh(text.as_bytes()).unwrap().into_domain().unwrap().edges.len()
    };
    assert_eq!(edges(&[]), 4);
    assert_eq!(edges(&["3 1 2 1 1 1 2", "4 1 2 1 1 2 3"]), 4);
    assert_eq!(edges(&["3 1 2 1 1 1 2"]), 5);
    assert_eq!(edges(&["3 1 2 1 1 1 2", "4 1 2 2 1 2 3"]), 5);
}

#[test]
fn a_surface_in_two_groups_counts_once() {
    let twice = [&FAN[..], &["11 2 2 3 1 1 2 5"]].concat();
    assert_eq!(read_gmsh(msh2("", &SQUARE, &twice).as_bytes()).unwrap().triangles.len(), 4);
}

#[test]
fn format_errors_name_the_line() {
    let good = msh2("", &SQUARE, &FAN);
    assert_eq!(
        error(&good.replace("30 1 1 0", "30 1 one 0")),
        GmshError::Content { place: Place::Line(8), section: "Nodes".into(), problem: "`one` is not y".into() }
    );
    check_error("solid", "line 1: not a Gmsh mesh");
    check_error("", "the file ends where $MeshFormat is due");
    check_error(&good.replace("2.2", "4.0"), "MSH version 4.0; versions 2.2 and 4.1 can be read");
    check_error(&good.replace("2.2 0 8", "2.2 0 4"), "numbers of 4 bytes");
    check_error(&good.replace("$Nodes\n6", "$Nodes\n60000000000"), "60000000000 nodes are announced, but only");
    check_error(&good.replace("$Nodes\n6", "$Nodes\n5"), "line 11, section Nodes: `99` stands where $EndNodes is due");
    check_error(&good.replace("$EndNodes\n", ""), "section Nodes: `$Elements` stands where $EndNodes");
    check_error(&good.replace("2 1 0 0", "2 inf 0 0"), "x is inf, not a finite number");
    check_error(&good.replace("4 0 1 0", "2 0 1 0"), "line 9, section Nodes: node 2 is there twice");
    check_error(&good.replace("5 30 2", "5 30 3"), "line 16, section Elements: node 3 is missing");
    check_error(&good.replace("1 2 2 0 1 1 2 5", "1 4 2 0 1 1 2 5 4"), "element type 4 is a solid");
    check_error(&good.replace("1 2 2 0 1 1 2 5", "1 21 2 0 1 1 2 5 4"), "element type 21 is not known");
    check_error(&(good.clone() + "$Odd\n1 2"), "section Odd: $EndOdd is missing");
    check_error(&(good + "odd"), "`odd` stands where a section such as $Nodes is due");
}

#[test]
fn meshes_that_are_no_body_are_refused() {
    let line = "1 1 2 1 1 1 2";
    check_error(&msh2("", &SQUARE, &[line]), "no triangles or quadrilaterals");
    let bent = ["1 0 0 0", "2 1 0 0", "30 1 1 0", "4 0 1 0.1", "5 0.5 0.5 0"];
    check_error(&msh2("", &bent, &FAN), "line 9, section Nodes: the mesh is not plane: node 4 has z = 0.1");
    check_error(&msh2("", &SQUARE, &["1 2 2 0 1 1 30 5"]), "line 15, section Elements: the cell at (0, 0) has no area");
    check_error(&msh2("", &SQUARE, &[FAN[0], "2 2 2 0 1 1 2 30"]), "the cell at (0, 0) overlaps another");
    check_error(&msh2("", &SQUARE, &[FAN[0], FAN[2]]), "touches itself at (0.5, 0.5)");
    let apart = ["1 0 0 0", "2 1 0 0", "3 0 1 0", "4 5 0 0", "5 6 0 0", "6 5 1 0"];
    let two = ["1 2 2 0 1 1 2 3", "2 2 2 0 1 4 5 6"];
    check_error(&msh2("", &apart, &two), "falls into 2 pieces, one of them at (5, 0)");
}

#[test]
fn a_mesh_cut_along_a_crack_is_refused() {
    // A square of 4 x 4 cells whose middle row is cut between x = 1 and x = 3: node 112 doubles node 12.
    let mut nodes = vec!["112 2 2 0".to_string()];
    let mut cells = vec![];
    for row in 0..5 {
        for column in 0..5 {
            nodes.push(format!("{} {column} {row} 0", 5 * row + column));
        }
    }
    for row in 0..4 {
        for column in 0..4 {
            let corners = [5 * row + column, 5 * row + column + 1, 5 * row + column + 6, 5 * row + column + 5];
            let corners = corners.map(|n| if n == 12 && row == 2 { 112 } else { n });
            cells.push(format!("{} 3 2 0 1 {}", cells.len() + 1, corners.map(|n| n.to_string()).join(" ")));
        }
    }
    let view = |list: &'_ [String]| list.iter().map(|s| s.clone().leak() as &str).collect::<Vec<_>>();
    check_error(&msh2("", &view(&nodes), &view(&cells)), "cut open at (1, 2); leave cracks out of the mesh");
}
