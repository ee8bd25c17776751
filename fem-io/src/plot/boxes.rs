//! No text of a picture is cut, and none lies on another.

use super::png::text_width;
use super::shapes::{Anchor, Drawing, Shape, Text};
use super::{Axis, Fill, LinePlot, MapCell, MapOutline, MapPlot, Panel, Series, force_history, layout, map_layout};

/// Left, upper, right and lower edge.
fn bounds(text: &Text) -> [f64; 4] {
    let (long, [x, y]) = (text_width(&text.text, text.size), text.at);
    let before = match text.anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => 0.5 * long,
        Anchor::End => long,
    };
    let (above, below) = (0.75 * text.size, 0.2 * text.size);
    match text.upwards {
        false => [x - before, y - above, x - before + long, y + below],
        true => [x - above, y + before - long, x + below, y + before],
    }
}

#[track_caller]
fn check(drawing: &Drawing) {
    let texts = drawing.shapes.iter().filter_map(|shape| match shape {
        Shape::Text(text) => Some((text, bounds(text))),
        _ => None,
    });
    let texts: Vec<_> = texts.collect();
    for (i, (text, [left, top, right, bottom])) in texts.iter().enumerate() {
        let inside = *left >= 0.0 && *top >= 0.0 && *right <= drawing.width && *bottom <= drawing.height;
        assert!(inside, "`{}` of `{}` is cut: {left} {top} {right} {bottom}", text.text, drawing.title);
        for (other, [l, t, r, b]) in &texts[i + 1..] {
            let apart = right <= l || r <= left || bottom <= t || b <= top;
            assert!(apart, "`{}` lies on `{}` in `{}`", text.text, other.text, drawing.title);
        }
    }
}

const LONG: &str =
    "IM6/934, 32 plies, 76.2 x 127 mm, 3.17 kg at 1.10 m/s, a title that goes on and on until there is no room for it";

#[test]
fn texts_of_curves() {
    let times: Vec<f64> = (0..=100).map(|i| f64::from(i) * 1e-5).collect();
    let force = |k: usize| times.iter().map(|t| 1e3 * (k as f64 + t)).collect::<Vec<_>>();
    for curves in [1, 3, 12] {
        let names: Vec<String> = (0..curves).map(|k| format!("plate under the impactor number {k}")).collect();
        let forces: Vec<_> = names.iter().enumerate().map(|(k, name)| (name.as_str(), force(k))).collect();
        for (events, apart) in [(0, 0.0), (1, 0.0), (6, 2e-6), (12, 5e-5), (20, 1e-6)] {
            let marks: Vec<_> =
                (0..events).map(|k| (3e-4 + apart * f64::from(k), format!("matrix compression {k}"))).collect();
            check(&layout::lay_out(&force_history(LONG, &times, &forces, &marks).unwrap()).unwrap());
        }
    }
    for largest in [1e-9, 0.35, 999.9, 1e12] {
        let series = vec![Series::solid("one", vec![(0.0, -largest), (largest, largest)])];
        let axis = |name: &str| Axis::linear(name, "N");
        let (x, y) = (axis("Displacement"), axis("Contact force"));
        let plot = LinePlot { title: "t".into(), x, y, series, marks: Vec::new(), doubts: Vec::new() };
        check(&layout::lay_out(&plot).unwrap());
    }
}

#[test]
fn texts_of_maps() {
    for (count, wide, tall) in
        [(1, 1.0, 1.0), (2, 3.0, 1.0), (4, 1.0, 1.0), (6, 1.0, 4.0), (12, 20.0, 1.0), (24, 1.0, 1.0)]
    {
        for classes in [1, 7] {
            let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
                .map(|[x, y]| [100.0 * wide * x, 100.0 * tall * y])
                .to_vec();
            let fill = |k: usize| if k == 0 { Fill::Share(0.5) } else { Fill::Class(k - 1) };
            let cells = (0..=classes).map(|k| MapCell { corners: corners.clone(), fill: fill(k) }).collect::<Vec<_>>();
            let panel = |k: usize| Panel {
                title: format!("interface {k}|{} (-45\u{b0}): from 0.3922 ms", k + 1),
                cells: cells.clone(),
                crosses: vec![[50.0, 50.0]],
                notes: if count == 1 {
                    vec![(10.0, "31: 90\u{b0}".into()), (60.0, "32: -45\u{b0}".into())]
                } else {
                    Vec::new()
                },
                ..Panel::default()
            };
            let plot = MapPlot {
                title: LONG.into(),
                x: Axis::linear("x", "mm"),
                y: Axis::linear("y", "mm"),
                rows: Vec::new(),
                equal_aspect: true,
                scale: Some("largest index".into()),
                classes: (0..classes).map(|k| format!("matrix compression {k} (hashin-report)")).collect(),
                outlines: vec![MapOutline { name: "support".into(), lines: vec![corners.clone()], dashed: true }],
                panels: (0..count).map(panel).collect(),
            };
            check(&map_layout::lay_out(&plot).unwrap());
        }
    }
}
