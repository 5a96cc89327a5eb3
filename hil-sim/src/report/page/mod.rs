//! The pages: one file each that holds everything it shows, scripts and data too, and works without
//! a network.

mod data;
mod html;

pub(crate) use data::{Shown, json as flights_json};
pub use html::{Page, page};
pub(crate) use html::{flights_page, live_page};

use maud::{Markup, PreEscaped, html};

/// The page's own look, light and dark, on a screen and on paper.
const STYLE: &str = include_str!("style.css");

/// What a page has in its head.
pub(crate) fn head(title: &str) -> Markup {
    html! {
        head {
            meta charset="utf-8";
            meta name="viewport" content="width=device-width, initial-scale=1";
            title { (title) }
            style { (PreEscaped(STYLE)) }
        }
    }
}

/// A drawing with its caption.
pub(crate) fn figure(name: &str, svg: &str, caption: &str) -> Markup {
    html! {
        figure.drawn id=(name) {
            (PreEscaped(svg))
            figcaption { (caption) }
        }
    }
}
