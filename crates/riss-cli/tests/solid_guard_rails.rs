//! Results of solids that linear elastic fracture mechanics or the nodes do not carry: what is said of them, and where.

use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// A crack through a block from its left side, 1.5 of 4 deep; nothing is wrong with it.
struct Block {
    yield_stress: &'static str,
    loads: &'static str,
    crack: &'static str,
    nodes: &'static str,
    more: &'static str,
}

const EDGE: &str = "polygon = [[-1, -1, 2], [1.5, -1, 2], [1.5, 3, 2], [-1, 3, 2]]";
const SOUND: Block = Block {
    yield_stress: "",
    loads: "remote_stress.zz = 1",
    crack: EDGE,
    nodes: "nodes = { spacing = 0.5, front_spacing = 0.25 }",
    more: "",
};

impl Block {
    fn text(&self) -> String {
        format!(
            "method = \"collocation\"\nrigid_motion = \"mean-is-zero\"\n{}\n{}\nfracture.points = 3\n\
             geometry.box = {{ lower = [0, 0, 0], upper = [4, 2, 4] }}\n\n[material]\nyoung = 1000\npoisson = 0.3\n{}\n\n\
             [[crack]]\nname = \"flaw\"\n{}\n{}",
            self.loads, self.nodes, self.yield_stress, self.crack, self.more
        )
    }

    /// What is said when it is run: the lines on the terminal, which `results.json` and the report must hold too.
    fn said(&self, name: &str) -> Vec<String> {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("solid-guard-rails").join(name);
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).expect("made");
        std::fs::write(folder.join("case.toml"), self.text()).expect("written");
        let mut riss = Command::new(env!("CARGO_BIN_EXE_riss"));
        let run = riss.args(["run", "case.toml", "--out", "out"]).current_dir(&folder).output().expect("riss runs");
        assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
        let text = String::from_utf8_lossy(&run.stdout).into_owned();
        let said: Vec<String> = text.lines().filter_map(|l| Some(l.strip_prefix("warning: ")?.into())).collect();
        let results = std::fs::read_to_string(folder.join("out/results.json")).expect("results are written");
        let results: Value = serde_json::from_str(&results).expect("JSON");
        let kept: Vec<&str> = results["warnings"].as_array().unwrap().iter().map(|w| w.as_str().unwrap()).collect();
        assert_eq!(said.len(), kept.len(), "{said:?}\n{kept:?}");
        assert!(said.iter().zip(&kept).all(|(s, k)| s.ends_with(k)), "{said:?}");
        let report = std::fs::read_to_string(folder.join("out/report.html")).expect("a report is written");
        assert_eq!(report.contains("<h2>Warnings</h2>"), !kept.is_empty());
        said
    }

    fn line_of(&self, text: &str) -> usize {
        1 + self.text().lines().position(|l| l.starts_with(text)).expect("a line of the case")
    }
}

/// That one thing is said, at a line, with words in it.
fn check_one(block: &Block, name: &str, line: &str, words: &[&str]) {
    let said = block.said(name);
    assert_eq!(said.len(), 1, "{said:?}");
    let place = format!("case.toml:{}:", block.line_of(line));
    assert!(said[0].starts_with(&place), "{place}\n{said:?}");
    words.iter().for_each(|w| assert!(said[0].contains(w), "{w}\n{said:?}"));
}

#[test]
fn nothing_is_said_of_a_sound_block() {
    assert_eq!(SOUND.said("sound"), Vec::<String>::new());
    // `K_I` is about 2.1 √(π a), so that 1.27 (K_I / 10)² is 0.27, less than the depth of the crack.
    let strong = Block { yield_stress: "yield_stress = 10", ..SOUND };
    assert_eq!(strong.said("strong"), Vec::<String>::new());
}

#[test]
fn plastic_zones_as_large_as_the_crack_are_told() {
    // The same as above, 100 times as large.
    let soft = Block { yield_stress: "yield_stress = 1", ..SOUND };
    // The polygon, also where it is outside, is as long as what is left ahead: 2.5 of 4.
    let words = ["front of flaw at (1.5000, ", "linear elastic fracture mechanics is doubtful: the ", "lower the load"];
    check_one(&soft, "plastic", "[[crack]]", &words);
}

#[test]
fn faces_that_overlap_are_told() {
    let pressed = Block { loads: "remote_stress.zz = -1", ..SOUND };
    check_one(
        &pressed,
        "pressed",
        "[[crack]]",
        &["the faces of flaw overlap", "negative at 3 of 3 points", "no contact yet"],
    );
}

#[test]
fn fronts_without_room_for_a_domain_are_told() {
    let near = Block { crack: "disc = { center = [3.55, 1, 2], normal = [0, 0, 1], radius = 0.4 }", ..SOUND };
    let said = near.said("near");
    let place = format!("case.toml:{}:", near.line_of("[[crack]]"));
    assert!(said.iter().all(|s| s.starts_with(&place)), "{said:?}");
    assert!(
        said.iter().any(|s| s.contains("no domain for K fits around") && s.contains("nodes.front_spacing")),
        "{said:?}"
    );
    // A radius of 0.4 and a ligament of 0.05 are less than four spacings of 0.25.
    assert!(said.iter().any(|s| s.contains("node spacings over the ligament ahead")), "{said:?}");
}

#[test]
fn voids_with_few_nodes_are_told() {
    let hollow = Block { more: "\n[[void]]\nname = \"pore\"\nball = { center = [3, 1, 2], radius = 0.1 }\n", ..SOUND };
    // 4π 0.1² / 0.0625² nodes: on its wall an eighth of the largest spacing, and no less.
    check_one(&hollow, "pore", "nodes = ", &["nodes stand on the void `pore`", "[[nodes.finer]]"]);
}

#[test]
fn loads_out_of_balance_are_told() {
    let pulled = Block { loads: "load = [{ on = \"z-max\", traction = [0, 0, 1] }]", ..SOUND };
    check_one(&pulled, "pulled", "rigid_motion", &["out of balance by 100 %", "add supports"]);
}
