//! The layouts of bind groups that a device has already. For each new layout wgpu makes room for 64
//! groups, which a driver on the CPU fills with zeros, and gives it back with the layout.

use std::collections::HashMap;
use std::sync::Mutex;

use super::lock_mutex;

/// Layouts by their entries.
#[derive(Default)]
pub struct GroupLayouts {
    known: Mutex<HashMap<Vec<wgpu::BindGroupLayoutEntry>, wgpu::BindGroupLayout>>,
}

impl GroupLayouts {
    /// The layout with these entries.
    pub fn of(
        &self,
        device: &wgpu::Device,
        entries: Vec<wgpu::BindGroupLayoutEntry>,
    ) -> wgpu::BindGroupLayout {
        let mut known = lock_mutex(&self.known);
        let layout = known.entry(entries).or_insert_with_key(|entries| {
            device
                .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries })
        });
        layout.clone()
    }
}
