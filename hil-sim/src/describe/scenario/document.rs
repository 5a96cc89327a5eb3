//! Where in a TOML text a field stands.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A parsed TOML text that can tell the line of a field.
pub struct Document<'a> {
    text: &'a str,
    root: Spanned<DeTable<'a>>,
}

impl<'a> Document<'a> {
    /// Parses `text`.
    ///
    /// # Errors
    /// The line and what is wrong with the text as TOML.
    pub fn parse(text: &'a str) -> Result<Self, (usize, String)> {
        match DeTable::parse(text) {
            Ok(root) => Ok(Self { text, root }),
            Err(error) => Err((line_at(text, error.span().map_or(0, |span| span.start)), error.message().to_owned())),
        }
    }

    /// The line, from 1, of the field with this path (as in `path.radius` or `poles[0][2]`), or of
    /// the innermost of its parents that is there.
    #[must_use]
    pub fn line_of(&self, field: &str) -> usize {
        let mut start = 0;
        let mut table = Some(self.root.get_ref());
        let mut value: Option<&DeValue<'_>> = None;
        for step in field.split(['.', '[']).filter(|step| !step.is_empty()) {
            let next = match (table, value, step.trim_end_matches(']').parse::<usize>()) {
                (Some(table), ..) => table.get_key_value(step).map(|(key, value)| (key.span().start, value)),
                (None, Some(DeValue::Array(items)), Ok(index)) => {
                    items.get(index).map(|item| (item.span().start, item))
                }
                _ => None,
            };
            let Some((at, found)) = next else { break };
            start = at;
            value = Some(found.get_ref());
            table = found.get_ref().as_table();
        }
        line_at(self.text, start)
    }
}

fn line_at(text: &str, offset: usize) -> usize {
    1 + text.bytes().take(offset).filter(|&byte| byte == b'\n').count()
}

#[cfg(test)]
mod tests {
    use super::Document;

    #[test]
    fn finds_the_line_of_a_field_or_of_its_nearest_parent() {
        let text = "a = 1\n[b.c]\nd = [\n  1,\n  2,\n]\ne = { f = 3 }\n";
        let document = Document::parse(text).unwrap();
        for (field, line) in
            [("a", 1), ("b.c", 2), ("b.c.d", 3), ("b.c.d[1]", 5), ("b.c.e.f", 7), ("b.c.e.g", 7), ("h", 1)]
        {
            assert_eq!(document.line_of(field), line, "{field}");
        }
    }

    #[test]
    fn a_text_that_is_not_toml_is_refused_with_its_line() {
        let (line, _) = Document::parse("a = 1\nb = = 2\n").err().unwrap();
        assert_eq!(line, 2);
    }
}
