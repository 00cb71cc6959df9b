//! Several runs as one table: what was varied, how each ended, and the stress intensity factors of every tip.

use super::results::{Results, RunStatus, TipResults};
use super::solid_results::SolidResults;
use crate::crack::End;
use serde::Serialize;

/// One run of several.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunRow {
    /// Name of the case.
    pub case: String,
    /// Keys that were set for this run, with their values.
    pub set: Vec<(String, String)>,
    /// How the run ended.
    pub status: RowStatus,
    /// Why it failed or why growth ended, in words.
    pub reason: Option<String>,
    /// Number of steps.
    pub steps: usize,
    /// Load cycles so far, in fatigue.
    pub cycles: Option<f64>,
    /// Tips of the last step.
    pub tips: Vec<RowTip>,
    /// Fronts of a solid.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub fronts: Vec<RowFront>,
    /// Folder of the results.
    pub folder: String,
}

/// How one run of several ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum RowStatus {
    /// As asked for.
    Done,
    /// Early; what was found until then is there.
    Stopped,
    /// Without results.
    Failed,
}

impl RowStatus {
    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Stopped => "stopped",
            Self::Failed => "failed",
        }
    }
}

/// A tip of one run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RowTip {
    /// Name of the crack.
    pub crack: String,
    /// Which end of the crack.
    pub end: End,
    /// Mode I stress intensity factor [stress·√length].
    #[serde(rename = "K_I")]
    pub k1: Option<f64>,
    /// Mode II stress intensity factor [stress·√length].
    #[serde(rename = "K_II")]
    pub k2: Option<f64>,
    /// Error bar of both [stress·√length].
    #[serde(rename = "K_uncertainty")]
    pub k_uncertainty: Option<f64>,
}

/// A front of one run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RowFront {
    /// Name of the crack, and from the second front of a crack on its number: `penny`, `penny-2`.
    pub front: String,
    /// Smallest mode I stress intensity factor along it [stress·√length].
    #[serde(rename = "K_I_min")]
    pub k1_min: Option<f64>,
    /// Largest mode I stress intensity factor along it [stress·√length].
    #[serde(rename = "K_I_max")]
    pub k1_max: Option<f64>,
    /// Error bar where K_I is largest [stress·√length].
    #[serde(rename = "K_uncertainty")]
    pub k_uncertainty: Option<f64>,
}

impl RunRow {
    /// A run of a solid with results.
    pub fn of_solid(case: &str, set: &[(String, String)], folder: &str, results: &SolidResults) -> Self {
        let mut fronts: Vec<RowFront> = vec![];
        for (k, front) in results.fronts.iter().enumerate() {
            let number = 1 + results.fronts[..k].iter().filter(|f| f.crack == front.crack).count();
            let name = if number == 1 { front.crack.clone() } else { format!("{}-{number}", front.crack) };
            let mut known: Vec<_> = front.points.iter().filter_map(|p| Some((p.k1?, p.k_uncertainty))).collect();
            known.sort_by(|a, b| a.0.total_cmp(&b.0));
            fronts.push(RowFront {
                front: name,
                k1_min: known.first().map(|k| k.0),
                k1_max: known.last().map(|k| k.0),
                k_uncertainty: known.last().and_then(|k| k.1),
            });
        }
        let status = match results.status {
            RunStatus::Done => RowStatus::Done,
            RunStatus::Stopped => RowStatus::Stopped,
        };
        Self { status, reason: None, steps: 1, fronts, ..Self::failed(case, set, folder, "") }
    }

    /// A run with results.
    pub fn new(case: &str, set: &[(String, String)], folder: &str, results: &Results) -> Self {
        let last = results.steps.last();
        let tip = |crack: &str, tip: &TipResults| RowTip {
            crack: crack.into(),
            end: tip.end,
            k1: tip.k1,
            k2: tip.k2,
            k_uncertainty: tip.k_uncertainty,
        };
        Self {
            case: case.into(),
            set: set.to_vec(),
            status: match results.status {
                RunStatus::Done => RowStatus::Done,
                RunStatus::Stopped => RowStatus::Stopped,
            },
            reason: results.growth_end.as_ref().map(|end| end.reason.clone()),
            steps: results.steps.len(),
            cycles: last.and_then(|s| s.cycles),
            tips: last
                .map_or(vec![], |s| s.cracks.iter().flat_map(|c| c.tips.iter().map(|t| tip(&c.name, t))).collect()),
            fronts: vec![],
            folder: folder.into(),
        }
    }

    /// A run that found nothing.
    pub fn failed(case: &str, set: &[(String, String)], folder: &str, reason: &str) -> Self {
        Self {
            case: case.into(),
            set: set.to_vec(),
            status: RowStatus::Failed,
            reason: Some(reason.into()),
            steps: 0,
            cycles: None,
            tips: vec![],
            fronts: vec![],
            folder: folder.into(),
        }
    }

    /// The value of a key, if it was set for this run.
    pub fn value(&self, key: &str) -> Option<&str> {
        self.set.iter().find(|s| s.0 == key).map(|s| s.1.as_str())
    }

    /// A front by name.
    pub fn front(&self, name: &str) -> Option<&RowFront> {
        self.fronts.iter().find(|f| f.front == name)
    }

    /// The tip at one end of a crack.
    pub fn tip(&self, crack: &str, end: End) -> Option<&RowTip> {
        self.tips.iter().find(|t| t.crack == crack && t.end == end)
    }
}

/// All keys that were set in any of the runs, in the order in which they come.
pub fn keys(rows: &[RunRow]) -> Vec<String> {
    distinct(rows.iter().flat_map(|r| r.set.iter().map(|s| s.0.clone())))
}

/// All tips of any of the runs, in the order in which they come.
pub fn tips(rows: &[RunRow]) -> Vec<(String, End)> {
    distinct(rows.iter().flat_map(|r| r.tips.iter().map(|t| (t.crack.clone(), t.end))))
}

/// Names of all fronts of any of the runs, in the order in which they come.
pub fn fronts(rows: &[RunRow]) -> Vec<String> {
    distinct(rows.iter().flat_map(|r| r.fronts.iter().map(|f| f.front.clone())))
}

fn distinct<T: PartialEq>(items: impl Iterator<Item = T>) -> Vec<T> {
    let mut list = vec![];
    for item in items {
        if !list.contains(&item) {
            list.push(item);
        }
    }
    list
}

/// The table as CSV, one run a line; what is not known is empty.
pub fn table_csv(rows: &[RunRow]) -> String {
    let (keys, tips, fronts) = (keys(rows), tips(rows), fronts(rows));
    let mut head = vec!["case".to_string()];
    head.extend(keys.iter().cloned());
    head.extend(["status", "reason", "steps", "cycles"].map(String::from));
    for (crack, end) in &tips {
        let name = end_name(*end);
        head.extend(["K_I", "K_II", "K_uncertainty"].map(|k| format!("{crack}.{name}.{k}")));
    }
    for name in &fronts {
        head.extend(["K_I_min", "K_I_max", "K_uncertainty"].map(|k| format!("{name}.{k}")));
    }
    head.push("folder".into());
    let mut writer = csv::Writer::from_writer(vec![]);
    let mut write = |record: &[String]| writer.write_record(record).expect("a vector takes all");
    write(&head);
    let number = |v: Option<f64>| v.map_or(String::new(), |v| v.to_string());
    for row in rows {
        let mut record = vec![row.case.clone()];
        record.extend(keys.iter().map(|k| row.value(k).unwrap_or_default().to_string()));
        record.extend([row.status.name().into(), row.reason.clone().unwrap_or_default(), row.steps.to_string()]);
        record.push(number(row.cycles));
        for (crack, end) in &tips {
            let tip = row.tip(crack, *end);
            record.extend([tip.and_then(|t| t.k1), tip.and_then(|t| t.k2)].map(number));
            record.push(number(tip.and_then(|t| t.k_uncertainty)));
        }
        for name in &fronts {
            let front = row.front(name);
            record.extend([front.and_then(|f| f.k1_min), front.and_then(|f| f.k1_max)].map(number));
            record.push(number(front.and_then(|f| f.k_uncertainty)));
        }
        record.push(row.folder.clone());
        write(&record);
    }
    String::from_utf8(writer.into_inner().expect("a vector takes all")).expect("text was written")
}

/// `start` or `end`.
pub fn end_name(end: End) -> &'static str {
    match end {
        End::Start => "start",
        End::End => "end",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_with_other_tips_share_a_table() {
        let tip = |crack: &str, k1| RowTip { crack: crack.into(), end: End::End, k1, k2: None, k_uncertainty: None };
        let set = [("a".to_string(), "1,5".to_string())];
        let mut first = RunRow::failed("plate", &set, "out/1", "no \"sense\"");
        first.tips = vec![tip("left", Some(2.5))];
        let mut second = RunRow::failed("strip", &[], "out/2", "late");
        second.tips = vec![tip("right", None)];
        let expected = "case,a,status,reason,steps,cycles,left.end.K_I,left.end.K_II,left.end.K_uncertainty,\
            right.end.K_I,right.end.K_II,right.end.K_uncertainty,folder\n\
            plate,\"1,5\",failed,\"no \"\"sense\"\"\",0,,2.5,,,,,,out/1\n\
            strip,,failed,late,0,,,,,,,,out/2\n";
        assert_eq!(table_csv(&[first, second]), expected);
    }
}
