//! Makes inputs that are almost right: valid files with words removed, doubled, swapped and
//! invented.

use std::fs;
use std::path::Path;

/// The most bytes of one input. Larger ones find nothing new and take longer.
const MOST_BYTES: usize = 200_000;

/// The generator splitmix64: the same seed gives the same inputs.
pub struct FuzzRandom(pub u64);

impl FuzzRandom {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    pub fn below(&mut self, bound: usize) -> usize {
        (self.next() % bound.max(1) as u64) as usize
    }
}

/// The files of folders with an ending, sorted by path, and the test cases of several files as one
/// input each. A single empty input if there are none.
pub fn corpus_of(root: &Path, folders: &[(&str, &str)]) -> Vec<Vec<u8>> {
    let mut files = Vec::new();
    for (folder, ending) in folders {
        collect(&root.join(folder), ending, &mut files);
    }
    files.sort();
    let mut inputs: Vec<Vec<u8>> = files.iter().filter_map(|path| fs::read(path).ok()).collect();
    inputs.extend(cases(&files));
    if inputs.is_empty() {
        inputs.push(Vec::new());
    }
    inputs
}

/// Adds the files of a folder with an ending.
pub fn collect(folder: &Path, ending: &str, found: &mut Vec<std::path::PathBuf>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        match path.is_dir() {
            true => collect(&path, ending, found),
            false if path.to_string_lossy().ends_with(ending) => found.push(path),
            false => {}
        }
    }
}

/// Test cases that consist of several files, as one input each.
fn cases(files: &[std::path::PathBuf]) -> Vec<Vec<u8>> {
    let main = |path: &&std::path::PathBuf| {
        path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("main."))
    };
    let case = |main: &std::path::PathBuf| {
        let folder = main.parent()?;
        let mut text = fs::read_to_string(main).ok()?;
        for other in files.iter().filter(|other| *other != main && other.starts_with(folder)) {
            let path = other.strip_prefix(folder).ok()?.to_string_lossy().into_owned();
            text += &format!("\n%% {path}\n{}", fs::read_to_string(other).ok()?);
        }
        Some(text.into_bytes())
    };
    files.iter().filter(main).filter_map(case).collect()
}

/// One valid input with a few mutations.
pub fn mutated(random: &mut FuzzRandom, corpus: &[Vec<u8>], words: &[&str]) -> Vec<u8> {
    let mut input = corpus[random.below(corpus.len())].clone();
    for _ in 0..1 + random.below(6) {
        let pieces = pieces(&input);
        input = match random.below(14) {
            0 => bytes(random, input),
            1 => chunk(random, &pieces, |_| Vec::new()),
            2 => chunk(random, &pieces, |chunk| [chunk, chunk].concat()),
            3 => many(random, &pieces),
            4 => swapped(random, pieces),
            5 => spliced(random, &pieces, corpus),
            6 => input[..random.below(input.len() + 1)].to_vec(),
            7 => numbers(random, pieces),
            8 | 9 => borrowed(random, &pieces),
            _ => invented(random, pieces, words),
        };
        input.truncate(MOST_BYTES);
    }
    input
}

type InputPiece = Vec<u8>;

/// Words, blanks, and single other characters.
fn pieces(input: &[u8]) -> Vec<InputPiece> {
    let class = |byte: u8| match byte {
        b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'_' | 0x80.. => 0,
        b' ' | b'\t' | b'\r' => 1,
        _ => 2,
    };
    input.chunk_by(|a, b| class(*a) == class(*b) && class(*a) != 2).map(<[u8]>::to_vec).collect()
}

fn range(random: &mut FuzzRandom, length: usize) -> std::ops::Range<usize> {
    let start = random.below(length + 1);
    let most = [2, 8, 40][random.below(3)];
    start..(start + 1 + random.below(most)).min(length).max(start)
}

fn chunk(
    random: &mut FuzzRandom,
    pieces: &[InputPiece],
    change: impl FnOnce(&[InputPiece]) -> Vec<InputPiece>,
) -> Vec<u8> {
    let range = range(random, pieces.len());
    [&pieces[..range.start], &change(&pieces[range.clone()]), &pieces[range.end..]]
        .concat()
        .concat()
}

/// Repeats a few words very often: deep nesting, long lists, long chains.
fn many(random: &mut FuzzRandom, pieces: &[InputPiece]) -> Vec<u8> {
    let times = [30, 300, 3000][random.below(3)];
    let range = range(random, pieces.len());
    let part = &pieces[range.start..range.end.min(range.start + 6)];
    let repeated: Vec<u8> = part.concat().repeat(times);
    [&pieces[..range.end].concat(), &repeated, &pieces[range.end..].concat()]
        .map(Vec::as_slice)
        .concat()
}

fn swapped(random: &mut FuzzRandom, mut pieces: Vec<InputPiece>) -> Vec<u8> {
    if !pieces.is_empty() {
        let (a, b) = (random.below(pieces.len()), random.below(pieces.len()));
        pieces.swap(a, b);
    }
    pieces.concat()
}

fn spliced(random: &mut FuzzRandom, into: &[InputPiece], corpus: &[Vec<u8>]) -> Vec<u8> {
    let other = pieces(&corpus[random.below(corpus.len())]);
    let part = range(random, other.len());
    let at = random.below(into.len() + 1);
    [&into[..at], &other[part], &into[at..]].concat().concat()
}

/// Replaces a word of the input by another word from the same input.
fn borrowed(random: &mut FuzzRandom, pieces: &[InputPiece]) -> Vec<u8> {
    let is_word =
        |piece: &&InputPiece| piece.first().is_some_and(|byte| byte.is_ascii_alphanumeric());
    let words: Vec<&InputPiece> = pieces.iter().filter(is_word).collect();
    if words.is_empty() {
        return pieces.concat();
    }
    let (from, to) = (words[random.below(words.len())].clone(), random.below(words.len()));
    let mut changed = pieces.to_vec();
    let place = pieces.iter().enumerate().filter(|(_, piece)| is_word(piece)).nth(to);
    if let Some((place, _)) = place {
        changed[place] = from;
    }
    changed.concat()
}

fn invented(random: &mut FuzzRandom, mut pieces: Vec<InputPiece>, words: &[&str]) -> Vec<u8> {
    if words.is_empty() {
        return bytes(random, pieces.concat());
    }
    let word = words[random.below(words.len())].as_bytes().to_vec();
    let at = random.below(pieces.len() + 1);
    match pieces.get_mut(at).filter(|_| random.below(2) == 0) {
        Some(piece) => *piece = word,
        None => pieces.insert(at, [b" ".to_vec(), word, b" ".to_vec()].concat()),
    }
    pieces.concat()
}

fn numbers(random: &mut FuzzRandom, mut pieces: Vec<InputPiece>) -> Vec<u8> {
    const EXTREMES: [&str; 8] = [
        "0",
        "1",
        "255",
        "256",
        "4294967295",
        "4294967296",
        "9223372036854775807",
        "99999999999999999999999",
    ];
    let places: Vec<usize> = (0..pieces.len())
        .filter(|place| pieces[*place].first().is_some_and(u8::is_ascii_digit))
        .collect();
    if !places.is_empty() {
        pieces[places[random.below(places.len())]] = EXTREMES[random.below(EXTREMES.len())].into();
    }
    pieces.concat()
}

fn bytes(random: &mut FuzzRandom, mut input: Vec<u8>) -> Vec<u8> {
    for _ in 0..1 + random.below(4) {
        if !input.is_empty() {
            let at = random.below(input.len());
            input[at] = match random.below(3) {
                0 => input[at] ^ (1 << random.below(8)),
                1 => random.below(256) as u8,
                _ => [0, 0xff, 0x7f, b'\n'][random.below(4)],
            };
        }
    }
    input
}
