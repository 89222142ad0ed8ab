//! Settings as macros, and which of them a composition asked for.

use super::table::{MacroMeaning, MacroTable};
use lamplight_permute::{Setting, Settings};
use lamplight_syntax::glsl::Symbol;

/// The settings by number, and which of them were read, in order.
pub struct Reads<'s> {
    entries: Vec<SettingEntry<'s>>,
    order: Vec<u16>,
    /// How many reads there were.
    pub count: usize,
    /// The value of an undefined macro in a condition. If it is `None`, such a macro is an error.
    pub undeclared: Option<bool>,
}

struct SettingEntry<'s> {
    name: &'s str,
    setting: &'s Setting,
    /// `None` for a value that its axis does not declare.
    value: Option<i64>,
    symbol: Symbol,
    read: bool,
}

impl<'s> Reads<'s> {
    /// No setting was read yet.
    pub fn new(settings: &'s Settings) -> Self {
        let entries = settings.values.iter().map(|(name, setting)| SettingEntry {
            name,
            setting,
            value: macro_value(settings, name, setting),
            symbol: Symbol(0),
            read: false,
        });
        Self {
            entries: entries.collect(),
            order: Vec::new(),
            count: 0,
            undeclared: settings.undeclared,
        }
    }

    /// Defines the macro of every setting, and those of the values of enum axes.
    pub fn define(&mut self, table: &mut MacroTable<'_>, settings: &Settings) {
        for (axis, values) in &*settings.enums {
            let axis = axis.to_uppercase();
            for (number, value) in values.iter().enumerate() {
                table.number(&format!("{axis}_{}", value.to_uppercase()), number as i64);
            }
        }
        for (index, entry) in self.entries.iter_mut().enumerate() {
            entry.symbol = table.spellings.intern(&entry.value.unwrap_or_default().to_string());
            let name = table.spellings.intern(&entry.name.to_uppercase());
            table.set(name, MacroMeaning::Setting(index as u16));
        }
    }

    /// The spelling of a setting's value.
    pub fn symbol(&self, setting: u16) -> Symbol {
        self.entries[usize::from(setting)].symbol
    }

    /// Whether a setting is a boolean that is true; it does not count as read.
    pub fn is_on(&self, setting: u16) -> bool {
        *self.entries[usize::from(setting)].setting == Setting::Bool(true)
    }

    /// The value of a setting, which now counts as read. The error holds the name and the value
    /// where the axis does not declare that value.
    pub fn read(&mut self, setting: u16) -> Result<i64, (&'s str, &'s Setting)> {
        self.count += 1;
        let entry = &mut self.entries[usize::from(setting)];
        if !entry.read {
            entry.read = true;
            self.order.push(setting);
        }
        entry.value.ok_or((entry.name, entry.setting))
    }

    /// The settings that were read, in order, with their values.
    pub fn finish(self) -> Vec<(String, Setting)> {
        let entries = &self.entries;
        self.order
            .iter()
            .map(|index| &entries[usize::from(*index)])
            .map(|entry| (entry.name.to_owned(), entry.setting.clone()))
            .collect()
    }
}

fn macro_value(settings: &Settings, name: &str, setting: &Setting) -> Option<i64> {
    match setting {
        Setting::Bool(value) => Some(i64::from(*value)),
        Setting::Int(value) => Some(*value),
        Setting::Name(chosen) => settings
            .enums
            .get(name)?
            .iter()
            .position(|value| value == chosen)
            .map(|index| index as i64),
    }
}
