//! Results that linear elastic fracture mechanics or the nodes do not carry: what is said of them, and where.

use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// What stands in a case for every value that a test changes.
struct Plate {
    material: &'static str,
    crack: &'static str,
    stress: f64,
    more: &'static str,
}

/// `K_I` is `σ √(π a) sqrt(sec(π a / 20))`, 1.78 for `a = 1` [Tada, section 2.1].
const SOUND: Plate = Plate { material: "plane = \"strain\"", crack: "path = [[-1, 0], [1, 0]]", stress: 1.0, more: "" };

impl Plate {
    fn text(&self) -> String {
        format!(
            "rigid_motion = \"mean-is-zero\"\nremote_stress = {{ yy = {} }}\n\n[material]\nyoung = 1e3\npoisson = 0.3\n\
             {}\n\n[geometry.rectangle]\nlower = [-10, -20]\nupper = [10, 20]\n\n[[crack]]\n{}\n{}",
            self.stress, self.material, self.crack, self.more
        )
    }

    /// What is said when it is run: the lines on the terminal, which `results.json` must hold too.
    fn said(&self, name: &str) -> Vec<String> {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("guard-rails").join(name);
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).expect("made");
        std::fs::write(folder.join("case.toml"), self.text()).expect("written");
        let mut riss = Command::new(env!("CARGO_BIN_EXE_riss"));
        let run = riss.args(["run", "case.toml", "--out", "out"]).current_dir(&folder).output().expect("riss runs");
        let text = String::from_utf8_lossy(&run.stdout).into_owned();
        let said: Vec<String> = text.lines().filter_map(|l| Some(l.strip_prefix("warning: ")?.into())).collect();
        let results = std::fs::read_to_string(folder.join("out/results.json")).expect("results are written");
        let results: Value = serde_json::from_str(&results).expect("JSON");
        let kept: Vec<&str> = results["warnings"].as_array().unwrap().iter().map(|w| w.as_str().unwrap()).collect();
        assert_eq!(said.len(), kept.len(), "{said:?}\n{kept:?}");
        assert!(said.iter().zip(kept).all(|(s, k)| s.ends_with(k)), "{said:?}");
        said
    }

    fn line_of(&self, text: &str) -> usize {
        1 + self.text().lines().position(|l| l.starts_with(text)).expect("a line of the case")
    }
}

/// That one thing is said, at a line, with words in it.
fn check_one(plate: &Plate, name: &str, line: &str, words: &[&str]) {
    let said = plate.said(name);
    assert_eq!(said.len(), 1, "{said:?}");
    let place = format!("case.toml:{}:", plate.line_of(line));
    assert!(said[0].starts_with(&place), "{place}\n{said:?}");
    words.iter().for_each(|w| assert!(said[0].contains(w), "{w}\n{said:?}"));
}

#[test]
fn nothing_is_said_of_a_sound_body() {
    assert_eq!(SOUND.said("sound"), Vec::<String>::new());
}

/// `4/π (K/σ_Y)²` is 1.0 for a yield stress of 2.0, the length of the crack.
#[test]
fn a_plastic_zone_as_large_as_the_crack_is_seen() {
    let doubtful = Plate { material: "plane = \"strain\"\nyield_stress = 1.9", ..SOUND };
    check_one(&doubtful, "plastic", "[[crack]]", &["crack is 1.0000 long", "(4/pi) (K/yield_stress)^2"]);
    let sound = Plate { material: "plane = \"strain\"\nyield_stress = 2.1", ..SOUND };
    assert_eq!(sound.said("elastic"), Vec::<String>::new());
}

/// 2.5 (K/σ_Y)² is 0.079 for a yield stress of 10.
#[test]
fn a_plane_state_that_the_thickness_denies_is_seen() {
    let thin = Plate { material: "plane = \"strain\"\nthickness = 0.07\nyield_stress = 10", ..SOUND };
    check_one(&thin, "thin", "plane", &["thickness 0.0700", "plane = \"stress\""]);
    let thick = Plate { material: "plane = \"stress\"\nthickness = 30\nyield_stress = 10", ..SOUND };
    check_one(&thick, "thick", "plane", &["thickness 30.0000", "plane = \"strain\""]);
    for (name, material) in [
        ("thick-strain", "plane = \"strain\"\nthickness = 0.09\nyield_stress = 10"),
        ("thin-stress", "plane = \"stress\"\nthickness = 0.09\nyield_stress = 10"),
    ] {
        assert_eq!(Plate { material, ..SOUND }.said(name), Vec::<String>::new());
    }
}

#[test]
fn a_body_beyond_yield_is_seen() {
    let yielding = Plate { material: "plane = \"stress\"\nyield_stress = 0.9", ..SOUND };
    let said = yielding.said("yielding");
    let place = format!("case.toml:{}:", yielding.line_of("yield_stress"));
    assert!(said.iter().any(|s| s.starts_with(&place) && s.contains("beyond the yield stress 0.9")), "{said:?}");
}

#[test]
fn faces_that_pass_through_each_other_are_seen() {
    let pressed = Plate { stress: -1.0, ..SOUND };
    check_one(&pressed, "pressed", "[[crack]]", &["overlap along about", "[contact]"]);
    let held = Plate { stress: -1.0, more: "\n[contact]\n", ..SOUND };
    assert_eq!(held.said("held"), Vec::<String>::new());
}

#[test]
fn too_few_nodes_over_a_ligament_are_seen() {
    let narrow = Plate {
        crack: "path = [[-1, 0], [9.8, 0]]",
        more: "\n[nodes.layout.graded]\nspacing = 0.5\ntip_spacing = 0.1\n",
        ..SOUND
    };
    check_one(&narrow, "narrow", "[[crack]]", &["node spacings between the tip", "smaller nodes spacing"]);
}

#[test]
fn too_few_nodes_around_a_hole_are_seen() {
    let more =
        "\n[[hole]]\ncircle = { center = [5, 10], radius = 0.3 }\n\n[nodes.layout.structured]\nnx = 41\nny = 81\n";
    let coarse = Plate { more, ..SOUND };
    check_one(&coarse, "hole", "[[hole]]", &["nodes stand on the hole", "16 are the least"]);
}

/// It turns by 35 degrees, and by 27 in the next step.
#[test]
fn turns_too_sharp_for_the_increment_are_said_once() {
    let more = "\n[growth]\nincrement = 1.5\nsteps = 3\n\n[[hole]]\ncircle = { center = [3.4, 1.4], radius = 1 }\n";
    let bent = Plate { more, ..SOUND };
    let said = bent.said("turn");
    let turns: Vec<_> = said.iter().filter(|s| s.contains("degrees within one increment of 1.5")).collect();
    assert_eq!(turns.len(), 1, "{said:?}");
    assert!(turns[0].starts_with(&format!("case.toml:{}:", bent.line_of("increment"))), "{turns:?}");
}
