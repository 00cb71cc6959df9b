//! Tests of the tree of a case file.

use super::*;

fn parse(text: &str, overrides: &[&str]) -> (Document, Vec<Problem>) {
    let overrides: Vec<String> = overrides.iter().map(|s| s.to_string()).collect();
    let mut problems = vec![];
    let document = Document::parse(text, &overrides, &mut problems);
    (document, problems)
}

#[test]
fn values_are_found_by_key_path() {
    let (document, _) = parse("[[crack]]\npath = [[0, 8], [3.5, 8]]\n", &[]);
    let node = document.find("crack[0].path[1]").unwrap();
    assert_eq!(document.written(node).as_deref(), Some("[3.5, 8]"));
    let mut problem = Problem::new("crack[0].name", "missing");
    document.locate(&mut problem);
    assert_eq!(problem.line, 1);
}

#[test]
fn overrides_replace_add_and_fail() {
    let text = "constraints = 'lagrange-multipliers'\n[material]\nyoung = 1\n[[crack]]\npath = [[0, 8], [3.5, 8]]\n\
        [[crack]]\nname = 'far'\npath = [[1, 2], [3, 4]]\n";
    let set = [
        "material.young=2e3",
        "constraints.penalty.factor=5",
        "crack[0].path.1=[4, 8]",
        "title=My plate",
        "crack.far.path[0][1]=5",
    ];
    let (document, problems) = parse(text, &set);
    assert!(problems.is_empty(), "{problems:?}");
    assert!(matches!(document.find("material.young").unwrap().content, Content::Float(v) if v == 2000.0));
    assert!(matches!(document.find("constraints.penalty.factor").unwrap().content, Content::Integer(5)));
    assert!(matches!(document.find("crack[0].path[1][0]").unwrap().content, Content::Integer(4)));
    assert!(matches!(document.find("crack[1].path[0][1]").unwrap().content, Content::Integer(5)));
    assert!(matches!(&document.find("title").unwrap().content, Content::Text(s) if s == "My plate"));
    let (document, _) = parse("[nodes.layout.structured]\nnx = 2\n", &["nodes.layout.graded.spacing=1"]);
    assert!(matches!(document.find("nodes.layout.graded.spacing").unwrap().content, Content::Integer(1)));
    assert!(matches!(&document.find("nodes.layout").unwrap().content, Content::Table(t) if t.len() == 1));
    let (_, problems) = parse(text, &["young", "crack.x.path=1", "=1", "crack[7].path=1"]);
    assert_eq!(problems.len(), 4);
}
