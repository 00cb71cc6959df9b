//! Help, completions, the manual, the gallery and colors, as their users see them.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn riss(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_riss")).args(arguments).current_dir(folder).output().expect("riss runs")
}

fn stdout(folder: &Path, arguments: &[&str]) -> String {
    let output = riss(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// A fresh folder for one test.
fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("made");
    folder
}

/// All commands, as `riss --help` lists them.
fn commands(folder: &Path) -> Vec<String> {
    let help = stdout(folder, &["--help"]);
    let lines = help.lines().skip_while(|l| *l != "Commands:").skip(1).take_while(|l| !l.is_empty());
    lines.filter_map(|l| l.split_whitespace().next()).filter(|c| *c != "help").map(String::from).collect()
}

#[test]
fn every_command_has_help_with_examples_that_name_it() {
    let folder = scratch("examples");
    let commands = commands(&folder);
    assert!(commands.len() >= 11, "{commands:?}");
    for command in commands {
        let help = stdout(&folder, &[&command, "--help"]);
        let examples = help.split("Example").nth(1).unwrap_or_else(|| panic!("{command} has no example"));
        assert!(examples.contains(&format!("riss {command}")), "{command}: {examples}");
    }
}

#[test]
fn the_examples_of_every_command_are_understood() {
    let folder = scratch("understood");
    for command in commands(&folder) {
        let help = stdout(&folder, &[&command, "--help"]);
        let start = help.find("Example").expect("checked elsewhere");
        for example in help[start..].lines().filter_map(|l| l.split_once("riss ")).map(|l| l.1) {
            // What a shell does: no redirection, no quotes.
            let plain = example.split(['>', '|']).next().unwrap_or("").replace('\'', "");
            let words: Vec<&str> = plain.split_whitespace().collect();
            let output = riss(&folder, &words);
            let message = String::from_utf8_lossy(&output.stderr);
            // The files are not there, but the words are known.
            assert!(!message.contains("Usage:"), "riss {example}: {message}");
        }
    }
}

#[test]
fn shells_complete_every_command() {
    let folder = scratch("completions");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = stdout(&folder, &["completions", shell]);
        for command in commands(&folder) {
            assert!(script.contains(&command), "{shell} does not know {command}");
        }
    }
    assert_eq!(riss(&folder, &["completions", "cmd"]).status.code(), Some(2));
}

#[test]
fn the_manual_has_a_page_for_every_command() {
    let folder = scratch("manual");
    let page = stdout(&folder, &["man"]);
    assert!(page.contains(".TH riss 1") && page.contains("Exit codes"), "{page}");
    stdout(&folder, &["man", "pages"]);
    for command in commands(&folder) {
        let page = std::fs::read_to_string(folder.join(format!("pages/riss-{command}.1"))).expect("a page");
        assert!(page.contains("Example"), "{command}");
    }
}

#[test]
fn the_gallery_is_listed_and_copied() {
    let folder = scratch("gallery");
    let list = stdout(&folder, &["cases"]);
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let n = std::fs::read_dir(&root).expect("the cases").count();
    assert_eq!(list.lines().count(), n, "{list}");
    assert!(list.lines().any(|l| l.starts_with("crack-near-hole ") && l.ends_with("Edge crack close to a hole")));
    assert!(stdout(&folder, &["cases", "near-hole"]).starts_with("crack-near-hole "));
    let said = stdout(&folder, &["cases", "gmsh-two-holes", "mine"]);
    assert!(said.contains("riss run mine/case.toml"), "{said}");
    for file in ["case.toml", "README.md", "plate.msh"] {
        let copied = std::fs::read(folder.join("mine").join(file)).expect("copied");
        assert_eq!(copied, std::fs::read(root.join("gmsh-two-holes").join(file)).expect("there"), "{file}");
    }
    assert!(!folder.join("mine/expected.json").exists());
    stdout(&folder, &["check", "mine/case.toml"]);
    let again = riss(&folder, &["cases", "gmsh-two-holes", "mine"]);
    assert_eq!(again.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&again.stderr).contains("is left as it is"));
    assert_eq!(riss(&folder, &["cases", "nowhere"]).status.code(), Some(2));
}

#[test]
fn every_case_of_the_gallery_can_be_copied_and_checked() {
    let folder = scratch("whole-gallery");
    for line in stdout(&folder, &["cases"]).lines() {
        let name = line.split_whitespace().next().expect("a name");
        stdout(&folder, &["cases", name]);
        let text = std::fs::read_to_string(folder.join(name).join("case.toml")).expect("copied");
        // All files that the case names came along.
        riss::case::AnyCase::parse(&text, &folder.join(name).join("case.toml"), &[])
            .unwrap_or_else(|errors| panic!("{name}: {errors}"));
    }
}

#[test]
fn what_is_no_terminal_gets_no_colors() {
    let folder = scratch("colors");
    std::fs::write(folder.join("bad.toml"), "rigid_motion = 5\n").expect("written");
    for arguments in [&["check", "bad.toml"][..], &["--help"], &["walk"], &["run"]] {
        let output = riss(&folder, arguments);
        let all = [output.stdout, output.stderr].concat();
        assert!(!all.contains(&0x1b), "{arguments:?}");
    }
}

/// What a command shows on a terminal, which `script` plays.
#[cfg(target_os = "linux")]
fn on_terminal(folder: &Path, arguments: &str, no_color: Option<&str>) -> Option<Vec<u8>> {
    let mut command = Command::new("script");
    command.args(["-qec", &format!("{} {arguments}", env!("CARGO_BIN_EXE_riss")), "/dev/null"]).current_dir(folder);
    command.env_remove("NO_COLOR").env("TERM", "xterm-256color");
    no_color.map(|v| command.env("NO_COLOR", v));
    command.output().ok().map(|o| o.stdout)
}

#[test]
#[cfg(target_os = "linux")]
fn a_terminal_gets_colors_unless_no_color_is_set() {
    let folder = scratch("terminal");
    std::fs::write(folder.join("bad.toml"), "rigid_motion = 5\n").expect("written");
    for arguments in ["check bad.toml", "walk"] {
        // Where there is no `script`, the unit test of the messages has to do.
        let Some(colored) = on_terminal(&folder, arguments, None) else { return };
        assert!(colored.windows(2).any(|w| w == b"\x1b["), "{arguments}");
        let plain = on_terminal(&folder, arguments, Some("1")).expect("a terminal again");
        let text = String::from_utf8_lossy(&plain);
        assert!(!plain.contains(&0x1b) && (text.contains("rigid_motion") || text.contains("walk")), "{text}");
    }
}
