//! Pictures of a folder that may be anyone's, as the page takes them.

use minijinja::HtmlEscape;
use roxmltree::{Document, Node, ParsingOptions};
use std::fmt::Write as _;

const SVG: &str = "http://www.w3.org/2000/svg";

/// Most elements and texts of a picture.
const MAX_NODES: u32 = 1 << 21;

/// Elements of our own drawings with their attributes: nothing else gets onto the page.
const ELEMENTS: [(&str, &[&str]); 7] = [
    ("svg", &["width", "height", "viewBox", "role", "font-family", "stroke-linejoin"]),
    ("title", &[]),
    ("rect", &["width", "height", "fill"]),
    ("polyline", &["fill", "stroke", "stroke-width", "stroke-dasharray", "points"]),
    ("circle", &["cx", "cy", "r", "fill"]),
    ("path", &["fill", "stroke", "d"]),
    ("text", &["x", "y", "font-size", "fill", "text-anchor", "transform"]),
];

/// The drawing in `svg`, parsed and written anew of what our own drawings are made of; the error says what else is in it.
///
/// Names come from [`ELEMENTS`], values have no character that could end them or address anything, texts are escaped: what
/// is written cannot be read as anything else, whatever `svg` was.
pub(super) fn redraw(svg: &str) -> Result<String, String> {
    let limits = ParsingOptions { nodes_limit: MAX_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(svg, limits).map_err(|why| why.to_string())?;
    let root = document.root_element();
    if root.tag_name().name() != "svg" {
        return Err(format!("its root is <{}>", root.tag_name().name()));
    }
    let mut out = format!("<svg xmlns=\"{SVG}\"");
    write_inside(&mut out, root, "svg")?;
    Ok(out)
}

fn write(out: &mut String, node: Node<'_, '_>) -> Result<(), String> {
    if let Some(text) = node.text().filter(|_| node.is_text()) {
        // Writing to a string cannot fail.
        let _ = write!(out, "{}", HtmlEscape(text));
    }
    if node.is_element() {
        let name = node.tag_name().name();
        let (name, _) = ELEMENTS[1..].iter().find(|known| known.0 == name).ok_or_else(|| format!("<{name}>"))?;
        let _ = write!(out, "<{name}");
        write_inside(out, node, name)?;
    }
    Ok(())
}

/// Attributes and content of the element `name`, whose tag is begun.
fn write_inside(out: &mut String, node: Node<'_, '_>, name: &'static str) -> Result<(), String> {
    let (_, known) = ELEMENTS.iter().find(|known| known.0 == name).ok_or(name)?;
    if node.tag_name().namespace() != Some(SVG) {
        return Err(format!("<{name}> that is not of SVG"));
    }
    for attribute in node.attributes() {
        let own = known.iter().find(|known| attribute.namespace().is_none() && **known == attribute.name());
        let value = attribute.value();
        match own {
            Some(own) if is_harmless(own, value) => drop(write!(out, " {own}=\"{value}\"")),
            _ => return Err(format!("{}=\"{value}\" of <{name}>", attribute.name())),
        }
    }
    out.push('>');
    // Nothing in a drawing of ours lies deeper.
    if name != "svg" && node.children().any(|child| child.is_element()) {
        return Err(format!("an element in <{name}>"));
    }
    node.children().try_for_each(|child| write(out, child))?;
    let _ = write!(out, "</{name}>");
    Ok(())
}

/// Whether a value is made of numbers, colours, names and what separates them; `(` belongs to a transform alone, so that no
/// `url(...)` is left.
fn is_harmless(attribute: &str, value: &str) -> bool {
    let more = if attribute == "transform" { "()" } else { "" };
    value.chars().all(|c| c.is_ascii_alphanumeric() || " \n#.,'+-".contains(c) || more.contains(c))
        && !value.contains("url")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use fem_io::plot;

    fn drawing(inside: &str) -> String {
        format!("<svg xmlns=\"{SVG}\" width=\"1\">\n{inside}\n</svg>\n")
    }

    /// All elements and attributes in the order in which they stand, all texts.
    fn content(svg: &str) -> Vec<String> {
        let document = Document::parse(svg).unwrap();
        let each = |node: Node<'_, '_>| {
            let attributes = node.attributes().map(|a| format!("{}={}", a.name(), a.value())).collect::<Vec<_>>();
            format!("{} {attributes:?} {:?}", node.tag_name().name(), node.text())
        };
        document.descendants().filter(Node::is_element).map(each).collect()
    }

    #[test]
    fn our_own_drawings_stay_what_they_are() {
        let forces = [0.0, 2.0, 1.0];
        let marks = [(1e-3, "a <b> & \"c\"".to_owned())];
        let curves = ["a", "b"].map(|name| (name, forces.to_vec()));
        let plot = plot::force_history("<Title> & 'more'", &[0.0, 1e-3, 2e-3], &curves, &marks);
        let svg = plot::line_plot(&plot.unwrap()).unwrap().svg;
        let again = redraw(&svg).unwrap();
        assert_eq!(content(&again), content(&svg));
        assert_eq!(redraw(&again).unwrap(), again);
    }

    #[test]
    fn whatever_else_is_in_a_picture_is_refused() {
        for good in
            ["<title>on a &lt;b</title>", "<text x='1'>onload= href</text>", "<path d=\"M0,0Z\"/><circle r=\"1\"/>"]
        {
            redraw(&drawing(good)).unwrap();
        }
        let script = redraw(&drawing("<text>&lt;script&gt;&amp;lt;</text>")).unwrap();
        assert!(script.contains("<text>&lt;script&gt;&amp;lt;</text>"), "{script}");
        assert!(!redraw(&drawing("<!-- <script> --><text><![CDATA[<script>]]></text>")).unwrap().contains("<script"));
        let bad = [
            "<script>1</script>",
            "<rect/onload=x>",
            "<rect onload=\"x\"/>",
            "<rect onload='x'/>",
            "<rect\nONLOAD=\"x\"/>",
            "<rect width='1' onload='x'/>",
            "<a href=\"x\"/>",
            "<text xlink:href=\"x\"/>",
            "<text xmlns:x='http://www.w3.org/1999/xlink' x:href='javascript:1'/>",
            "<text style='x'/>",
            "<rect fill='url(x)'/>",
            "<text transform='url(x)'/>",
            "<rect fill='a&quot; onload=&quot;x'/>",
            "<title xmlns='http://www.w3.org/1999/xhtml'/>",
            "<svg onload='x'/>",
            "<text><text/></text>",
            "<foreignObject/>",
            "<animate/>",
            "<use/>",
            "<style>*{}</style>",
            "<text",
        ];
        for bad in bad {
            assert!(redraw(&drawing(bad)).is_err(), "{bad}");
        }
        for bad in ["<svg xmlns=\"\"><text>cut", "<svg/>", "<html/>", "", "<!DOCTYPE svg [<!ENTITY a 'b'>]><svg/>"] {
            assert!(redraw(bad).is_err(), "{bad}");
        }
        assert!(redraw(&format!("<svg xmlns='{SVG}' onload='x'/>")).is_err());
        // As deep as a parser without a limit would not survive.
        assert!(redraw(&drawing(&"<text>".repeat(100_000))).is_err());
    }
}
