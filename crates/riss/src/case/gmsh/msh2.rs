//! Nodes and elements of version 2.2.

use super::GmshError;
use super::format::{RawElement, RawMesh, Shape, element_type, push_node};
use super::scanner::Scanner;

pub(super) fn read_nodes(scanner: &mut Scanner, mesh: &mut RawMesh) -> Result<(), GmshError> {
    let count: u64 = scanner.text_number("the number of nodes")?;
    scanner.begin_binary()?;
    let count = scanner.fitting(count, "nodes", 28, 4)?;
    mesh.nodes.reserve(count);
    for _ in 0..count {
        let tag = read_tag(scanner, "a node tag")?;
        let place = scanner.place();
        let position = [scanner.double("x")?, scanner.double("y")?, scanner.double("z")?];
        push_node(scanner, mesh, tag, place, position)?;
    }
    Ok(())
}

pub(super) fn read_elements(scanner: &mut Scanner, mesh: &mut RawMesh) -> Result<(), GmshError> {
    let count: u64 = scanner.text_number("the number of elements")?;
    scanner.begin_binary()?;
    let count = scanner.fitting(count, "elements", 8, 4)?;
    mesh.elements.reserve(count);
    let mut left = count;
    if scanner.order.is_none() {
        for _ in 0..count {
            read_tag(scanner, "an element tag")?;
            let (shape, n_nodes) = read_type(scanner, mesh)?;
            let n_tags = scanner.int("the number of element tags")?;
            read_element(scanner, mesh, shape, n_nodes, n_tags)?;
        }
        return Ok(());
    }
    // Binary elements come in groups of one type.
    while left > 0 {
        let (shape, n_nodes) = read_type(scanner, mesh)?;
        let size = scanner.int("the number of elements of one type")?;
        let n_tags = scanner.int("the number of element tags")?;
        let size = usize::try_from(size).ok().filter(|n| (1..=left).contains(n));
        let size = size.ok_or_else(|| scanner.error("a group with a wrong number of elements"))?;
        for _ in 0..size {
            read_tag(scanner, "an element tag")?;
            read_element(scanner, mesh, shape, n_nodes, n_tags)?;
        }
        left -= size;
    }
    Ok(())
}

fn read_type(scanner: &mut Scanner, mesh: &RawMesh) -> Result<(Shape, usize), GmshError> {
    let number = scanner.int("an element type")?;
    element_type(scanner, mesh.solids, number)
}

fn read_tag(scanner: &mut Scanner, what: &str) -> Result<u64, GmshError> {
    let tag = scanner.int(what)?;
    u64::try_from(tag).map_err(|_| scanner.error(format!("{what} is {tag}")))
}

fn read_element(
    scanner: &mut Scanner,
    mesh: &mut RawMesh,
    shape: Shape,
    n_nodes: usize,
    n_tags: i32,
) -> Result<(), GmshError> {
    let place = scanner.place();
    let mut groups = vec![];
    for k in 0..n_tags {
        // The first tag is the physical group, 0 for none; the others are the curve and partitions.
        let tag = scanner.int("an element tag")?;
        if k == 0 && tag != 0 && !matches!(shape, Shape::Point | Shape::Solid) {
            groups.push(tag.unsigned_abs());
        }
    }
    let nodes = (0..n_nodes).map(|_| read_tag(scanner, "a node tag")).collect::<Result<_, _>>()?;
    if !matches!(shape, Shape::Point | Shape::Solid) {
        mesh.elements.push(RawElement { shape, nodes, groups, place });
    }
    Ok(())
}
