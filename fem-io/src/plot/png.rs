//! A drawing as a PNG file.

use super::shapes::{Anchor, Color, DASH, Drawing, Shape, Text};
use tiny_skia::{FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Stroke, StrokeDash, Transform};
use ttf_parser::{Face, OutlineBuilder};

/// Pixels per unit of a drawing: as wide as pages show it. For print, and to look at closely, there is the SVG file.
const SCALE: f32 = 0.75;

/// Why a drawing does not become a PNG file.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PngError {
    /// The size of the drawing is not one of a picture.
    #[error("{width} x {height} pixels is not a size")]
    #[allow(missing_docs)]
    Size { width: u32, height: u32 },
    /// The font of the program cannot be read.
    #[error("the font cannot be read: {0}")]
    Font(#[from] ttf_parser::FaceParsingError),
    /// The pixels cannot be encoded.
    #[error("the pixels cannot be encoded: {0}")]
    Encoding(String),
}

/// The file.
pub(super) fn render(drawing: &Drawing) -> Result<Vec<u8>, PngError> {
    let face = face()?;
    let [width, height] = [drawing.width, drawing.height].map(|size| (size as f32 * SCALE).ceil() as u32);
    let whole = Transform::from_scale(SCALE, SCALE);
    let mut pixels = Pixmap::new(width, height).ok_or(PngError::Size { width, height })?;
    pixels.fill(tiny_skia::Color::WHITE);
    for shape in &drawing.shapes {
        match shape {
            Shape::Line { points, color, width, dashed } => {
                if let Some(path) = polyline(points) {
                    let stroke = Stroke {
                        width: *width as f32,
                        line_cap: LineCap::Butt,
                        line_join: LineJoin::Round,
                        dash: if *dashed { StrokeDash::new(DASH.map(|d| d as f32).to_vec(), 0.0) } else { None },
                        ..Stroke::default()
                    };
                    pixels.stroke_path(&path, &paint(*color), &stroke, whole, None);
                }
            }
            Shape::Dot { centre: [x, y], radius, color } => {
                if let Some(path) = PathBuilder::from_circle(*x as f32, *y as f32, *radius as f32) {
                    fill(&mut pixels, &path, *color, whole);
                }
            }
            Shape::Polygons { rings, fill: inside, edge } => {
                let outlines = rings.iter().filter_map(|ring| polyline(&[&ring[..], &ring[..1]].concat()));
                for outline in outlines {
                    // The line along its edges smooths them.
                    let plain = Paint { anti_alias: false, ..paint(*inside) };
                    pixels.fill_path(&outline, &plain, FillRule::Winding, whole, None);
                    pixels.stroke_path(&outline, &paint(*edge), &Stroke::default(), whole, None);
                }
            }
            Shape::Text(text) => draw_text(&mut pixels, &face, text),
        }
    }
    encode(&pixels).map_err(|e| PngError::Encoding(e.to_string()))
}

/// As RGB, all of it being opaque, and compressed fast: tiny-skia's own way takes several times as long as to draw.
fn encode(pixels: &Pixmap) -> Result<Vec<u8>, png::EncodingError> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, pixels.width(), pixels.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::Fast);
    let mut writer = encoder.write_header()?;
    let mut rgb = vec![0; pixels.data().len() / 4 * 3];
    for (to, from) in rgb.as_chunks_mut::<3>().0.iter_mut().zip(pixels.data().as_chunks::<4>().0) {
        to.copy_from_slice(&from[..3]);
    }
    writer.write_image_data(&rgb)?;
    writer.finish()?;
    Ok(file)
}

/// Width of `text` in the embedded font, pixels.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    face().map_or(0.0, |face| text.chars().map(|c| f64::from(advance(&face, c))).sum::<f64>() * size / em(&face))
}

fn face() -> Result<Face<'static>, ttf_parser::FaceParsingError> {
    Face::parse(epaint_default_fonts::UBUNTU_LIGHT, 0)
}

fn em(face: &Face<'_>) -> f64 {
    f64::from(face.units_per_em())
}

fn advance(face: &Face<'_>, c: char) -> u16 {
    face.glyph_hor_advance(face.glyph_index(c).unwrap_or_default()).unwrap_or_default()
}

fn draw_text(pixels: &mut Pixmap, face: &Face<'_>, text: &Text) {
    let mut outline = Outline { path: PathBuilder::new(), x: 0.0 };
    for c in text.text.chars() {
        face.outline_glyph(face.glyph_index(c).unwrap_or_default(), &mut outline);
        outline.x += f32::from(advance(face, c));
    }
    let width = outline.x;
    let Some(path) = outline.path.finish() else { return };
    let start = match text.anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => -0.5 * width,
        Anchor::End => -width,
    };
    let scale = (text.size / em(face)) as f32;
    let place = Transform::from_translate(start, 0.0)
        .post_scale(scale, -scale)
        .post_rotate(if text.upwards { -90.0 } else { 0.0 })
        .post_translate(text.at[0] as f32, text.at[1] as f32)
        .post_scale(SCALE, SCALE);
    fill(pixels, &path, text.color, place);
}

fn fill(pixels: &mut Pixmap, path: &Path, color: Color, place: Transform) {
    pixels.fill_path(path, &paint(color), FillRule::Winding, place, None);
}

fn paint([r, g, b]: Color) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(r, g, b, 255);
    paint
}

fn polyline(points: &[[f64; 2]]) -> Option<Path> {
    let mut path = PathBuilder::new();
    for (i, &[x, y]) in points.iter().enumerate() {
        if i == 0 {
            path.move_to(x as f32, y as f32);
        } else {
            path.line_to(x as f32, y as f32);
        }
    }
    path.finish()
}

/// Collects glyphs, each shifted by `x` font units.
struct Outline {
    path: PathBuilder,
    x: f32,
}

impl OutlineBuilder for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        self.path.move_to(self.x + x, y);
    }
    fn line_to(&mut self, x: f32, y: f32) {
        self.path.line_to(self.x + x, y);
    }
    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.path.quad_to(self.x + x1, y1, self.x + x, y);
    }
    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.path.cubic_to(self.x + x1, y1, self.x + x2, y2, self.x + x, y);
    }
    fn close(&mut self) {
        self.path.close();
    }
}
