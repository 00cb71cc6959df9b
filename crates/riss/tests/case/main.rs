//! Case files from the outside: what becomes of a good one, and that no input at all makes a panic.

mod cracks;
mod geometry;
mod loads;
mod robustness;
mod values;

use riss::case::{Case, CaseErrors};
use std::path::Path;

/// A valid case around what a test is about.
struct Template {
    head: String,
    geometry: String,
    rest: String,
}

fn template() -> Template {
    Template {
        head: String::new(),
        geometry: "[geometry.rectangle]\nlower = [0, 0]\nupper = [7, 16]\n".into(),
        rest: "[remote_stress]\nyy = 1\n".into(),
    }
}

impl Template {
    fn text(&self) -> String {
        let material = "[material]\nyoung = 1\npoisson = 0.3\nplane = 'strain'\n";
        format!("rigid_motion = 'mean-is-zero'\n{}\n{material}{}{}", self.head, self.geometry, self.rest)
    }

    fn read(&self) -> Result<Case, CaseErrors> {
        Case::parse(&self.text(), Path::new("case.toml"), &[])
    }
}

/// The case, or the messages of its problems.
fn good(template: &Template) -> Case {
    template.read().unwrap_or_else(|errors| panic!("{errors}\n{}", template.text()))
}

/// The first message.
fn bad(template: &Template) -> String {
    template.read().map(|_| ()).expect_err("the case is bad").problems[0].message.clone()
}

#[test]
fn only_geometry_material_and_loads_are_needed() {
    let case = good(&template());
    assert_eq!(case.settings, riss::analysis::Settings::default());
    assert!(case.output.fields && !case.output.nodes);
    assert_eq!((case.model.thickness, case.model.cracks.len()), (1.0, 0));
}

#[test]
fn overrides_win_over_the_file() {
    let overrides = ["material.young=5".to_string(), "approximation.basis=quadratic".into()];
    let case = Case::parse(&template().text(), Path::new("case.toml"), &overrides).unwrap();
    assert_eq!(case.model.material.young, 5.0);
    assert_eq!(case.settings.approximation.dilation(false), 3.2);
}

#[test]
fn the_schema_names_every_section() {
    let schema = riss::case::json_schema();
    let properties = schema["properties"].as_object().unwrap();
    for key in ["material", "geometry", "hole", "part", "crack", "load", "support", "nodes", "constraints", "output"] {
        assert!(properties[key]["description"].is_string(), "{key}");
    }
}

/// Reads a case that lies in the folder of test data.
fn read_beside_data(template: &Template) -> Case {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/case.toml");
    Case::parse(&template.text(), &path, &[]).unwrap_or_else(|errors| panic!("{errors}"))
}

#[test]
fn bodies_come_from_meshes_beside_the_case() {
    let mut template = template();
    template.geometry = "[geometry.gmsh]\nfile = 'two-holes-41-ascii.msh'\n".into();
    template.geometry += "[[part]]\nname = 'seat'\non = 'top'\nfrom = [5, 10]\nto = [7, 10]\n";
    let domain = read_beside_data(&template).model.domain;
    assert_eq!(domain.loops.len(), 3);
    assert!(domain.parts.iter().any(|p| p.name == "hole-1") && domain.parts.iter().any(|p| p.name == "seat"));
}

#[test]
fn nodes_come_from_files_beside_the_case() {
    let mut template = template();
    template.rest += "[nodes.layout.file]\npath = 'nodes.csv'\n";
    let case = read_beside_data(&template);
    let riss::nodes::settings::Layout::Listed(listed) = &case.settings.nodes.layout else { panic!("listed") };
    assert_eq!((listed.positions.as_slice(), case.notes.len()), ([[1.0, 1.0], [2.5, 3.0]].as_slice(), 1));
}

#[test]
fn enrichment_is_read_and_its_radii_are_checked() {
    let mut template = template();
    template.rest += "[approximation.enrichment]\nkind = 'intrinsic-radial'\nramp = 'linear'\nr1 = 0.5\nr2 = 2.0\n";
    let enrichment = good(&template).settings.approximation.enrichment;
    assert_eq!(enrichment.kind, riss::approximation::EnrichmentKind::IntrinsicRadial);
    assert_eq!((enrichment.r1, enrichment.r2), (Some(0.5), Some(2.0)));
    template.rest = template.rest.replace("0.5", "2.5");
    assert_eq!(bad(&template), "must not exceed `r2`");
    template.rest = template.rest.replace("2.0", "0.0");
    assert_eq!(bad(&template), "must be positive");
}
