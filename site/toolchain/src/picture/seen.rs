//! Caches the shadow maps of earlier pictures: while somebody changes a material, the next picture
//! needs the same ones.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::sync::Arc;

use lamplight::bundle::Target;
use lamplight_execute::frame::{Buffers, Drawing, Frame};

/// How many drawings are kept: those of a picture, and of the one before it.
const KEPT: usize = 4;

/// Everything that the frames of a drawing depend on.
#[derive(PartialEq, Eq)]
pub struct Known(Vec<u8>);

thread_local! {
    static SEEN: RefCell<VecDeque<(Known, Arc<Vec<Frame>>)>> = const { RefCell::new(VecDeque::new()) };
}

/// The cache key of a drawing of depths. `None` for other drawings, which seldom repeat.
pub fn known(drawing: &Drawing<'_>, target: Target) -> Option<Known> {
    if drawing.fragment.is_some() || !drawing.fixtures.is_empty() {
        return None;
    }
    let stage = format!("{:?}", (drawing.vertex, target, drawing.size, drawing.state));
    let mut found = Vec::new();
    put(&mut found, stage.as_bytes());
    put_buffers(&mut found, drawing.buffers);
    drawing.views.iter().for_each(|view| put_buffers(&mut found, view));
    for item in drawing.items {
        put(&mut found, format!("{:?}", item.mesh.attributes).as_bytes());
        put_words(&mut found, &item.mesh.words);
        put_words(&mut found, &item.mesh.indices);
        put_buffers(&mut found, item.buffers);
    }
    Some(Known(found))
}

/// Writes the length first, so that different sequences of parts never give the same bytes.
fn put(to: &mut Vec<u8>, bytes: &[u8]) {
    to.extend((bytes.len() as u64).to_le_bytes());
    to.extend(bytes);
}

fn put_words(to: &mut Vec<u8>, words: &[u32]) {
    to.extend((words.len() as u64).to_le_bytes());
    words.iter().for_each(|word| to.extend(word.to_le_bytes()));
}

fn put_buffers(to: &mut Vec<u8>, buffers: &Buffers) {
    put_words(to, &[buffers.len() as u32]);
    for ((group, binding), bytes) in buffers {
        put_words(to, &[*group, *binding]);
        put(to, bytes);
    }
}

/// The frames of an earlier drawing with the same key.
pub fn find(known: &Known) -> Option<Arc<Vec<Frame>>> {
    SEEN.with_borrow(|seen| {
        seen.iter().find(|(one, _)| one == known).map(|(_, found)| found.clone())
    })
}

/// Keeps the frames of a drawing for the next pictures.
pub fn keep(known: Known, frames: Arc<Vec<Frame>>) {
    SEEN.with_borrow_mut(|seen| {
        seen.push_back((known, frames));
        if seen.len() > KEPT {
            seen.pop_front();
        }
    });
}
