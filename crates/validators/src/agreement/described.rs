//! What a bundle says about an output.

use lamplight_bundle::{Binding, BindingSlot, Native, Reflection};

/// The reflection of an entry point, and what it is in one target.
#[derive(Debug, Clone, Copy)]
pub struct Described<'d> {
    /// What is the same in every target.
    pub reflection: &'d Reflection,
    /// Names and numbers of the target.
    pub native: &'d Native,
}

impl<'d> Described<'d> {
    /// The slot of a binding, if the target has one for it.
    pub fn slot(self, binding: &Binding) -> Option<&'d BindingSlot> {
        let mut slots = self.native.slots.iter();
        slots.find(|slot| (slot.group, slot.binding) == (binding.group, binding.binding))
    }
}

/// A binding in the words of messages.
pub fn binding_words(binding: &Binding) -> String {
    let Binding { group, binding, name, .. } = binding;
    format!("`{name}` (group {group}, binding {binding})")
}
