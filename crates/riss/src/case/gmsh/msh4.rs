//! Entities, nodes and elements of version 4.1.

use super::GmshError;
use super::format::{RawElement, RawMesh, Shape, element_type, push_node};
use super::scanner::Scanner;

/// Physical groups of one entity: all its elements repeat them, so that more could fill the memory.
const MAX_GROUPS: u64 = 100;

pub(super) fn read_entities(scanner: &mut Scanner, mesh: &mut RawMesh) -> Result<(), GmshError> {
    scanner.begin_binary()?;
    let mut counts = [0; 4];
    for count in &mut counts {
        *count = scanner.size("the number of entities")?;
    }
    for (dimension, count) in counts.into_iter().enumerate() {
        for _ in 0..count {
            read_entity(scanner, mesh, dimension)?;
        }
    }
    Ok(())
}

fn read_entity(scanner: &mut Scanner, mesh: &mut RawMesh, dimension: usize) -> Result<(), GmshError> {
    let tag = scanner.int("an entity tag")?;
    // A point has a position, all others have a bounding box.
    for _ in 0..if dimension == 0 { 3 } else { 6 } {
        scanner.double("a coordinate")?;
    }
    let n_groups = scanner.size("the number of physical groups")?;
    if n_groups > MAX_GROUPS {
        return Err(scanner.error(format!("an entity in {n_groups} physical groups; {MAX_GROUPS} can be read")));
    }
    let mut groups = vec![];
    for _ in 0..n_groups {
        groups.push(scanner.int("a group tag")?.unsigned_abs());
    }
    if dimension > 0 {
        for _ in 0..scanner.size("the number of bounding entities")? {
            scanner.int("the tag of a bounding entity")?;
        }
    }
    if dimension == 1 {
        mesh.curve_groups.insert(tag, groups);
    } else if dimension == 2 {
        mesh.entity_groups.insert(tag, groups);
    }
    Ok(())
}

pub(super) fn read_nodes(scanner: &mut Scanner, mesh: &mut RawMesh) -> Result<(), GmshError> {
    let n_blocks = read_header(scanner)?;
    for _ in 0..n_blocks {
        let dimension = scanner.int("an entity dimension")?;
        scanner.int("an entity tag")?;
        let is_parametric = scanner.int("whether nodes have parameters")? != 0;
        let dimension = usize::try_from(dimension).ok().filter(|d| *d <= 3);
        let dimension = dimension.ok_or_else(|| scanner.error("an entity dimension is not 0, 1, 2 or 3"))?;
        let n_parameters = if is_parametric { dimension } else { 0 };
        let count = scanner.size("the number of nodes of one entity")?;
        let count = scanner.fitting(count, "nodes", 32, 4)?;
        let tags: Vec<u64> = (0..count).map(|_| scanner.size("a node tag")).collect::<Result<_, _>>()?;
        mesh.nodes.reserve(count);
        for tag in tags {
            let position = [scanner.double("x")?, scanner.double("y")?, scanner.double("z")?];
            let place = scanner.place();
            for _ in 0..n_parameters {
                scanner.double("a parameter")?;
            }
            push_node(scanner, mesh, tag, place, position)?;
        }
    }
    Ok(())
}

pub(super) fn read_elements(scanner: &mut Scanner, mesh: &mut RawMesh) -> Result<(), GmshError> {
    let n_blocks = read_header(scanner)?;
    for _ in 0..n_blocks {
        let dimension = scanner.int("an entity dimension")?;
        let entity = scanner.int("an entity tag")?;
        let number = scanner.int("an element type")?;
        let (shape, n_nodes) = element_type(scanner, mesh.solids, number)?;
        let numbers = 1 + n_nodes as u64;
        let count = scanner.size("the number of elements of one entity")?;
        let count = scanner.fitting(count, "elements", 8 * numbers, numbers)?;
        let groups = match dimension {
            1 if shape == Shape::Line => mesh.curve_groups.get(&entity),
            2 => mesh.entity_groups.get(&entity),
            _ => None,
        };
        let groups = groups.cloned().unwrap_or_default();
        for _ in 0..count {
            scanner.size("an element tag")?;
            let place = scanner.place();
            let nodes = (0..n_nodes).map(|_| scanner.size("a node tag")).collect::<Result<_, _>>()?;
            if !matches!(shape, Shape::Point | Shape::Solid) {
                mesh.elements.push(RawElement { shape, nodes, groups: groups.clone(), place });
            }
        }
    }
    Ok(())
}

/// The number of blocks; the numbers of items and the range of tags after it are not needed.
fn read_header(scanner: &mut Scanner) -> Result<u64, GmshError> {
    scanner.begin_binary()?;
    let n_blocks = scanner.size("the number of blocks")?;
    for what in ["the number of items", "the least tag", "the greatest tag"] {
        scanner.size(what)?;
    }
    Ok(n_blocks)
}
