//! Materials, supports and loads of an input file as the tables of a case.

use super::AbaqusError;
use super::deck::{Condition, Deck, Kind, key};
use super::keywords::shortened;
use super::mesh::{Faces, elements, face_part, is_plane, pressure_face};
use std::collections::{BTreeMap, HashSet};
use toml::{Table, Value};

/// The tables, and what the author should know.
pub(super) struct Imported {
    pub tables: Table,
    pub remarks: Vec<String>,
}

pub(super) fn tables(deck: &Deck, faces: &Faces, parts: &HashSet<String>) -> Result<Imported, AbaqusError> {
    let mut writer = Writer { deck, faces, parts, tables: Table::new(), remarks: vec![] };
    if let Some(title) = &deck.title {
        writer.tables.insert("title".into(), title.clone().into());
    }
    writer.material()?;
    writer.supports()?;
    writer.forces()?;
    writer.surface_loads()?;
    writer.element_loads()?;
    Ok(Imported { tables: writer.tables, remarks: writer.remarks })
}

struct Writer<'d> {
    deck: &'d Deck,
    faces: &'d Faces,
    /// Names of the parts of the boundary in capitals.
    parts: &'d HashSet<String>,
    tables: Table,
    remarks: Vec<String>,
}

fn error(condition: &Condition, keyword: &str, problem: String) -> AbaqusError {
    AbaqusError::Line { line: condition.line, keyword: keyword.into(), problem }
}

/// A field as a number; 0 if it is empty or not there.
fn number(condition: &Condition, keyword: &str, index: usize) -> Result<f64, AbaqusError> {
    let text = condition.fields.get(index).map_or("", String::as_str);
    if text.is_empty() {
        return Ok(0.0);
    }
    let value: Option<f64> = text.replace(['d', 'D'], "e").parse().ok();
    let finite = value.filter(|v| v.is_finite());
    finite.ok_or_else(|| error(condition, keyword, format!("`{}` is no number", shortened(text))))
}

fn point([x, y, _]: [f64; 3]) -> Value {
    Value::Array(vec![x.into(), y.into()])
}

impl Writer<'_> {
    fn push(&mut self, list: &str, entry: Table) {
        let value = self.tables.entry(list).or_insert_with(|| Value::Array(vec![]));
        if let Value::Array(entries) = value {
            entries.push(entry.into());
        }
    }

    fn material(&mut self) -> Result<(), AbaqusError> {
        let mut kinds = self.deck.elements.iter().filter(|e| is_plane(e)).map(|e| (e.kind, e.line));
        let Some((kind, _)) = kinds.next() else { return Ok(()) };
        if let Some((_, line)) = kinds.find(|k| k.0 != kind) {
            let problem = "elements of plane stress and of plane strain in one body".into();
            return Err(AbaqusError::Line { line, keyword: "ELEMENT".into(), problem });
        }
        let mut material = Table::new();
        let plane = if kind == Kind::PlaneStrain { "strain" } else { "stress" };
        material.insert("plane".into(), plane.into());
        let is_used = |set: &str| elements(self.deck, set).is_some_and(|list| list.iter().any(|e| is_plane(e)));
        let used: Vec<_> = self.deck.sections.iter().filter(|s| is_used(&s.0)).collect();
        let names: Vec<&String> = match used[..] {
            [] => self.deck.elastic.keys().collect(),
            _ => used.iter().map(|s| &s.1).collect(),
        };
        let constants: Vec<_> = names.iter().filter_map(|n| *self.deck.elastic.get(*n)?).collect();
        match constants.split_first() {
            Some((first, rest)) if rest.iter().all(|c| c == first) => {
                material.insert("young".into(), first[0].into());
                material.insert("poisson".into(), first[1].into());
            }
            Some(_) => self.remarks.push("several materials: none is taken, name one under [material]".into()),
            None => {}
        }
        let mut thickness = used.iter().filter_map(|s| s.2);
        if let Some(first) = thickness.next() {
            if thickness.any(|t| t != first) {
                self.remarks.push(format!("several thicknesses: the first, {first}, is taken"));
            }
            material.insert("thickness".into(), first.into());
        }
        self.tables.insert("material".into(), material.into());
        Ok(())
    }

    /// Labels of nodes by label or set.
    fn nodes(&self, condition: &Condition, keyword: &str) -> Result<Vec<u64>, AbaqusError> {
        let target = &condition.target;
        let nodes = match target.parse::<u64>() {
            Ok(label) => Some(vec![label]),
            Err(_) => self.deck.node_sets.get(&key(target)).map(|s| s.members.clone()),
        };
        let problem = || error(condition, keyword, format!("there are no nodes `{}`", shortened(target)));
        let nodes = nodes.ok_or_else(problem)?;
        match nodes.iter().find(|n| !self.deck.nodes.contains_key(n)) {
            Some(missing) => Err(error(condition, keyword, format!("there is no node {missing}"))),
            None => Ok(nodes),
        }
    }

    fn supports(&mut self) -> Result<(), AbaqusError> {
        // By set, in the order of the file; a later value wins.
        let mut held: Vec<(&Condition, [Option<f64>; 2])> = vec![];
        for condition in &self.deck.boundary {
            let displacement = self.displacement(condition)?;
            match held.iter_mut().find(|h| key(&h.0.target) == key(&condition.target)) {
                Some(known) => (0..2).for_each(|k| known.1[k] = displacement[k].or(known.1[k])),
                None => held.push((condition, displacement)),
            }
        }
        held.retain(|h| h.1 != [None; 2]);
        let mut on_edges = [HashSet::new(), HashSet::new()];
        let mut alone: BTreeMap<u64, [Option<f64>; 2]> = BTreeMap::new();
        for (condition, displacement) in held {
            let nodes = self.nodes(condition, "BOUNDARY")?;
            let name = self.deck.node_sets.get(&key(&condition.target)).map(|s| s.name.clone());
            let edges = self.faces.within(&nodes.iter().copied().collect());
            let covered = self.faces.nodes_of(&edges);
            if let Some(name) = name.filter(|_| !edges.is_empty()) {
                let mut entry = Table::from_iter([("on".to_string(), Value::from(name))]);
                for (axis, value) in ["x", "y"].iter().zip(displacement) {
                    value.map(|v| entry.insert(axis.to_string(), v.into()));
                }
                self.push("support", entry);
                let axes = (0..2).filter(|k| displacement[*k].is_some());
                axes.for_each(|k| on_edges[k].extend(covered.iter().copied()));
            }
            for node in nodes.into_iter().filter(|n| !covered.contains(n)) {
                let known = alone.entry(node).or_default();
                (0..2).for_each(|k| known[k] = displacement[k].or(known[k]));
            }
        }
        for (node, displacement) in alone {
            let mut entry = Table::from_iter([("at".to_string(), point(self.deck.nodes[&node].0))]);
            for (k, axis) in ["x", "y"].iter().enumerate() {
                // Held with its edge already.
                if let Some(value) = displacement[k].filter(|_| !on_edges[k].contains(&node)) {
                    entry.insert(axis.to_string(), value.into());
                }
            }
            if entry.len() > 1 {
                self.push("support", entry);
            }
        }
        Ok(())
    }

    /// Prescribed displacement along x and y.
    fn displacement(&self, condition: &Condition) -> Result<[Option<f64>; 2], AbaqusError> {
        match condition.fields[0].to_uppercase().as_str() {
            "ENCASTRE" | "PINNED" => return Ok([Some(0.0); 2]),
            "XSYMM" | "YASYMM" => return Ok([Some(0.0), None]),
            "YSYMM" | "XASYMM" => return Ok([None, Some(0.0)]),
            "ZSYMM" | "ZASYMM" => return Ok([None; 2]),
            _ => {}
        }
        let dof = |index: usize| match condition.fields.get(index).map(String::as_str) {
            None | Some("") => Ok(None),
            Some(text) => text.parse::<usize>().map(Some).map_err(|_| {
                error(condition, "BOUNDARY", format!("`{}` is neither a direction nor a known type", shortened(text)))
            }),
        };
        let first = dof(0)?.unwrap_or(0);
        let last = dof(1)?.unwrap_or(first);
        let value = number(condition, "BOUNDARY", 2)?;
        // Directions from 3 on, out of the plane and rotations, do not exist here.
        Ok([1, 2].map(|k| (first..=last).contains(&k).then_some(value)))
    }

    fn forces(&mut self) -> Result<(), AbaqusError> {
        let mut at: BTreeMap<u64, [f64; 2]> = BTreeMap::new();
        for condition in &self.deck.point_forces {
            let direction = condition.fields[0].parse::<usize>().unwrap_or(0);
            let value = number(condition, "CLOAD", 1)?;
            for node in self.nodes(condition, "CLOAD")? {
                match direction {
                    1 | 2 => at.entry(node).or_default()[direction - 1] += value,
                    _ => {
                        let text = shortened(&condition.fields[0]);
                        return Err(error(
                            condition,
                            "CLOAD",
                            format!("`{text}` is no direction of the plane, 1 or 2"),
                        ));
                    }
                }
            }
        }
        if at.len() > 2 {
            let n = at.len();
            self.remarks.push(format!("{n} forces at nodes act as points; *DSLOAD or *DLOAD would spread them"));
        }
        for (node, force) in at {
            let force = Value::Array(force.iter().map(|f| Value::from(*f)).collect());
            let at = ("at".to_string(), point(self.deck.nodes[&node].0));
            self.push("point_load", Table::from_iter([at, ("force".to_string(), force)]));
        }
        Ok(())
    }

    fn pressure(&mut self, name: &str, pressure: f64) {
        let entry = [("on".to_string(), Value::from(name)), ("pressure".to_string(), pressure.into())];
        self.push("load", Table::from_iter(entry));
    }

    fn surface_loads(&mut self) -> Result<(), AbaqusError> {
        for condition in &self.deck.surface_loads {
            let Some((name, _)) = self.deck.surfaces.get(&key(&condition.target)) else {
                let name = shortened(&condition.target);
                return Err(error(condition, "DSLOAD", format!("there is no surface `{name}`")));
            };
            if !condition.fields[0].eq_ignore_ascii_case("P") {
                let kind = shortened(&condition.fields[0]);
                self.remarks.push(format!("ignored: load {kind} of *DSLOAD (line {}); P is read", condition.line));
                continue;
            }
            let value = number(condition, "DSLOAD", 1)?;
            let name = name.clone();
            self.check_part(condition, "DSLOAD", &name)?;
            self.pressure(&name, value);
        }
        Ok(())
    }

    fn check_part(&self, condition: &Condition, keyword: &str, name: &str) -> Result<(), AbaqusError> {
        if self.parts.contains(&key(name)) {
            return Ok(());
        }
        Err(error(condition, keyword, format!("no face of `{}` lies on the boundary", shortened(name))))
    }

    fn element_loads(&mut self) -> Result<(), AbaqusError> {
        let n_plane = self.deck.elements.iter().filter(|e| is_plane(e)).count();
        let mut body = [0.0; 2];
        for condition in &self.deck.element_loads {
            let target = condition.target.clone();
            let Some(loaded) = elements(self.deck, &target) else {
                let name = shortened(&target);
                return Err(error(condition, "DLOAD", format!("there are no elements `{name}`")));
            };
            let is_whole = loaded.iter().filter(|e| is_plane(e)).count() == n_plane;
            let kind = condition.fields[0].to_uppercase();
            let value = number(condition, "DLOAD", 1)?;
            if let Some(face) = pressure_face(&kind) {
                let name = face_part(&target, face);
                self.check_part(condition, "DLOAD", &name)?;
                self.pressure(&name, value);
                continue;
            }
            match kind.as_str() {
                "BX" if is_whole => body[0] += value,
                "BY" if is_whole => body[1] += value,
                "GRAV" if is_whole && self.deck.density.len() == 1 => {
                    let density: f64 = self.deck.density.values().sum();
                    for (k, force) in body.iter_mut().enumerate() {
                        *force += density * value * number(condition, "DLOAD", 2 + k)?;
                    }
                }
                _ => {
                    let kind = shortened(&kind);
                    self.remarks.push(format!(
                        "ignored: load {kind} of *DLOAD (line {}); P1 to P4 are read, BX, BY and GRAV on the whole body",
                        condition.line
                    ));
                }
            }
        }
        if body != [0.0; 2] {
            let axes = ["x", "y"].map(String::from).into_iter().zip(body.map(Value::from));
            self.tables.insert("body_force".into(), Table::from_iter(axes).into());
        }
        Ok(())
    }
}
