use std::sync::Arc;

use super::*;

/// Splits outputs and joins them again from one group.
fn round_trip(outputs: &[&[u8]]) -> (usize, Vec<Vec<u8>>) {
    let mut table = PieceTable::default();
    let lists: Vec<_> =
        outputs.iter().map(|output| table.split(output, 0).unwrap_or_default()).collect();
    let (pieces, renumbering) = table.finish();
    let mut group = Vec::new();
    let mut places = Vec::new();
    for piece in &pieces {
        places.push((group.len(), piece.length as usize, piece.values as usize));
        group.extend_from_slice(&piece.bytes);
    }
    let group: Arc<[u8]> = group.into();
    let joined = lists.into_iter().zip(outputs).map(|(list, output)| {
        let mut list = list.unwrap_or_default();
        renumbering.apply(&mut list);
        let bytes: Vec<u8> = list.iter().flat_map(|word| word.to_le_bytes()).collect();
        let found = join(&bytes, output.len(), &mut |number| {
            let (offset, length, values) = places[number as usize];
            Ok(Found { group: group.clone(), offset, length, values })
        });
        found.unwrap_or_default()
    });
    let joined = joined.collect();
    (pieces.len(), joined)
}

#[test]
fn texts_share_their_declarations() {
    let first =
        "struct A {\n    x: f32,\n}\n\nvar<private> a: A;\n\nfn one() {\n}\n\nfn two() {\n}\n";
    let second = first.replace("fn two() {\n}\n", "fn three() {\n  if (true) {\n  }\n}");
    let (count, joined) = round_trip(&[first.as_bytes(), second.as_bytes()]);
    assert_eq!(joined, [first.as_bytes(), second.as_bytes()]);
    // The structure, an empty line, the variable, three functions.
    assert_eq!(count, 6);
}

fn module(words: &[&[u32]]) -> Vec<u8> {
    let header = [0x0723_0203, 0x0001_0000, 28, 99, 0];
    let body = words.iter().flat_map(|instruction| {
        let first = (instruction.len() as u32) << 16 | instruction[0];
        std::iter::once(first).chain(instruction[1..].iter().copied()).collect::<Vec<_>>()
    });
    header.into_iter().chain(body).flat_map(u32::to_le_bytes).collect()
}

/// A function that adds a number to itself: with the ids of `numbers`, in their order.
fn adding(numbers: [u32; 6]) -> Vec<u8> {
    let [float, ty, function, label, sum, constant] = numbers;
    module(&[
        &[22, float, 32],
        &[33, ty, float],
        &[43, float, constant, 0x3f80_0000],
        &[54, float, function, 0, ty],
        &[248, label],
        &[129, float, sum, constant, constant],
        &[254, sum],
        &[56],
    ])
}

#[test]
fn modules_share_what_differs_in_ids_alone() {
    let (first, second) = (adding([1, 2, 3, 4, 5, 6]), adding([40, 7, 80, 9, 10, 4_000_000_000]));
    let (count, joined) = round_trip(&[&first, &second]);
    assert_eq!(joined, [first, second]);
    // The header, the two types, the constant, the function.
    assert_eq!(count, 5);
}

#[test]
fn a_literal_is_no_hole() {
    let [one, two] = [7, 8].map(|value| module(&[&[43, 1, 2, value][..]; 9]));
    let (count, joined) = round_trip(&[&one, &two]);
    assert_eq!(joined, [one, two]);
    assert_eq!(count, 3);
}

#[test]
fn damaged_modules_are_not_split() {
    let mut table = PieceTable::default();
    let mut bytes = adding([1, 2, 3, 4, 5, 6]);
    bytes.truncate(bytes.len() - 8);
    assert_eq!(table.split(&bytes, 0), Ok(None));
    assert_eq!(table.split(&[], 0), Ok(None));
}

/// The bits of its holes would make this function larger than a group.
#[test]
fn a_piece_that_no_group_takes_is_not_split() {
    let instructions = MOST_GROUP_BYTES / 4 / 5 - 8;
    let add = [129u32, 1, 2, 3, 4];
    let mut body: Vec<&[u32]> = vec![&[54, 1, 2, 0, 3]];
    body.resize(instructions, &add);
    let bytes = module(&body);
    assert!(bytes.len() < MOST_GROUP_BYTES);
    assert_eq!(PieceTable::default().split(&bytes, 0), Ok(None));
}

/// What has no order is split too, and joined to the same bytes.
#[test]
fn any_bytes_come_back() {
    let mut state = 1u64;
    let mut next = move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as u32
    };
    for _ in 0..2_000 {
        let length = next() as usize % 200;
        let mut bytes: Vec<u8> = match next() % 3 {
            0 => (0..length).map(|_| b"\n };a\t\r\xff"[next() as usize % 8]).collect(),
            1 => (0..length).map(|_| next() as u8).collect(),
            _ => {
                let count = next() as usize % 8 + 1;
                let instructions: Vec<Vec<u32>> = (0..count)
                    .map(|_| (0..next() % 7 + 1).map(|_| next() % 260).collect())
                    .collect();
                module(&instructions.iter().map(Vec::as_slice).collect::<Vec<_>>())
            }
        };
        // Twice, so that a list is smaller than what it describes.
        bytes.extend_from_slice(&bytes.clone());
        let mut table = PieceTable::default();
        if let Ok(Some(_)) = table.split(&bytes, 0) {
            assert_eq!(round_trip(&[&bytes]).1, [bytes]);
        }
    }
}
