//! A body between the opened faces of its cracks: tractions and work as linear functions of load and openings.

/// The linear relations, from one solution for each opening of unit size.
///
/// A row is a component of the traction of a pair, a column a component of its opening.
pub(in crate::analysis) struct Condensed {
    /// First row of each pair, and the end of the last.
    pub rows: Vec<usize>,
    /// First column of each pair, and the end of the last.
    pub columns: Vec<usize>,
    /// Area that each pair stands for [area].
    pub areas: Vec<f64>,
    /// Traction of the load [stress].
    pub by_load: Vec<f64>,
    /// Traction of each opening of unit size [stress/length]: column by column.
    pub by_opening: Vec<Vec<f64>>,
    /// Work of the loads, and of the reactions to a unit load factor, on each opening of unit size and, last, on what the load
    /// does [stress·length³].
    pub of_loads: Vec<f64>,
    pub of_reactions: Vec<f64>,
}

impl Condensed {
    /// Number of pairs.
    pub fn n_pairs(&self) -> usize {
        self.rows.len() - 1
    }

    /// Traction in a row by the opening of a column [stress/length].
    pub fn by_opening(&self, row: usize, column: usize) -> f64 {
        self.by_opening[column][row]
    }

    /// Traction in a row by the load [stress].
    pub fn by_load(&self, row: usize) -> f64 {
        self.by_load[row]
    }

    /// Tractions of all pairs [stress]; also their rates from the rates of load factor and openings.
    pub fn tractions(&self, load_factor: f64, openings: &[f64]) -> Vec<f64> {
        let mut tractions: Vec<f64> = self.by_load.iter().map(|t| t * load_factor).collect();
        for (column, w) in self.by_opening.iter().zip(openings).filter(|(_, w)| **w != 0.0) {
            tractions.iter_mut().zip(column).for_each(|(t, s)| *t += s * w);
        }
        tractions
    }

    /// Work of unit loads, and of the reactions to a unit load factor, on the displacements [stress·length³].
    pub fn work(&self, load_factor: f64, openings: &[f64]) -> [f64; 2] {
        [&self.of_loads, &self.of_reactions]
            .map(|of_fields| of_fields.iter().zip(openings.iter().chain([&load_factor])).map(|(a, b)| a * b).sum())
    }

    /// Components of a pair in a vector of all rows, zero where the pair has fewer.
    pub fn of_pair(&self, pair: usize, rows: &[f64]) -> [f64; 3] {
        components(&rows[self.rows[pair]..self.rows[pair + 1]])
    }

    /// The same in a vector of all columns.
    pub fn opening_of(&self, pair: usize, columns: &[f64]) -> [f64; 3] {
        components(&columns[self.columns[pair]..self.columns[pair + 1]])
    }
}

fn components(values: &[f64]) -> [f64; 3] {
    std::array::from_fn(|k| values.get(k).copied().unwrap_or(0.0))
}
