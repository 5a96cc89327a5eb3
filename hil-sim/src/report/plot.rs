//! Panels of a figure: a view in space, a plan, and curves over time.

use plotters::coord::{CoordTranslate, Shift};
use plotters::prelude::*;
use std::ops::Range;

use super::ReportError;

/// A part of a figure to draw on.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// Result of drawing.
pub type Drawn = Result<(), Box<dyn std::error::Error>>;

/// Colours that stay apart in print and for the colour-blind (Okabe and Ito).
pub const COLOURS: [RGBColor; 4] =
    [RGBColor(0, 114, 178), RGBColor(213, 94, 0), RGBColor(0, 158, 115), RGBColor(204, 121, 167)];
pub(super) const GREY: RGBColor = RGBColor(120, 120, 120);
pub(super) const FONT: &str = "sans-serif";

/// A figure as SVG, in the colours of the page around it, or black on white alone; `title` is for
/// those who do not see it.
///
/// # Errors
/// [`ReportError::Figure`] with the figure's `name`.
pub fn drawing(
    name: &str,
    title: &str,
    size: (u32, u32),
    panels: impl FnOnce(&Area<'_>) -> Drawn,
) -> Result<String, ReportError> {
    let fine = (size.0 * FINE, size.1 * FINE);
    let mut svg = String::new();
    let drawn = (|| {
        let area = SVGBackend::with_string(&mut svg, fine).into_drawing_area();
        area.fill(&WHITE)?;
        panels(&area)?;
        Ok(area.present()?)
    })();
    drawn.map_err(|error: Box<dyn std::error::Error>| ReportError::Figure {
        name: name.to_owned(),
        message: error.to_string(),
    })?;
    let label = title.replace('&', "&amp;").replace('"', "&quot;").replace('<', "&lt;");
    let sized = |(width, height): (u32, u32)| format!("width=\"{width}\" height=\"{height}\"");
    // Curves of many short lines: without round joints every joint of two pixels would show as a
    // spike.
    Ok(svg
        .replacen("<svg ", &format!("<svg role=\"img\" aria-label=\"{label}\" stroke-linejoin=\"round\" "), 1)
        .replacen(&sized(fine), &sized(size), 1)
        .replace("\"#000000\"", "\"currentColor\"")
        .replace("fill=\"#FFFFFF\"", "class=\"paper\" fill=\"#FFFFFF\"")
        .replace("stroke=\"#FFFFFF\"", "class=\"paper-line\" stroke=\"#FFFFFF\""))
}

/// Units of a drawing in a pixel of its figure: the backend knows whole units only, and curves of
/// whole pixels are jagged.
pub const FINE: u32 = 10;

/// A payload's way through space.
pub struct Track {
    /// What the legend says.
    pub label: String,
    /// Positions in N, m.
    pub points: Vec<[f64; 3]>,
    /// Of the line.
    pub colour: RGBColor,
}

/// A quantity over time.
pub struct Curve {
    /// What the legend says; empty: nothing.
    pub label: String,
    /// Time (s) and value.
    pub points: Vec<(f64, f64)>,
    /// Of the line.
    pub colour: RGBColor,
}

/// Least and largest of `values`, with a margin of 5 %, and not narrower than `least`.
pub(super) fn range(values: impl Iterator<Item = f64>, least: f64) -> Range<f64> {
    let (low, high) = values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    if low > high {
        return 0.0..least;
    }
    let (centre, half) = (0.5 * (low + high), (0.525 * (high - low)).max(0.5 * least));
    centre - half..centre + half
}

pub(super) fn widened(range: &Range<f64>, width: f64) -> Range<f64> {
    let centre = 0.5 * (range.start + range.end);
    centre - 0.5 * width..centre + 0.5 * width
}

/// The payload's ways in space, n3 down, with the curve to be flown in grey.
pub fn space(area: &Area<'_>, title: &str, curve: &[[f64; 3]], tracks: &[Track]) -> Drawn {
    let all = || curve.iter().chain(tracks.iter().flat_map(|track| &track.points));
    let mut axes: [Range<f64>; 3] = std::array::from_fn(|axis| range(all().map(|p| p[axis]), 1.0));
    let level = (axes[0].end - axes[0].start).max(axes[1].end - axes[1].start);
    // A level flight is shown as such: heights are not stretched beyond twice the level scale.
    if axes[2].end - axes[2].start < 0.5 * level {
        axes[2] = widened(&axes[2], 0.5 * level);
    }
    let [p1, p2] = [widened(&axes[0], level), widened(&axes[1], level)];
    // The chart's own vertical points up: it is −p3.
    let up = -axes[2].end..-axes[2].start;

    let mut chart = ChartBuilder::on(area).caption(title, (FONT, 17 * FINE)).margin(8 * FINE).build_cartesian_3d(
        p1.clone(),
        up.clone(),
        p2.clone(),
    )?;
    chart.with_projection(|mut projection| {
        projection.pitch = 0.35;
        projection.yaw = 0.6;
        projection.scale = 0.82;
        projection.into_matrix()
    });
    chart
        .configure_axes()
        .light_grid_style(BLACK.mix(0.08))
        .bold_grid_style(BLACK.mix(0.18))
        .max_light_lines(1)
        .x_formatter(&|value| format!("{value:.0}"))
        .y_formatter(&|up| format!("{:.0}", -up))
        .z_formatter(&|value| format!("{value:.0}"))
        .label_style((FONT, 12 * FINE))
        .draw()?;
    let at = |p: &[f64; 3]| (p[0], -p[2], p[1]);
    let middle = |range: &Range<f64>| 0.5 * (range.start + range.end);
    let beyond = 0.13 * level;
    let names = [
        ("p1, m", (middle(&p1), up.start, p2.end + 1.6 * beyond)),
        ("p2, m", (p1.end + 1.6 * beyond, up.start, middle(&p2))),
        ("p3, m", (p1.start - 0.6 * beyond, up.end + 0.07 * (up.end - up.start), p2.end)),
    ];
    chart.draw_series(names.map(|(name, place)| Text::new(name, place, (FONT, 13 * FINE).into_font())))?;
    chart.draw_series(LineSeries::new(curve.iter().map(at), GREY.stroke_width(FINE)))?;
    for track in tracks {
        line(&mut chart, track.points.iter().map(at), &track.label, track.colour)?;
        chart.draw_series(track.points.first().map(|p| Circle::new(at(p), 4 * FINE, track.colour.filled())))?;
    }
    chart
        .configure_series_labels()
        .margin(5 * FINE)
        .legend_area_size(30 * FINE)
        .position(SeriesLabelPosition::UpperRight)
        .label_font((FONT, 13 * FINE))
        .background_style(WHITE.mix(0.8))
        .draw()?;
    Ok(())
}

/// The payload's ways seen from above, n1 up and n2 to the right, with the curve to be flown in
/// grey.
pub fn plan(area: &Area<'_>, title: &str, curve: &[[f64; 3]], tracks: &[Track]) -> Drawn {
    projection(area, title, curve, tracks, 1, 0)
}

/// The payload's ways seen from the side, n3 down and to the right whichever of n1 and n2 the curve
/// is longer along.
pub fn elevation(area: &Area<'_>, title: &str, curve: &[[f64; 3]], tracks: &[Track]) -> Drawn {
    let extent = |axis: usize| {
        let range = range(curve.iter().map(|p| p[axis]), 1.0);
        range.end - range.start
    };
    projection(area, title, curve, tracks, if extent(0) >= extent(1) { 0 } else { 1 }, 2)
}

/// The ways along n of `right` and of `up`; n3 is drawn downwards.
fn projection(area: &Area<'_>, title: &str, curve: &[[f64; 3]], tracks: &[Track], right: usize, up: usize) -> Drawn {
    let sense = if up == 2 { -1.0 } else { 1.0 };
    let all = || curve.iter().chain(tracks.iter().flat_map(|track| &track.points));
    let axes = [range(all().map(|p| sense * p[up]), 1.0), range(all().map(|p| p[right]), 1.0)];
    // Equal scales on both axes.
    let (width, height) = area.dim_in_pixel();
    let (width, height) = (f64::from(width) - f64::from(80 * FINE), f64::from(height) - f64::from(90 * FINE));
    let scale = ((axes[1].end - axes[1].start) / width).max((axes[0].end - axes[0].start) / height);

    let mut chart = ChartBuilder::on(area)
        .caption(title, (FONT, 17 * FINE))
        .margin(10 * FINE)
        .x_label_area_size(38 * FINE)
        .y_label_area_size(48 * FINE)
        .build_cartesian_2d(widened(&axes[1], scale * width), widened(&axes[0], scale * height))?;
    chart
        .configure_mesh()
        .set_all_tick_mark_size(5 * FINE)
        .light_line_style(WHITE)
        .bold_line_style(BLACK.mix(0.12))
        .x_label_formatter(&|p| p.to_string())
        .y_label_formatter(&|p| (sense * p + 0.0).to_string())
        .x_desc(format!("p{}, m", right + 1))
        .y_desc(format!("p{}, m", up + 1))
        .label_style((FONT, 13 * FINE))
        .axis_desc_style((FONT, 14 * FINE))
        .draw()?;
    let at = |p: &[f64; 3]| (p[right], sense * p[up]);
    chart.draw_series(DashedLineSeries::new(curve.iter().map(at), 6 * FINE, 4 * FINE, GREY.stroke_width(FINE)))?;
    for track in tracks {
        line(&mut chart, track.points.iter().map(at), &track.label, track.colour)?;
        chart.draw_series(track.points.first().map(|p| Circle::new(at(p), 4 * FINE, track.colour.filled())))?;
    }
    legend(&mut chart, SeriesLabelPosition::MiddleMiddle)
}

/// Curves over time on a linear scale.
pub fn time(area: &Area<'_>, quantity: &str, curves: &[Curve], marks_s: &[f64]) -> Drawn {
    let mut y = range(curves.iter().flat_map(|curve| curve.points.iter().map(|point| point.1)), 1e-6);
    // Room for the legend.
    y.end += 0.25 * (y.end - y.start);
    let mut builder = time_axes(area);
    let mut chart = builder.build_cartesian_2d(time_range(curves), y.clone())?;
    chart
        .configure_mesh()
        .set_all_tick_mark_size(5 * FINE)
        .light_line_style(WHITE)
        .bold_line_style(BLACK.mix(0.12))
        .x_desc("t, s")
        .x_label_formatter(&|t| t.to_string())
        .y_desc(quantity)
        .y_labels(6)
        .label_style((FONT, 13 * FINE))
        .axis_desc_style((FONT, 14 * FINE))
        .draw()?;
    mark(&mut chart, &y, marks_s)?;
    for curve in curves {
        line(&mut chart, curve.points.iter().copied(), &curve.label, curve.colour)?;
    }
    legend(&mut chart, SeriesLabelPosition::UpperRight)
}

/// Positive curves over time on a logarithmic scale that begins at `floor`.
pub fn time_log(area: &Area<'_>, quantity: &str, floor: f64, curves: &[Curve], marks_s: &[f64]) -> Drawn {
    let top = curves.iter().flat_map(|curve| &curve.points).fold(10.0 * floor, |top, point| top.max(2.0 * point.1));
    let mut builder = time_axes(area);
    let mut chart = builder.build_cartesian_2d(time_range(curves), (floor..top).log_scale())?;
    chart
        .configure_mesh()
        .set_all_tick_mark_size(5 * FINE)
        .light_line_style(WHITE)
        .bold_line_style(BLACK.mix(0.12))
        .x_desc("t, s")
        .x_label_formatter(&|t| t.to_string())
        .y_desc(quantity)
        .y_label_formatter(&|value| format!("{value:.0e}"))
        .label_style((FONT, 13 * FINE))
        .axis_desc_style((FONT, 14 * FINE))
        .draw()?;
    mark(&mut chart, &(floor..top), marks_s)?;
    for curve in curves {
        let points = curve.points.iter().map(|&(t, value)| (t, value.max(floor)));
        line(&mut chart, points, &curve.label, curve.colour)?;
    }
    legend(&mut chart, SeriesLabelPosition::UpperRight)
}

/// A line through `points` that the legend names, if it has a `label`.
fn line<P: Clone + 'static, C: CoordTranslate<From = P>>(
    chart: &mut ChartContext<'_, SVGBackend<'_>, C>,
    points: impl IntoIterator<Item = P>,
    label: &str,
    colour: RGBColor,
) -> Drawn {
    let style = colour.stroke_width(2 * FINE);
    let drawn = chart.draw_series(LineSeries::new(points, style))?;
    if !label.is_empty() {
        drawn.label(label).legend(move |(x, y)| PathElement::new([(x, y), (x + 18 * FINE as i32, y)], style));
    }
    Ok(())
}

/// A dashed line across the range `y` at each of `marks_s`.
fn mark<X: Ranged<ValueType = f64>, Y: Ranged<ValueType = f64>>(
    chart: &mut ChartContext<'_, SVGBackend<'_>, Cartesian2d<X, Y>>,
    y: &Range<f64>,
    marks_s: &[f64],
) -> Drawn {
    for &t in marks_s {
        let ends = [(t, y.start), (t, y.end)];
        chart.draw_series(DashedLineSeries::new(ends, 3 * FINE, 4 * FINE, GREY.stroke_width(FINE)))?;
    }
    Ok(())
}

/// The names of the lines.
fn legend<'a, X: Ranged<ValueType = f64>, Y: Ranged<ValueType = f64>>(
    chart: &mut ChartContext<'a, SVGBackend<'a>, Cartesian2d<X, Y>>,
    position: SeriesLabelPosition,
) -> Drawn {
    Ok(chart
        .configure_series_labels()
        .margin(5 * FINE)
        .legend_area_size(30 * FINE)
        .position(position)
        .label_font((FONT, 13 * FINE))
        .background_style(WHITE.mix(0.8))
        .draw()?)
}

fn time_axes<'a, 'b>(area: &'a Area<'b>) -> ChartBuilder<'a, 'b, SVGBackend<'b>> {
    let mut builder = ChartBuilder::on(area);
    builder.margin(10 * FINE).x_label_area_size(38 * FINE).y_label_area_size(66 * FINE);
    builder
}

fn time_range(curves: &[Curve]) -> Range<f64> {
    let end = curves.iter().filter_map(|curve| curve.points.last()).fold(1e-3_f64, |end, point| end.max(point.0));
    0.0..end
}
