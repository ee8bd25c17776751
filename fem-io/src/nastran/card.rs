//! Cards and their fields.

/// A card of one or several lines. Field 0 is its name, fields 1 to 8 stand on its first line, 9 to 16 on the next ...
#[derive(Debug, Default)]
pub(super) struct Card {
    fields: Vec<String>,
}

/// Fields of a line, without the name and what joins lines.
const PER_LINE: usize = 8;

impl Card {
    /// Whether a line goes on the card before it.
    pub(super) fn goes_on(line: &str) -> bool {
        let first = line.split([',', '\t']).next().unwrap_or_default();
        let first = first.get(..8).unwrap_or(first).trim();
        first.is_empty() || first.starts_with(['+', '*'])
    }

    /// Takes up a line.
    ///
    /// # Errors
    /// A line that cannot be divided into fields, in words.
    pub(super) fn extend(&mut self, line: &str) -> Result<(), String> {
        if !line.is_ascii() {
            return Err("a card may hold ASCII characters alone".to_owned());
        }
        let (first, mut fields, wide) = divide(line);
        if self.fields.is_empty() {
            self.fields.push(first.trim_end_matches('*').to_ascii_uppercase());
        } else {
            // Fields at the end of a line may be left out; a wide line is half of one.
            let half = PER_LINE / 2;
            let step = if wide { half } else { PER_LINE };
            let before = (self.fields.len() - 1).next_multiple_of(step);
            self.fields.resize(1 + before, String::new());
        }
        fields.truncate(if wide { PER_LINE / 2 } else { PER_LINE });
        self.fields.extend(fields);
        Ok(())
    }

    pub(super) fn name(&self) -> &str {
        &self.fields[0]
    }

    /// Field by number, empty where it is left out.
    pub(super) fn field(&self, at: usize) -> &str {
        self.fields.get(at).map_or("", String::as_str)
    }

    /// How many fields there are, with the name.
    pub(super) fn len(&self) -> usize {
        self.fields.len()
    }

    /// A number of a thing, positive.
    pub(super) fn whole(&self, at: usize) -> Result<u64, String> {
        match self.field(at).parse() {
            Ok(number) if number > 0 => Ok(number),
            _ => Err(self.should_be(at, "a positive whole number")),
        }
    }

    /// A number of a thing, or what holds where the field is empty.
    pub(super) fn whole_or(&self, at: usize, default: u64) -> Result<u64, String> {
        match self.field(at) {
            "" => Ok(default),
            text => text.parse().map_err(|_| self.should_be(at, "a whole number")),
        }
    }

    /// A number; 0 where the field is empty.
    pub(super) fn real(&self, at: usize) -> Result<f64, String> {
        match self.field(at) {
            "" => Ok(0.0),
            text => real(text).ok_or_else(|| self.should_be(at, "a number")),
        }
    }

    fn should_be(&self, at: usize, what: &str) -> String {
        format!("field {} of {} is {:?} and should be {what}", at + 1, self.name(), self.field(at))
    }
}

/// Name, fields and whether they are wide.
fn divide(line: &str) -> (String, Vec<String>, bool) {
    let own = |text: &str| text.trim().to_owned();
    if line.contains(',') {
        let mut fields = line.split(',').map(own);
        let name = fields.next().unwrap_or_default();
        let wide = name.ends_with('*') || name.starts_with('*');
        return (name, fields.collect(), wide);
    }
    // A tab goes on to the next field.
    let mut spaced = String::with_capacity(80);
    for c in line.chars() {
        match c {
            '\t' => spaced.extend(std::iter::repeat_n(' ', 8 - spaced.len() % 8)),
            c => spaced.push(c),
        }
    }
    let name = own(spaced.get(..8).unwrap_or(&spaced));
    let wide = name.ends_with('*') || name.starts_with('*');
    let (width, most) = if wide { (16, PER_LINE / 2) } else { (8, PER_LINE) };
    let rest = spaced.get(8..).unwrap_or_default();
    let fields = (0..most).map_while(|i| rest.get(i * width..).filter(|text| !text.is_empty()));
    (name, fields.map(|text| own(text.get(..width).unwrap_or(text))).collect(), wide)
}

/// A number, whose exponent may stand without a letter: 1.5-3.
fn real(text: &str) -> Option<f64> {
    if let Ok(number) = text.parse() {
        return Some(number);
    }
    let text = text.replace(['D', 'd'], "E");
    let sign = text.rfind(['+', '-']).filter(|at| *at > 0 && !text[..*at].ends_with(['E', 'e']));
    match sign {
        Some(at) => format!("{}E{}", &text[..at], &text[at..]).parse().ok(),
        None => text.parse().ok(),
    }
}
