//! Checks beyond checksums. Parts must be where a writer puts them, and their total size must be in
//! proportion to the file. So a small file cannot ask for much memory or time.

use super::*;
use lamplight_files::limits::{BUNDLE_BYTES, BUNDLE_FACTOR, BUNDLE_OUTPUTS, Steps};

/// How many bytes one part of the bundle may still have, in total.
struct Budget {
    left: Steps,
    part: &'static str,
}

impl Budget {
    /// The budget of one part, for a file of that size.
    fn new(bytes: usize, part: &'static str) -> Self {
        let most = BUNDLE_BYTES.saturating_add(BUNDLE_FACTOR.saturating_mul(bytes as u64));
        Self { left: Steps::new(most), part }
    }

    fn spend(&mut self, bytes: usize) -> Result<(), Error> {
        // An empty part costs time too, so it counts as a byte.
        self.left.spend(bytes as u64 + 1).map_err(|_| {
            let mib = BUNDLE_BYTES >> 20;
            let reason = format!("it holds more than {mib} MiB and {BUNDLE_FACTOR} times the file");
            Error::corrupt(self.part, reason)
        })
    }
}

impl Packed {
    pub(super) fn verify_all(&self) -> Result<(), Error> {
        self.verify_sections()?;
        self.within_budget()?;
        self.outputs_within(BUNDLE_OUTPUTS)?;
        self.verify_tables()?;
        for blob in 0..self.meta.blobs {
            let record = self.blob_record(blob)?;
            if checksum(&self.output(&record)?) != record.sum {
                return Err(Error::corrupt(format!("blob {blob}"), "the checksum does not match"));
            }
        }
        Ok(())
    }

    /// As [`Self::verify_all`], for the index of a directory, whose blobs are in files.
    pub(crate) fn verify_index(&self) -> Result<(), Error> {
        self.verify_sections()?;
        self.values_within_budget()?;
        self.keys_within_budget()?;
        self.verify_tables()
    }

    fn verify_sections(&self) -> Result<(), Error> {
        let tables = (0..SECTIONS.len()).filter(|section| *section != DATA);
        tables.into_iter().try_for_each(|section| self.section(section).map(|_| ()))?;
        match self.sections[DATA].2 == [0; 16] {
            true => Ok(()),
            false => Err(Error::corrupt("header", "the data section has a checksum of its own")),
        }
    }

    fn verify_tables(&self) -> Result<(), Error> {
        self.verify_groups()?;
        self.verify_keys()?;
        (0..self.meta.units).try_for_each(|unit| self.unit(unit).map(|_| ()))
    }

    /// Checks that each part is within its budget. It reads only tables: nothing is decompressed,
    /// parsed or copied.
    pub(super) fn within_budget(&self) -> Result<(), Error> {
        let mut groups = Budget::new(self.bytes.len(), "data");
        for group in 0..self.meta.groups {
            groups.spend(self.group_record(group)?.2)?;
        }
        self.values_within_budget()?;
        self.keys_within_budget()
    }

    /// Checks how large all outputs together are, each counted as often as a unit has it. Outputs in
    /// pieces may be thousands of times as large as the file, and none the worse for it.
    pub(super) fn outputs_within(&self, factor: u64) -> Result<(), Error> {
        let lengths = self.blob_lengths()?;
        let most = BUNDLE_BYTES.saturating_add(factor.saturating_mul(self.bytes.len() as u64));
        let mut left = Steps::new(most);
        for unit in 0..self.meta.units {
            let (_, first, count) = self.unit_record(unit)?;
            for artifact in first..first + count {
                let (_, _, blob) = self.artifact_record(artifact)?;
                let length = lengths.get(blob as usize).copied();
                let length =
                    length.ok_or_else(|| Error::corrupt("blobs", "a number is out of range"))?;
                left.spend(length as u64 + 1).map_err(|_| {
                    let mib = BUNDLE_BYTES >> 20;
                    Error::Io(format!(
                        "its outputs have more than {mib} MiB and {factor} times the bytes of the file"
                    ))
                })?;
            }
        }
        Ok(())
    }

    fn values_within_budget(&self) -> Result<(), Error> {
        let mut values = Budget::new(self.bytes.len(), "values");
        let weights = Tree::new(self.section(VALUES)?, "values")?.weights()?;
        // A value takes about 16 bytes in the words of JSON.
        let bytes = |index: u32| {
            let weight = weights.get(index as usize).copied();
            let weight =
                weight.ok_or_else(|| Error::corrupt("values", "a number is out of range"))?;
            Ok::<_, Error>(usize::try_from(weight.saturating_mul(16)).unwrap_or(usize::MAX))
        };
        for unit in 0..self.meta.units {
            let (reflection, first, count) = self.unit_record(unit)?;
            values.spend(bytes(reflection)?)?;
            for artifact in first..first + count {
                values.spend(bytes(self.artifact_record(artifact)?.1)?)?;
            }
        }
        Ok(())
    }

    fn keys_within_budget(&self) -> Result<(), Error> {
        let mut budget = Budget::new(self.bytes.len(), "keys");
        let keys = self.section(KEYS)?;
        for entry in &self.entries {
            for index in 0..entry.keys.count as usize {
                budget.spend(self.key(keys, &entry.keys, index)?.len())?;
            }
        }
        Ok(())
    }

    /// The length of each blob. Blobs and then pieces must follow each other through the groups, and
    /// none may overlap another.
    fn blob_lengths(&self) -> Result<Vec<usize>, Error> {
        let mut lengths = Vec::new();
        let (mut group, mut next) = (0, 0);
        let mut follow = |found: u32, offset: usize, stored: usize, part: &str, index: u32| {
            if found != group {
                self.ends(group, next)?;
                (group, next) = (group + 1, 0);
            }
            if found != group || offset != next {
                let reason = "it is not where the one before ends";
                return Err(Error::corrupt(format!("{part} {index}"), reason));
            }
            next += stored;
            Ok(())
        };
        for blob in 0..self.meta.blobs {
            let record = self.blob_record(blob)?;
            follow(record.group, record.offset, record.stored(), "blob", blob)?;
            lengths.push(record.length);
        }
        for piece in 0..self.meta.pieces {
            let record = self.piece_record(piece)?;
            follow(record.group, record.offset, record.stored(), "piece", piece)?;
        }
        if self.meta.groups > 0 {
            self.ends(group, next)?;
        }
        match group + 1 < self.meta.groups {
            true => Err(Error::corrupt("blobs", "a group has no blobs")),
            false => Ok(lengths),
        }
    }

    /// Checks that a group ends at `at`, where its last blob ends.
    fn ends(&self, group: u32, at: usize) -> Result<(), Error> {
        match self.group_record(group)?.2 == at {
            true => Ok(()),
            false => Err(Error::corrupt(format!("group {group}"), "its blobs do not fill it")),
        }
    }

    /// Checks that the groups fill DATA without a gap, so that their checksums cover all of it.
    fn verify_groups(&self) -> Result<(), Error> {
        let mut next = 0;
        for group in 0..self.meta.groups {
            let (offset, packed, ..) = self.group_record(group)?;
            if offset != next {
                return Err(Error::corrupt(
                    format!("group {group}"),
                    "it is not where the one before ends",
                ));
            }
            next = offset.saturating_add(packed);
            self.decompress(group)?;
        }
        if next == self.sections[DATA].1 {
            Ok(())
        } else {
            Err(Error::corrupt("data", "bytes follow the last group"))
        }
    }

    /// Checks that keys are sorted, are found by their hashes, and have units.
    fn verify_keys(&self) -> Result<(), Error> {
        for (number, entry) in self.entries.iter().enumerate() {
            let mut previous: Option<String> = None;
            let mut outcome = Ok(());
            self.each_key(number, &mut |key, unit| {
                let is_sorted = previous.as_deref().is_none_or(|previous| previous < key);
                if outcome.is_ok()
                    && (!is_sorted
                        || unit >= self.meta.units
                        || self.find(number, key) != Ok(Some(unit)))
                {
                    outcome = Err(Error::corrupt(
                        "keys",
                        format!("`{key}` of `{}` is not where it belongs", entry.name),
                    ));
                }
                previous = Some(key.to_owned());
            })?;
            outcome?;
        }
        Ok(())
    }
}
