#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| lamplight_fuzz::check("translate", bytes));
