//! Blocks to nodes, elements, sets, materials and conditions; what is not understood is kept by name.

use super::AbaqusError;
use super::keywords::{Block, blocks};
use std::collections::{BTreeMap, HashMap};

/// Sets with more members than this, all together, are refused: `GENERATE` needs few letters for many.
const MAX_MEMBERS: usize = 20_000_000;
/// Headings, output requests and the like: nothing is lost with them.
const SILENT: [&str; 16] = [
    "PREPRINT",
    "PART",
    "END PART",
    "ASSEMBLY",
    "END ASSEMBLY",
    "END INSTANCE",
    "END STEP",
    "STATIC",
    "OUTPUT",
    "NODE OUTPUT",
    "ELEMENT OUTPUT",
    "NODE PRINT",
    "EL PRINT",
    "NODE FILE",
    "EL FILE",
    "RESTART",
];

/// Plane element or line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    PlaneStress,
    PlaneStrain,
    Line,
}

pub(super) struct Element {
    pub kind: Kind,
    /// Corners, then midside nodes (that of corners 0 and 1 first).
    pub nodes: Vec<u64>,
    pub n_corners: usize,
    pub line: usize,
}

/// Members by label, under the name as it was written first.
#[derive(Clone, Default)]
pub(super) struct Set {
    pub name: String,
    pub members: Vec<u64>,
}

/// Sets by their name in capitals.
pub(super) type Sets = BTreeMap<String, Set>;

/// A condition of the first step or before it.
pub(super) struct Condition {
    pub line: usize,
    /// Label or name of a set or surface, as written.
    pub target: String,
    /// The other fields.
    pub fields: Vec<String>,
}

#[derive(Default)]
pub(super) struct Deck {
    pub title: Option<String>,
    pub nodes: HashMap<u64, ([f64; 3], usize)>,
    /// In the order of the file.
    pub elements: Vec<Element>,
    pub by_label: HashMap<u64, usize>,
    pub node_sets: Sets,
    pub element_sets: Sets,
    /// Faces of surfaces: element or set of elements, and the face from 1.
    pub surfaces: BTreeMap<String, (String, Vec<(String, usize)>)>,
    /// Young's modulus and Poisson's ratio by name in capitals; `None` where they are no two constants.
    pub elastic: BTreeMap<String, Option<[f64; 2]>>,
    pub density: BTreeMap<String, f64>,
    /// Set of elements, material in capitals, thickness.
    pub sections: Vec<(String, String, Option<f64>)>,
    pub boundary: Vec<Condition>,
    pub point_forces: Vec<Condition>,
    pub element_loads: Vec<Condition>,
    pub surface_loads: Vec<Condition>,
    /// What is not understood, such as `*AMPLITUDE (line 40)`.
    pub ignored: Vec<String>,
    material: String,
    n_instances: usize,
    n_steps: usize,
    /// In the assembly, but in no instance.
    in_assembly: bool,
    n_members: usize,
}

/// The name of a set without that of its instance, in capitals.
pub(super) fn key(name: &str) -> String {
    name.rsplit('.').next().unwrap_or(name).trim_matches('"').to_uppercase()
}

pub(super) fn read(text: &str) -> Result<Deck, AbaqusError> {
    let mut deck = Deck::default();
    for block in blocks(text)? {
        deck.add(&block)?;
    }
    Ok(deck)
}

impl Deck {
    fn add(&mut self, block: &Block) -> Result<(), AbaqusError> {
        match block.keyword.as_str() {
            "HEADING" => self.title = block.data.first().map(|d| d.1.to_string()),
            "NODE" if self.in_assembly => self.ignore(block),
            "NODE" => self.add_nodes(block)?,
            "ELEMENT" => self.add_elements(block)?,
            "NSET" => self.add_set(block, "NSET")?,
            "ELSET" => self.add_set(block, "ELSET")?,
            "SURFACE" => self.add_surface(block)?,
            "SOLID SECTION" => self.add_section(block)?,
            "MATERIAL" => self.material = key(block.required("NAME")?),
            "ELASTIC" => self.add_elastic(block)?,
            "DENSITY" => {
                if let Some((line, row)) = block.rows().next() {
                    let density = block.number(line, row.first().unwrap_or(&""), "a density")?;
                    self.density.insert(self.material.clone(), density);
                }
            }
            "INSTANCE" => self.add_instance(block)?,
            "STEP" => self.n_steps += 1,
            "BOUNDARY" | "CLOAD" | "DLOAD" | "DSLOAD" if self.n_steps > 1 => self.ignore(block),
            "BOUNDARY" => self.boundary.extend(conditions(block)?),
            "CLOAD" => self.point_forces.extend(conditions(block)?),
            "DLOAD" => self.element_loads.extend(conditions(block)?),
            "DSLOAD" => self.surface_loads.extend(conditions(block)?),
            "INCLUDE" => {
                return Err(block.error(block.line, "other files are not read; put their text into this one"));
            }
            name if SILENT.contains(&name) => self.in_assembly = name == "ASSEMBLY" || name == "END INSTANCE",
            _ => self.ignore(block),
        }
        for name in ["AMPLITUDE", "OP", "TYPE", "LOAD CASE"] {
            let takes_it = ["BOUNDARY", "CLOAD", "DLOAD", "DSLOAD"].contains(&block.keyword.as_str());
            if takes_it && block.parameter(name).is_some() {
                self.ignored.push(format!("{name} of *{} (line {})", block.keyword, block.line));
            }
        }
        Ok(())
    }

    fn ignore(&mut self, block: &Block) {
        self.ignored.push(format!("*{} (line {})", super::keywords::shortened(&block.keyword), block.line));
    }

    fn add_instance(&mut self, block: &Block) -> Result<(), AbaqusError> {
        self.n_instances += 1;
        self.in_assembly = false;
        if self.n_instances > 1 {
            return Err(block.error(block.line, "a second instance; one body in one instance can be read"));
        }
        let moves = |row: &Vec<&str>| row.iter().any(|f| f.parse() != Ok(0.0));
        match block.rows().find(|(_, row)| moves(row)) {
            Some((line, _)) => Err(block.error(line, "the instance is moved; export it where it stands in its part")),
            None => Ok(()),
        }
    }

    fn add_nodes(&mut self, block: &Block) -> Result<(), AbaqusError> {
        let set = block.parameter("NSET").map(String::from);
        for (line, row) in block.rows() {
            let label = block.label(line, row.first().unwrap_or(&""), "a node number")?;
            let mut position = [0.0; 3];
            if row.len() < 3 {
                return Err(block.error(line, format!("node {label} has fewer than two coordinates")));
            }
            for (axis, text) in row[1..].iter().take(3).enumerate() {
                position[axis] = block.number(line, text, "a coordinate")?;
            }
            if self.nodes.insert(label, (position, line)).is_some() {
                return Err(block.error(line, format!("node {label} is there twice")));
            }
            if let Some(name) = &set {
                self.insert(block, line, Family::Nodes, name, [label])?;
            }
        }
        Ok(())
    }

    fn add_elements(&mut self, block: &Block) -> Result<(), AbaqusError> {
        let name = block.required("TYPE")?.to_uppercase();
        let Some((kind, n_corners, n_nodes)) = element_type(&name).map_err(|p| block.error(block.line, p))? else {
            self.ignored.push(format!("*ELEMENT of type {name} (line {})", block.line));
            return Ok(());
        };
        let set = block.parameter("ELSET").map(String::from);
        // An element may go over several lines.
        let mut pending: Vec<u64> = vec![];
        let mut first_line = 0;
        for (line, row) in block.rows() {
            if pending.is_empty() {
                first_line = line;
            }
            for text in row {
                pending.push(block.label(line, text, "a number of an element or node")?);
            }
            if pending.len() <= n_nodes {
                continue;
            }
            if pending.len() > n_nodes + 1 {
                return Err(block.error(line, format!("element {} has more than {n_nodes} nodes", pending[0])));
            }
            let label = pending[0];
            let nodes = pending.split_off(1);
            pending.clear();
            if self.by_label.insert(label, self.elements.len()).is_some() {
                return Err(block.error(first_line, format!("element {label} is there twice")));
            }
            self.elements.push(Element { kind, nodes, n_corners, line: first_line });
            if let Some(name) = &set {
                self.insert(block, line, Family::Elements, name, [label])?;
            }
        }
        match pending.first() {
            Some(label) => Err(block.error(first_line, format!("element {label} has fewer than {n_nodes} nodes"))),
            None => Ok(()),
        }
    }

    fn add_set(&mut self, block: &Block, parameter: &str) -> Result<(), AbaqusError> {
        let name = block.required(parameter)?.to_string();
        let family = if parameter == "NSET" { Family::Nodes } else { Family::Elements };
        for (line, row) in block.rows() {
            if block.parameter("GENERATE").is_some() {
                let at = |k: usize| row.get(k).map(|t| block.label(line, t, "a number")).transpose();
                let (Some(first), Some(last)) = (at(0)?, at(1)?) else {
                    return Err(block.error(line, "GENERATE needs a first and a last number"));
                };
                let step = at(2)?.unwrap_or(1);
                if first > last || ((last - first) / step) as usize > MAX_MEMBERS {
                    return Err(block.error(line, format!("{first} to {last} by {step} is no range of members")));
                }
                self.insert(block, line, family, &name, (first..=last).step_by(step as usize))?;
                continue;
            }
            for text in row {
                match text.parse::<u64>() {
                    Ok(label) => self.insert(block, line, family, &name, [label])?,
                    Err(_) => {
                        let other = self.sets(family).get(&key(text)).map(|s| s.members.clone());
                        let unknown =
                            || block.error(line, format!("there is no set `{}`", super::keywords::shortened(text)));
                        self.insert(block, line, family, &name, other.ok_or_else(unknown)?)?;
                    }
                }
            }
        }
        Ok(())
    }

    fn sets(&mut self, family: Family) -> &mut Sets {
        match family {
            Family::Nodes => &mut self.node_sets,
            Family::Elements => &mut self.element_sets,
        }
    }

    fn insert(
        &mut self,
        block: &Block,
        line: usize,
        family: Family,
        name: &str,
        labels: impl IntoIterator<Item = u64>,
    ) -> Result<(), AbaqusError> {
        let set = self.sets(family).entry(key(name)).or_insert_with(|| Set { name: name.into(), members: vec![] });
        let before = set.members.len();
        set.members.extend(labels);
        let added = set.members.len() - before;
        self.n_members += added;
        if self.n_members > MAX_MEMBERS {
            return Err(block.error(line, format!("all sets together have more than {MAX_MEMBERS} members")));
        }
        Ok(())
    }

    fn add_surface(&mut self, block: &Block) -> Result<(), AbaqusError> {
        let name = block.required("NAME")?.to_string();
        if block.parameter("TYPE").is_some_and(|t| !t.eq_ignore_ascii_case("ELEMENT")) {
            self.ignore(block);
            return Ok(());
        }
        let mut faces = vec![];
        for (line, row) in block.rows() {
            let face = row.get(1).and_then(|f| f.to_uppercase().strip_prefix('S')?.parse().ok());
            let Some(face @ 1..=4) = face else {
                let text = row.get(1).unwrap_or(&"");
                return Err(block.error(line, format!("`{}` is not a face S1 to S4", super::keywords::shortened(text))));
            };
            faces.push((row[0].to_string(), face));
        }
        let surface = self.surfaces.entry(key(&name)).or_insert((name, vec![]));
        surface.1.extend(faces);
        Ok(())
    }

    fn add_section(&mut self, block: &Block) -> Result<(), AbaqusError> {
        let thickness = match block.rows().next() {
            Some((line, row)) => match row.first() {
                Some(text) if !text.is_empty() => Some(block.number(line, text, "a thickness")?),
                _ => None,
            },
            None => None,
        };
        self.sections.push((block.required("ELSET")?.into(), key(block.required("MATERIAL")?), thickness));
        Ok(())
    }

    fn add_elastic(&mut self, block: &Block) -> Result<(), AbaqusError> {
        let is_isotropic = block.parameter("TYPE").is_none_or(|t| t.to_uppercase().starts_with("ISO"));
        let rows: Vec<_> = block.rows().collect();
        let constants = match &rows[..] {
            [(line, row), ..] if is_isotropic && row.len() >= 2 => {
                Some([block.number(*line, row[0], "Young's modulus")?, block.number(*line, row[1], "Poisson's ratio")?])
            }
            _ => None,
        };
        if !is_isotropic || rows.len() > 1 {
            let what = if is_isotropic { "further rows" } else { "anisotropy" };
            self.ignored.push(format!("{what} of *ELASTIC (line {})", block.line));
        }
        self.elastic.insert(self.material.clone(), constants);
        Ok(())
    }
}

#[derive(Clone, Copy)]
enum Family {
    Nodes,
    Elements,
}

fn conditions(block: &Block) -> Result<Vec<Condition>, AbaqusError> {
    let condition = |(line, row): (usize, Vec<&str>)| match row.split_first() {
        Some((target, rest)) if !rest.is_empty() => {
            let fields = rest.iter().map(|f| f.to_string()).collect();
            Ok(Condition { line, target: target.to_string(), fields })
        }
        _ => Err(block.error(line, "the line says neither where nor what")),
    };
    block.rows().map(condition).collect()
}

/// Kind, number of corners and number of nodes; `None` for elements that carry no plane body.
fn element_type(name: &str) -> Result<Option<(Kind, usize, usize)>, String> {
    match name {
        "T2D2" | "T3D2" | "B21" | "B31" => return Ok(Some((Kind::Line, 2, 2))),
        "T2D3" | "T3D3" | "B22" | "B32" => return Ok(Some((Kind::Line, 3, 3))),
        _ => {}
    }
    let kind = match name.get(..3) {
        Some("CPS") => Kind::PlaneStress,
        Some("CPE") => Kind::PlaneStrain,
        Some("CAX") => return Err(format!("element type {name} is axisymmetric; a plane body is needed")),
        Some("C3D") => return Err(format!("element type {name} is a solid; a plane body is needed")),
        _ => return Ok(None),
    };
    // R: fewer integration points, I: incompatible modes, H: hybrid, M: modified. The shape is the same.
    match name[3..].trim_end_matches(['R', 'I', 'H', 'M']) {
        "3" => Ok(Some((kind, 3, 3))),
        "4" => Ok(Some((kind, 4, 4))),
        "6" => Ok(Some((kind, 3, 6))),
        "8" => Ok(Some((kind, 4, 8))),
        _ => Err(format!("element type {name} is not known; CPS3, CPS4, CPS6, CPS8 and the same with CPE are")),
    }
}
