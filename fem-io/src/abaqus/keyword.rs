//! A line that begins with a keyword.

/// `*NAME, KEY=VALUE, FLAG`
#[derive(Debug)]
pub(super) struct Keyword<'t> {
    /// In capitals, with single spaces.
    pub(super) name: String,
    /// Keys in capitals.
    parameters: Vec<(String, Option<&'t str>)>,
}

impl<'t> Keyword<'t> {
    /// # Errors
    /// A line that is none, in words.
    pub(super) fn read(text: &'t [u8]) -> Result<Self, String> {
        let text = std::str::from_utf8(text).map_err(|_| "the line is not UTF-8")?;
        let mut items = split(text).into_iter();
        let name = items.next().unwrap_or_default().trim_start_matches('*');
        let parameters = items.map(|item| match item.split_once('=') {
            Some((key, value)) => (spaced(key), Some(value.trim().trim_matches('"'))),
            None => (spaced(item), None),
        });
        Ok(Self { name: spaced(name), parameters: parameters.collect() })
    }

    pub(super) fn value(&self, key: &str) -> Option<&'t str> {
        self.parameters.iter().find(|(known, _)| known == key)?.1
    }

    pub(super) fn has(&self, key: &str) -> bool {
        self.parameters.iter().any(|(known, _)| known == key)
    }
}

/// In capitals, with single spaces.
fn spaced(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ").to_uppercase()
}

/// Items between commas outside of quotes.
fn split(text: &str) -> Vec<&str> {
    let mut quoted = false;
    text.split(|c| {
        quoted ^= c == '"';
        c == ',' && !quoted
    })
    .map(str::trim)
    .collect()
}
