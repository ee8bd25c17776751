//! A drawing as an SVG document.

use super::shapes::{Anchor, Color, DASH, Drawing, Shape, Text};
use std::fmt::{self, Write};

/// The document; words stay text, in the reader's own sans-serif font.
pub(super) fn render(drawing: &Drawing) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = write_document(&mut out, drawing);
    out
}

fn write_document(out: &mut String, drawing: &Drawing) -> fmt::Result {
    let (width, height) = (Px(drawing.width), Px(drawing.height));
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         role=\"img\" font-family=\"Ubuntu, 'Segoe UI', 'Helvetica Neue', Arial, sans-serif\" stroke-linejoin=\"round\">\n\
         <title>{}</title>\n<rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>",
        Escaped(&drawing.title)
    )?;
    for shape in &drawing.shapes {
        match shape {
            Shape::Line { points, color, width, dashed } => {
                write!(out, "<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"", Hex(*color), Px(*width))?;
                if *dashed {
                    write!(out, " stroke-dasharray=\"{} {}\"", Px(DASH[0]), Px(DASH[1]))?;
                }
                out.push_str(" points=\"");
                for (i, p) in points.iter().enumerate() {
                    write!(out, "{}{},{}", if i == 0 { "" } else { " " }, Px(p[0]), Px(p[1]))?;
                }
                out.push_str("\"/>\n");
            }
            Shape::Dot { centre: [x, y], radius, color } => {
                let (x, y, r, color) = (Px(*x), Px(*y), Px(*radius), Hex(*color));
                writeln!(out, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\" fill=\"{color}\"/>")?;
            }
            Shape::Polygons { rings, fill, edge } => {
                write!(out, "<path fill=\"{}\" stroke=\"{}\" d=\"", Hex(*fill), Hex(*edge))?;
                for ring in rings {
                    for (i, p) in ring.iter().enumerate() {
                        write!(out, "{}{},{}", if i == 0 { 'M' } else { 'L' }, Px(p[0]), Px(p[1]))?;
                    }
                    out.push('Z');
                }
                out.push_str("\"/>\n");
            }
            Shape::Text(text) => write_text(out, text)?,
        }
    }
    out.push_str("</svg>\n");
    Ok(())
}

fn write_text(out: &mut String, text: &Text) -> fmt::Result {
    let (x, y) = (Px(text.at[0]), Px(text.at[1]));
    write!(out, "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\" fill=\"{}\"", Px(text.size), Hex(text.color))?;
    match text.anchor {
        Anchor::Start => {}
        Anchor::Middle => out.push_str(" text-anchor=\"middle\""),
        Anchor::End => out.push_str(" text-anchor=\"end\""),
    }
    if text.upwards {
        write!(out, " transform=\"rotate(-90 {x} {y})\"")?;
    }
    writeln!(out, ">{}</text>", Escaped(&text.text))
}

/// A length to a tenth of a pixel.
struct Px(f64);

impl fmt::Display for Px {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Adding zero turns −0 into 0.
        write!(f, "{}", (self.0 * 10.0).round() / 10.0 + 0.0)
    }
}

struct Hex(Color);

impl fmt::Display for Hex {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [r, g, b] = self.0;
        write!(f, "#{r:02x}{g:02x}{b:02x}")
    }
}

struct Escaped<'a>(&'a str);

impl fmt::Display for Escaped<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for c in self.0.chars() {
            match c {
                '&' => f.write_str("&amp;")?,
                '<' => f.write_str("&lt;")?,
                '>' => f.write_str("&gt;")?,
                // Which XML does not take.
                c if c.is_control() => f.write_char(char::REPLACEMENT_CHARACTER)?,
                c => f.write_char(c)?,
            }
        }
        Ok(())
    }
}
