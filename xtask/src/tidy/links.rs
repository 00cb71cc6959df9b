//! No relative link of a page leads nowhere.

use super::Findings;
use std::path::{Path, PathBuf};

/// Checks all pages of the book, and those at the root.
pub fn check(root: &Path, findings: &mut Findings) {
    let mut pages = vec![];
    collect(&root.join("docs/src"), &mut pages);
    pages.extend(["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"].map(|name| root.join(name)));
    for page in pages {
        let Ok(text) = std::fs::read_to_string(&page) else { continue };
        let name = page.strip_prefix(root).unwrap_or(&page).to_path_buf();
        let folder = page.parent().unwrap_or(root);
        for (line, target) in links(&text) {
            if let Some(reason) = dead(&target, &page, folder) {
                findings.error(&name, line, format!("the link `{target}` leads nowhere: {reason}"));
            }
        }
    }
}

fn collect(folder: &Path, pages: &mut Vec<PathBuf>) {
    let entries = std::fs::read_dir(folder).map(|e| e.flatten().map(|e| e.path()).collect::<Vec<_>>());
    for path in entries.unwrap_or_default() {
        if path.is_dir() {
            collect(&path, pages);
        } else if path.extension().is_some_and(|e| e == "md") {
            pages.push(path);
        }
    }
}

/// Targets of links and pictures with their lines, code left out.
fn links(text: &str) -> Vec<(usize, String)> {
    let mut found = vec![];
    let mut is_code = false;
    for (index, line) in text.lines().enumerate() {
        if line.trim_start().starts_with("```") {
            is_code = !is_code;
        }
        if is_code || line.starts_with("    ") {
            continue;
        }
        // Every second piece is code.
        let plain: String = line.split('`').step_by(2).collect();
        for rest in plain.split("](").skip(1) {
            if let Some((target, _)) = rest.split_once(')') {
                found.push((index + 1, target.split_whitespace().next().unwrap_or("").to_string()));
            }
        }
    }
    found
}

/// Why a link is dead; links to other places are not followed.
fn dead(target: &str, page: &Path, folder: &Path) -> Option<String> {
    if target.contains("://") || target.starts_with("mailto:") {
        return None;
    }
    let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
    let path = if file.is_empty() { page.to_path_buf() } else { folder.join(file) };
    if !path.exists() {
        return Some("there is no such file".into());
    }
    if anchor.is_empty() || path.extension().is_none_or(|e| e != "md") {
        return None;
    }
    let text = std::fs::read_to_string(&path).unwrap_or_default();
    let known = text.lines().filter(|l| l.starts_with('#')).any(|l| slug(l.trim_start_matches('#')) == anchor);
    (!known).then(|| "there is no such heading".into())
}

/// The anchor that mdbook gives a heading.
fn slug(heading: &str) -> String {
    let lower = heading.trim().to_lowercase();
    let kept = lower.chars().filter_map(|c| match c {
        c if c.is_alphanumeric() || c == '-' || c == '_' => Some(c),
        c if c.is_whitespace() => Some('-'),
        _ => None,
    });
    kept.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_are_found_outside_code() {
        let text = "[a](b.md) `[c](d)` ![e](f.svg \"g\")\n```\n[h](i)\n```\n    [j](k)\n";
        assert_eq!(links(text), [(1, "b.md".to_string()), (1, "f.svg".to_string())]);
    }

    #[test]
    fn headings_become_anchors() {
        assert_eq!(slug(" Life, `growth` and K_I "), "life-growth-and-k_i");
        let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../README.md");
        let folder = page.parent().expect("the root");
        assert!(dead("#no-such-heading", &page, folder).is_some());
        assert!(dead("no-such.md", &page, folder).is_some());
        assert_eq!(dead("#license", &page, folder), None);
        assert_eq!(dead("https://example.org/x", &page, folder), None);
    }
}
