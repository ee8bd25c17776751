//! Words that are not known, and what may have been meant.

/// "is not known", the nearest match if there is one, and the list.
pub fn unknown_key<'a>(key: &str, known: impl Iterator<Item = &'a str>) -> String {
    let known: Vec<_> = known.collect();
    let length = key.chars().count();
    let most = |k: &str| 1 + k.len().max(key.len()) / 3;
    // Words of very different length differ by as much, however long they are.
    let comparable = known.iter().filter(|k| k.chars().count().abs_diff(length) <= most(k));
    let nearest = comparable.map(|k| (edit_distance(key, k), *k)).min().filter(|(d, k)| *d <= most(k));
    let hint = nearest.map_or(String::new(), |(_, k)| format!("; did you mean `{k}`?"));
    if known.is_empty() {
        "is not known: nothing can be set here".to_owned()
    } else {
        format!("is not known{hint} (known: {})", known.join(", "))
    }
}

fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, cb) in b.iter().enumerate() {
            let substitute = diagonal + usize::from(ca != *cb);
            diagonal = row[j + 1];
            row[j + 1] = substitute.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_of_any_length_is_compared_in_no_time() {
        let said = unknown_key(&"k".repeat(1 << 24), ["k", "kk"].into_iter());
        assert_eq!(said, "is not known (known: k, kk)");
    }
}
