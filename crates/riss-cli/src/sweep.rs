//! `--sweep KEY=VALUES`: the values of a key, one run each.

/// More runs than this are a slip.
pub const MOST_RUNS: usize = 10_000;

/// A key and the values it takes in turn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sweep {
    /// Key of the case, or name of a parameter.
    pub key: String,
    /// Values as they would stand after `--set KEY=`.
    pub values: Vec<String>,
}

impl Sweep {
    /// Reads `KEY=FROM..TO:STEP` or `KEY=VALUE,VALUE,...`.
    ///
    /// # Errors
    /// Says what is wrong with it.
    pub fn parse(text: &str) -> Result<Self, String> {
        let forms = "write KEY=FROM..TO:STEP, such as crack[0].path[1][0]=1..5:0.5, or KEY=VALUE,VALUE";
        let (key, values) = text.split_once('=').ok_or(forms)?;
        let (key, values) = (key.trim(), values.trim());
        if key.is_empty() || values.is_empty() {
            return Err(forms.into());
        }
        let values = match values.split_once("..") {
            Some((from, rest)) if !values.contains(['\'', '"', '[']) => range(from, rest)?,
            _ => list(values),
        };
        if values.iter().any(|v| v.is_empty()) {
            return Err("a value is missing between two commas".into());
        }
        Ok(Self { key: key.into(), values })
    }
}

/// Every combination of the values; the last key changes fastest.
///
/// # Errors
/// If there are too many, or a key comes twice.
pub fn combinations(sweeps: &[Sweep]) -> Result<Vec<Vec<(String, String)>>, String> {
    for (k, sweep) in sweeps.iter().enumerate() {
        if sweeps[..k].iter().any(|s| s.key == sweep.key) {
            return Err(format!("--sweep {0} comes twice; give all values of {0} at once", sweep.key));
        }
    }
    let n = sweeps.iter().try_fold(1usize, |n, s| n.checked_mul(s.values.len()));
    if n.is_none_or(|n| n > MOST_RUNS) {
        return Err(format!("this sweep has more than {MOST_RUNS} runs"));
    }
    let mut all = vec![vec![]];
    for sweep in sweeps {
        let longer = |set: &Vec<(String, String)>| {
            let with = |value: &String| set.iter().cloned().chain([(sweep.key.clone(), value.clone())]).collect();
            sweep.values.iter().map(with).collect::<Vec<_>>()
        };
        all = all.iter().flat_map(longer).collect();
    }
    Ok(all)
}

fn range(from: &str, rest: &str) -> Result<Vec<String>, String> {
    let (to, step) = rest.split_once(':').ok_or("a range ends with its step, such as 1..5:0.5")?;
    let number = |text: &str| match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!("`{}` is no number", text.trim())),
    };
    let (from, to, step) = (number(from)?, number(to)?, number(step)?);
    let n = (to - from) / step;
    if step == 0.0 || n < 0.0 {
        return Err(format!("steps of {step} do not lead from {from} to {to}"));
    }
    if n >= MOST_RUNS as f64 {
        return Err(format!("this range has more than {MOST_RUNS} values"));
    }
    // The end is a value too, although steps such as 0.1 add up to slightly less or more.
    let count = (n + 1e-9).floor() as usize;
    Ok((0..=count).map(|k| rounded(from + k as f64 * step).to_string()).collect())
}

/// Twelve digits: 0.3, not 0.30000000000000004.
fn rounded(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

/// Splits at commas outside brackets and quotes.
fn list(text: &str) -> Vec<String> {
    let mut values = vec![String::new()];
    let (mut depth, mut quote) = (0i32, None);
    for c in text.chars() {
        match (c, quote) {
            ('\'' | '"', None) => quote = Some(c),
            (_, Some(q)) if c == q => quote = None,
            ('[' | '{', None) => depth += 1,
            (']' | '}', None) => depth -= 1,
            (',', None) if depth == 0 => {
                values.push(String::new());
                continue;
            }
            _ => {}
        }
        values.last_mut().expect("never empty").push(c);
    }
    values.iter().map(|v| v.trim().to_string()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_values(text: &str, values: &[&str]) {
        assert_eq!(Sweep::parse(text).map(|s| s.values), Ok(values.iter().map(|v| v.to_string()).collect()), "{text}");
    }

    #[test]
    fn ranges_hold_both_ends() {
        check_values("a=1..3:0.5", &["1", "1.5", "2", "2.5", "3"]);
        check_values("a=0.1..0.4:0.1", &["0.1", "0.2", "0.3", "0.4"]);
        check_values("a=1..-1:-1", &["1", "0", "-1"]);
        check_values("a=1..2:0.4", &["1", "1.4", "1.8"]);
        check_values("material.young=70e9..210e9:70e9", &["70000000000", "140000000000", "210000000000"]);
    }

    #[test]
    fn lists_hold_names_quantities_and_points() {
        check_values("approximation.basis=linear, quadratic", &["linear", "quadratic"]);
        check_values("crack[0].path[1]=[1, 2],[3, 4]", &["[1, 2]", "[3, 4]"]);
        check_values("a=10 mm,1 in", &["10 mm", "1 in"]);
        check_values("title='a, b',c", &["'a, b'", "c"]);
    }

    #[test]
    fn slips_are_refused() {
        for text in ["a", "=1..2:1", "a=", "a=1..2", "a=1..2:0", "a=1..2:-1", "a=1..x:1", "a=0..1:1e-9", "a=1,,2"] {
            assert!(Sweep::parse(text).is_err(), "{text}");
        }
        let sweep = |text: &str| Sweep::parse(text).expect("valid");
        assert!(combinations(&[sweep("a=1,2"), sweep("a=3")]).is_err());
        assert!(combinations(&[sweep("a=1..200:1"), sweep("b=1..200:1")]).is_err());
    }

    #[test]
    fn the_last_key_changes_fastest() {
        let all = combinations(&[Sweep::parse("a=1,2").unwrap(), Sweep::parse("b=x,y").unwrap()]).unwrap();
        let texts: Vec<String> = all.iter().map(|set| format!("{}{}", set[0].1, set[1].1)).collect();
        assert_eq!(texts, ["1x", "1y", "2x", "2y"]);
    }
}
