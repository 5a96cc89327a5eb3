//! A route seen from above: legs, blends, stops and fences.

use plotters::prelude::*;

use super::ReportError;
use super::plot::{COLOURS, FINE, FONT, GREY, drawing, range, widened};
use crate::describe::mission::{Local, LocalEdge};
use crate::study::check::Lap;

/// Where the curve bends more than this it is a blend, 1/m.
const BLEND: f64 = 1e-3;
/// Pixels.
const SIZE: (u32, u32) = (1000, 1000);

/// The map of a mission in N and the route through it, as SVG; n1 is up.
///
/// # Errors
/// [`ReportError::Figure`].
pub fn map(title: &str, local: &Local, lap: &Lap) -> Result<String, ReportError> {
    let edges: Vec<(bool, Vec<[f64; 2]>)> =
        local.regions.iter().map(|(is_inside, edge)| (*is_inside, corners(edge))).collect();
    drawing("route", title, SIZE, |area| {
        let nodes = lap.nodes();
        let points = || nodes.iter().map(|node| [node.position().x, node.position().y]);
        let all = || points().chain(edges.iter().flat_map(|(_, edge)| edge.iter().copied()));
        let axes = [0, 1].map(|axis| range(all().map(|point| point[axis]), 1.0));
        // Equal scales on both axes.
        let [up, right] = axes.each_ref().map(|axis| axis.end - axis.start);
        let side = up.max(right);
        let mut chart = ChartBuilder::on(area)
            .caption(title, (FONT, 17 * FINE))
            .margin(10 * FINE)
            .x_label_area_size(38 * FINE)
            .y_label_area_size(48 * FINE)
            .build_cartesian_2d(widened(&axes[1], side), widened(&axes[0], side))?;
        chart
            .configure_mesh()
            .light_line_style(WHITE)
            .bold_line_style(BLACK.mix(0.12))
            .x_desc("n2, m")
            .y_desc("n1, m")
            .label_style((FONT, 13 * FINE))
            .axis_desc_style((FONT, 14 * FINE))
            .draw()?;
        let at = |[n1, n2]: [f64; 2]| (n2, n1);
        for (is_inside, edge) in &edges {
            let colour = if *is_inside { COLOURS[2] } else { COLOURS[3] };
            let closed = edge.iter().chain(edge.first()).map(|point| at(*point));
            chart.draw_series(LineSeries::new(closed, colour.stroke_width(2 * FINE)))?;
        }
        let waypoints = || local.waypoints.iter().map(|waypoint| at([waypoint.point[0], waypoint.point[1]]));
        chart.draw_series(DashedLineSeries::new(waypoints(), 6 * FINE, 4 * FINE, GREY.stroke_width(FINE)))?;
        // Legs, and over them blends: pieces of nodes in a row that bend.
        chart.draw_series(LineSeries::new(points().map(at), COLOURS[0].stroke_width(2 * FINE)))?;
        for blend in nodes.chunk_by(|a, b| (a.curvature() > BLEND) == (b.curvature() > BLEND)) {
            if blend[0].curvature() > BLEND {
                let bent = blend.iter().map(|node| at([node.position().x, node.position().y]));
                chart.draw_series(LineSeries::new(bent, COLOURS[1].stroke_width(3 * FINE)))?;
            }
        }
        for (index, (waypoint, place)) in local.waypoints.iter().zip(waypoints()).enumerate() {
            let style = match waypoint.stop {
                Some(_) => COLOURS[1].filled(),
                None => GREY.stroke_width(FINE),
            };
            let size = if waypoint.stop.is_some() { 7 } else { 4 };
            chart.draw_series([Circle::new(place, size * FINE, style)])?;
            let style = (FONT, 12 * FINE).into_font();
            chart.draw_series([EmptyElement::at(place) + Text::new(index.to_string(), (60, -150), style)])?;
        }
        Ok(())
    })
}

/// An edge by corners; a circle by many.
fn corners(edge: &LocalEdge) -> Vec<[f64; 2]> {
    match edge {
        LocalEdge::Polygon(corners) => corners.clone(),
        LocalEdge::Circle([n1, n2], radius) => (0..72)
            .map(|i| {
                let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / 72.0).sin_cos();
                [n1 + radius * cos, n2 + radius * sin]
            })
            .collect(),
    }
}
