//! The theory behind the code, from the model to the law, the observers and the approach. Numbers
//! in brackets in this crate's comments are those of the equations below.
// On GitHub the page shows its drawing as an image; here it stands in the page itself.
#![doc = "<style>img[src=\"frames.svg\"]{display:none}</style>\n"]
#![doc = include_str!("../frames.svg")]
#![doc = include_str!("../theory.md")]
