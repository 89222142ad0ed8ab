//! Fragments of linked text: how references are marked, found and written.

use lamplight::bundle::Target;
use lamplight::link::cut::TextFragment;
use lamplight::link::mark::{find_mark, write_mark};
use lamplight::link::names::{OutputNames, Renames};
use lamplight::link::ready::{Bits, Identifier, NumberSet, ReadyTemplate};

use super::Outcome;

pub fn marks_are_found_in_longer_names() -> Outcome {
    for number in [0, 1, 9, 10, 15, 16, 255, 4095] {
        let text = format!("Construct{}_1 + x", write_mark(number));
        let found = find_mark(&text, 0).unwrap();
        assert_eq!((found.number, found.start, found.small), (number, 9, false));
        let small = find_mark(&text.to_lowercase(), 3).unwrap();
        assert_eq!((small.number, small.end, small.small), (number, found.end, true));
    }
    assert_eq!(find_mark("qz zqqz Zq1qz aqz", 0), None);
    Ok(())
}

pub fn sets_hold_what_was_put_in() -> Outcome {
    let numbers = [0, 1, 63, 64, 127, 1000];
    let mut bits = Bits::new(1001);
    NumberSet::new(&numbers).add_to(&mut bits);
    assert_eq!(bits.numbers().collect::<Vec<_>>(), numbers.map(|number| number as usize));
    assert!(NumberSet::new(&[5, 64]).meets(&bits) && !NumberSet::new(&[5, 999]).meets(&bits));
    assert!(bits.insert(63) && !bits.insert(2) && bits.has(2));
    Ok(())
}

/// A reference within a longer identifier is renamed too. A name cannot be an identifier that
/// the fragment declares itself.
pub fn a_fragment_is_written_with_other_names() -> Outcome {
    let mut names = OutputNames::new(Target::WGSL);
    let author = ["", "first", "second"].map(str::to_owned);
    let text = format!("{}(own) = Make{}_1 + {1}.x;", write_mark(1), write_mark(2));
    let mut fragment = TextFragment::read(&text, &author).unwrap();
    fragment.locals = vec!["own".to_owned()];
    let ready = ReadyTemplate::new(fragment, &mut names).unwrap();
    assert_eq!(ready.template.text, "first(own) = Makesecond_1 + second.x;");
    let renames = Renames::from([(names.number("second").unwrap(), "second_7".to_owned())]);
    let mut written = String::new();
    ready.template.write(&renames, &mut written);
    assert_eq!(written, "first(own) = Makesecond_7_1 + second_7.x;");
    let derived: Vec<Identifier> = ready.derived(&renames).collect();
    assert!(matches!(&derived[..], [Identifier::Text(text)] if text == "Makesecond_7_1"));
    assert_eq!((ready.captured.len(), ready.locals.len()), (0, 1));
    Ok(())
}

pub fn words_are_plain_where_no_reference_touches_them() -> Outcome {
    let names = ["".to_owned(), "author".to_owned()];
    let mark = write_mark(1);
    let text = format!("a.b Make{mark} {mark}_1 c+{mark} d .{mark} e . f {mark}(g)h1{mark}x");
    let fragment = TextFragment::read(&text, &names).unwrap();
    assert_eq!(fragment.words().collect::<Vec<_>>(), ["a", "c", "d", "e", "g"]);
    Ok(())
}
