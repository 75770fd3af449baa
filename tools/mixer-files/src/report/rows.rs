//! A table on the page.

use maud::{Markup, Render, html};

/// A table: the caption, one header row, rows whose first cell is their name.
pub(crate) fn table(caption: impl Render, header: &[impl Render], rows: &[Vec<impl Render>]) -> Markup {
    html! {
        div.wide {
            table {
                caption { (caption) }
                thead { tr { @for cell in header { th scope="col" { (cell) } } } }
                tbody {
                    @for row in rows {
                        tr {
                            @for (index, cell) in row.iter().enumerate() {
                                @if index == 0 { th scope="row" { (cell) } } @else { td { (cell) } }
                            }
                        }
                    }
                }
            }
        }
    }
}
