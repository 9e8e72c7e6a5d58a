//! HTML: texts made safe, tables, and the frame of a page.

const STYLE: &str = include_str!("style.css");

/// `text` between tags or in an attribute.
pub(super) fn escaped(text: &str) -> String {
    hyde_report::escape(text)
}

/// A text with its `` `words` `` as code.
pub(super) fn code(text: &str) -> String {
    let parts = text.split('`').enumerate();
    let marked = text.matches('`').count().is_multiple_of(2);
    if !marked {
        return escaped(text);
    }
    parts
        .map(|(number, part)| match number % 2 {
            0 => escaped(part),
            _ => format!("<code>{}</code>", escaped(part)),
        })
        .collect()
}

/// A documentation string: paragraphs between empty lines.
pub(super) fn documentation(text: &str) -> String {
    let paragraphs = text.split("\n\n").map(str::trim);
    paragraphs
        .filter(|paragraph| !paragraph.is_empty())
        .map(|paragraph| format!("<p>{}</p>\n", code(paragraph)))
        .collect()
}

/// The first sentence of a documentation string.
pub(super) fn first_sentence(text: &str) -> String {
    let first = text.split("\n\n").next().unwrap_or_default();
    code(first.split(". ").next().unwrap_or_default())
}

/// A table of cells that are HTML; columns without a cell are left out.
pub(super) fn table(heads: &[&str], rows: &[Vec<String>]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let used: Vec<usize> = (0..heads.len())
        .filter(|&column| rows.iter().any(|row| !row[column].is_empty()))
        .collect();
    let head: String = used
        .iter()
        .map(|&column| format!("<th>{}</th>", heads[column]))
        .collect();
    let head = if used.iter().all(|&column| heads[column].is_empty()) {
        String::new()
    } else {
        format!("<thead><tr>{head}</tr></thead>")
    };
    let body: String = rows
        .iter()
        .map(|row| {
            let cells: String = used
                .iter()
                .map(|&column| format!("<td>{}</td>", row[column]))
                .collect();
            format!("<tr>{cells}</tr>\n")
        })
        .collect();
    format!("<div class=\"scroll\"><table>{head}<tbody>\n{body}</tbody></table></div>\n")
}

/// A page with its heading, what stands above it and below.
pub(super) fn page(title: &str, above: &str, body: &str) -> String {
    let title = escaped(title);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n{above}<main>\n<h1>{title}</h1>\n\
         {body}</main>\n</body>\n</html>\n"
    )
}
