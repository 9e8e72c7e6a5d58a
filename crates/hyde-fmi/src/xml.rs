//! [`Xml`]: elements and attributes as text. A model description is a few kinds of elements without text in them.

/// A document that is being written.
pub(crate) struct Xml {
    text: String,
    open: Vec<&'static str>,
    /// Where the text of the element that was opened last begins.
    within: usize,
}

/// Attributes; those without a value are left out.
pub(crate) type Attributes<'a> = &'a [(&'a str, Option<String>)];

impl Xml {
    pub(crate) fn new() -> Self {
        Self {
            text: "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n".to_owned(),
            open: Vec::new(),
            within: 0,
        }
    }

    /// An element with others in it, to be closed.
    pub(crate) fn open(&mut self, name: &'static str, attributes: Attributes<'_>) {
        self.begin(name, attributes);
        self.text.push_str(">\n");
        self.open.push(name);
        self.within = self.text.len();
    }

    /// An element with none in it.
    pub(crate) fn leaf(&mut self, name: &'static str, attributes: Attributes<'_>) {
        self.begin(name, attributes);
        self.text.push_str("/>\n");
    }

    /// Closes the element that was opened last; one with nothing in it becomes a leaf.
    pub(crate) fn close(&mut self) {
        if let Some(name) = self.open.pop() {
            if self.text.len() == self.within {
                self.text.truncate(self.within - ">\n".len());
                self.text.push_str("/>\n");
                return;
            }
            self.indent();
            self.text.push_str("</");
            self.text.push_str(name);
            self.text.push_str(">\n");
        }
    }

    /// The document, with all elements closed.
    pub(crate) fn finish(mut self) -> String {
        while !self.open.is_empty() {
            self.close();
        }
        self.text
    }

    fn begin(&mut self, name: &str, attributes: Attributes<'_>) {
        self.indent();
        self.text.push('<');
        self.text.push_str(name);
        for (attribute, value) in attributes {
            let Some(value) = value else { continue };
            self.text.push(' ');
            self.text.push_str(attribute);
            self.text.push_str("=\"");
            for c in value.chars() {
                match c {
                    '&' => self.text.push_str("&amp;"),
                    '<' => self.text.push_str("&lt;"),
                    '>' => self.text.push_str("&gt;"),
                    '"' => self.text.push_str("&quot;"),
                    '\n' | '\r' | '\t' => self.text.push(' '),
                    c if c.is_control() => {}
                    c => self.text.push(c),
                }
            }
            self.text.push('"');
        }
    }

    fn indent(&mut self) {
        for _ in &self.open {
            self.text.push_str("  ");
        }
    }
}

/// A value of an attribute.
pub(crate) fn some(value: impl ToString) -> Option<String> {
    Some(value.to_string())
}

/// A number, as XML Schema writes doubles: what Rust prints is read back to the same bits.
pub(crate) fn number(value: f64) -> String {
    if value.is_nan() {
        "NaN".to_owned()
    } else if value.is_infinite() {
        if value > 0.0 { "INF" } else { "-INF" }.to_owned()
    } else {
        format!("{value:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_escaped_and_numbers_read_back() {
        let mut xml = Xml::new();
        xml.open("a", &[("of", some("x < \"y\" & z")), ("left", None)]);
        xml.leaf("b", &[]);
        let text = xml.finish();
        let document = text.split_once('\n').map_or("", |(_, rest)| rest);
        assert_eq!(
            document,
            "<a of=\"x &lt; &quot;y&quot; &amp; z\">\n  <b/>\n</a>\n"
        );
        for value in [0.1, 1e-300, 123_456_789.123, -0.0] {
            let read: f64 = number(value).parse().unwrap();
            assert_eq!(read.to_bits(), value.to_bits());
        }
    }
}
