//! Functions besides the shape functions of nodes: of nodes near tips, or of the tips themselves.

use super::ShapeFunctions;
use super::global_functions::GlobalFunctions;
use super::partition_of_unity::ExtraFunctions;
use crate::math::Vector2;

/// Additional functions; their indices follow those of the nodes.
#[derive(Clone, Debug)]
pub(super) enum Extra {
    /// Products with the shape functions of nodes.
    OfNodes(ExtraFunctions),
    /// Four of each tip.
    OfTips(GlobalFunctions),
}

impl Extra {
    /// Number of all functions, those of the nodes included.
    pub fn n_functions(&self) -> usize {
        match self {
            Self::OfNodes(extra) => extra.n_functions(),
            Self::OfTips(global) => global.n_functions(),
        }
    }

    /// Position of each additional function.
    pub fn positions(&self, nodes: &[Vector2]) -> Vec<Vector2> {
        match self {
            Self::OfNodes(extra) => extra.owners().map(|i| nodes[i as usize]).collect(),
            Self::OfTips(global) => global.owners().collect(),
        }
    }

    /// Appends the functions that are not zero where the nodes in an ascending list act.
    pub fn append_to(&self, list: &mut Vec<u32>) {
        match self {
            Self::OfNodes(extra) => (0..list.len()).for_each(|k| list.extend(extra.of_node(list[k]))),
            Self::OfTips(global) => global.append_to(list),
        }
    }

    /// Whether no function acts where the nodes in a list do.
    pub fn is_silent(&self, nodes: &[u32]) -> bool {
        match self {
            Self::OfNodes(extra) => nodes.iter().all(|i| extra.of_node(*i).is_empty()),
            Self::OfTips(global) => global.is_silent(nodes),
        }
    }

    /// Appends the functions at a point to the shape functions of its neighbors.
    pub fn append(&self, view: [Vector2; 2], shape: &mut ShapeFunctions<2>) {
        match self {
            Self::OfNodes(extra) => extra.append(view, shape),
            Self::OfTips(global) => global.append(view, shape),
        }
    }

    /// Angle of each tip whose functions are tied to its stress intensity factors [rad].
    pub fn tied_tips(&self) -> Vec<f64> {
        match self {
            Self::OfNodes(_) => vec![],
            Self::OfTips(global) => global.angles().collect(),
        }
    }
}
