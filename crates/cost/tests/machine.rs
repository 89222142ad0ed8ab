//! What machine code executes, by hand: the texts in `machine/` are Mesa 22.3.6's code of the
//! library's functions and of `contact_shadows`, each in the stage that `lamplight cost` writes.

use std::path::Path;

use lamplight_cost::machine::{Counting, MachineError, Rates, Unit, count_machine};
use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("machine::counted_by_hand", counted_by_hand),
        Trial::test("machine::open_loops", open_loops),
        Trial::test("machine::waves_of_32_threads", waves_of_32_threads),
        Trial::test("machine::rates", rates),
        Trial::test("machine::decided_branches", decided_branches),
        Trial::test("machine::lost_instructions", lost_instructions),
        Trial::test("machine::refused_texts", refused_texts),
        Trial::test("machine::limits_of_loops", limits_of_loops),
        Trial::test("machine::limits_of_threads", limits_of_threads),
        Trial::test("machine::tested_at_the_end", tested_at_the_end),
    ]
}

fn counting(iterations: &[u32]) -> Counting<'_> {
    Counting { rates: Rates::RDNA, wave: 64, iterations }
}

/// The fewest and the most cycles of a unit.
type Range = (Unit, i64, i64);

fn expect(name: &str, text: &str, counting: Counting<'_>, wanted: &[Range]) -> Outcome {
    let found = count_machine(text, counting).map_err(|error| format!("{name}: {error}"))?;
    for (unit, least, most) in wanted {
        let range = (found.least.of(*unit), found.most.of(*unit));
        if range != (*least, *most) {
            let what = format!("{unit:?} {range:?}, expected {:?}", (least, most));
            return Err(format!("{name}: {what}: {found:?}").into());
        }
    }
    Ok(())
}

fn recorded(name: &str) -> Result<String, Failed> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/machine");
    Ok(std::fs::read_to_string(folder.join(name))?)
}

/// A text with its way of counting, and the sums.
type Counted<'a> = (&'a str, Counting<'a>, &'a [Range]);

/// Sums of blocks, in the order of the code. `x` is the number of transcendental instructions, which
/// take four cycles.
fn counted_by_hand() -> Outcome {
    use Unit::{Cycles, Export, Local, ScalarMemory, Texture, Transcendental, Vector};
    let cases: [Counted<'_>; 6] = [
        // Both sides of the test run with the inactive threads masked, without a branch:
        // 8 + 9 + 1 + 2, x = 3.
        (
            "v_smith_ggx.navi21.txt",
            counting(&[]),
            &[(Cycles, 32, 32), (Vector, 20, 20), (Transcendental, 12, 12), (Export, 1, 1)],
        ),
        // A branch skips the first side: 15 + (9) + 3 + 8, x = (2).
        (
            "safe_normalize.polaris10.txt",
            Counting { rates: Rates::GCN, ..counting(&[]) },
            &[(Cycles, 26, 43), (Vector, 26, 35), (Transcendental, 0, 8)],
        ),
        // 15 + 9 + 3 + 6, x = 2, and a parameter from local memory for each of six components.
        (
            "safe_normalize.gfx1100.txt",
            counting(&[]),
            &[(Vector, 33, 33), (Transcendental, 8, 8), (Local, 6, 6)],
        ),
        // 16 iterations: 15 + (6 + 16 * (1 + 19) + 1 + 2) + 1 + 4, x = (2 + 16 * 4 + 1).
        (
            "pcf_vogel.navi21.txt",
            counting(&[16]),
            &[(Vector, 20, 349), (Transcendental, 0, 268), (Texture, 0, 16), (ScalarMemory, 0, 17)],
        ),
        // 3 iterations of 5: 11 + (5 + 3 * (1 + 1 + 5 * (1 + 11) + 1 + 1) + 1 + 4) + 1 + 3, x = (2 + 1).
        (
            "pcf_grid.navi21.txt",
            counting(&[3, 5]),
            &[(Vector, 15, 217), (Transcendental, 0, 12), (Texture, 0, 15)],
        ),
        // 16 iterations by the code: 27 + 9 + 3 + 12 + 16 * (20 + (9) + 2 + 8 + (3) + (11)) + 1, where a
        // shift of 64 bits counts twice; x = 1 + 2 + 1 + 16 * ((1) + 1 + (1)).
        (
            "contact_shadows.navi21.txt",
            counting(&[]),
            &[(Vector, 532, 900), (Transcendental, 80, 208), (Texture, 17, 17), (Export, 1, 1)],
        ),
    ];
    for (name, counting, wanted) in cases {
        expect(name, &recorded(name)?, counting, wanted)?;
    }
    Ok(())
}

/// Where the code does not say how often loops run, each counts once and is told.
fn open_loops() -> Outcome {
    let open = |name: &str, iterations: &[u32]| -> Result<usize, Failed> {
        Ok(count_machine(&recorded(name)?, counting(iterations))?.open_loops())
    };
    let found = [
        open("pcf_grid.navi21.txt", &[])?,
        open("pcf_grid.navi21.txt", &[3])?,
        open("contact_shadows.navi21.txt", &[])?,
    ];
    match found {
        [2, 0, 0] => Ok(()),
        _ => Err(format!("{found:?} loops of unknown length, expected [2, 0, 0]").into()),
    }
}

/// RDNA has 32 lanes: a wave of 32 threads takes one clock cycle for a vector instruction, and one of
/// 64 threads two (AMD, "RDNA Architecture" white paper, 2019, "Compute unit architecture"). So for 64
/// threads, vector instructions take as long in two waves as in one. What is done once for a wave is
/// done twice. A dual instruction issues once.
fn waves_of_32_threads() -> Outcome {
    let text = "BB0:\n\tv_add_f32_e32 v0, v1, v2\n\
                \tv_dual_mul_f32 v0, v1, v2 :: v_dual_add_f32 v3, v4, v5\n\
                \tv_pk_add_f16 v1, v2, v3\n\tv_rcp_f32_e32 v0, v0\n\
                \ts_lshl_b32 s0, s0, 1\n\ts_load_dword s0, s[2:3], null\n\
                \timage_sample_lz v1, [v0, v4], s[8:15], s[4:7] dmask:0x1\n\
                \texp mrt0 v0, v0, v0, v0 done vm\n\ts_endpgm\n";
    let each = |once: i64| {
        [
            (Unit::Vector, 3, 3),
            (Unit::Transcendental, 4, 4),
            (Unit::Texture, 1, 1),
            (Unit::Scalar, once, once),
            (Unit::ScalarMemory, once, once),
            (Unit::Export, once, once),
        ]
    };
    expect("64", text, counting(&[]), &each(1))?;
    expect("32", text, Counting { wave: 32, ..counting(&[]) }, &each(2))
}

/// Cycles, and those in which an instruction issues: by `get_perf_info` in Mesa 22.3's
/// `aco_statistics.cpp`, which counts clock cycles, four of which are one here on GCN.
fn rates() -> Outcome {
    let cases = [
        ("v_rcp_f32_e32 v0, v1", (4, 1), (4, 4)),
        ("v_exp_f32_e64 v0, -v1", (4, 1), (4, 4)),
        ("v_rcp_f64_e32 v[0:1], v[2:3]", (16, 16), (16, 16)),
        ("v_mul_lo_u32 v0, v1, v2", (4, 4), (4, 4)),
        ("v_mul_hi_u32 v0, v1, v2", (4, 4), (4, 4)),
        ("v_mul_hi_u32_u24_e32 v0, v1, v2", (1, 1), (1, 1)),
        ("v_cvt_f32_u32_e32 v0, v1", (1, 1), (4, 4)),
        ("v_fma_f32 v0, v1, v2, v3", (1, 1), (4, 4)),
        ("v_mad_f32 v0, v1, v2, v3", (1, 1), (1, 1)),
        ("v_add_f64 v[0:1], v[2:3], v[4:5]", (16, 16), (8, 8)),
        ("v_mul_f64 v[0:1], v[2:3], v[4:5]", (16, 16), (16, 16)),
        ("v_cvt_f32_f64_e32 v0, v[2:3]", (16, 16), (4, 4)),
        ("v_cvt_f64_u32_e32 v[0:1], v2", (16, 16), (4, 4)),
        ("v_lshlrev_b64 v[0:1], v2, v[4:5]", (2, 2), (2, 2)),
        ("v_cmp_lt_f32_e32 vcc, v0, v1", (1, 1), (1, 1)),
        ("s_waitcnt vmcnt(0)", (0, 0), (0, 0)),
        ("v_add_f32_e32 v0, v1, v2\n\t(then repeated 2 times)", (3, 3), (3, 3)),
    ];
    for (instruction, rdna, gcn) in cases {
        let text = format!("BB0:\n\t{instruction}\n\ts_endpgm\n");
        for (rates, (cycles, issue)) in [(Rates::RDNA, rdna), (Rates::GCN, gcn)] {
            let wanted = [(Unit::Cycles, cycles, cycles), (Unit::Issue, issue, issue)];
            expect(instruction, &text, Counting { rates, ..counting(&[]) }, &wanted)?;
        }
    }
    Ok(())
}

/// A branch on two constants goes one way.
fn decided_branches() -> Outcome {
    let text = |compare: &str, branch: &str| {
        format!(
            "BB0:\n\t{compare}\n\t{branch} BB2\nBB1:\n\tv_mov_b32_e32 v0, 0\n\
             BB2:\n\tv_mov_b32_e32 v1, 0\n\ts_endpgm\n"
        )
    };
    let cases = [
        ("s_cmp_eq_i32 0, 1", "s_cbranch_scc0", (1, 1)),
        ("s_cmp_eq_i32 0, 1", "s_cbranch_scc1", (2, 2)),
        ("s_cmp_gt_u32 -1, 1", "s_cbranch_scc1", (1, 1)),
        ("s_cmp_gt_i32 -1, 1", "s_cbranch_scc1", (2, 2)),
        ("s_cmp_eq_i32 s0, 1", "s_cbranch_scc0", (1, 2)),
    ];
    for (compare, branch, (least, most)) in cases {
        let text = text(compare, branch);
        expect(compare, &text, counting(&[]), &[(Unit::Vector, least, most)])?;
    }
    Ok(())
}

/// LLVM reads no load into `s[104:107]`, and then reads an export that is none, and a product of
/// vectors of halves that is none: the words are those of a load, and of the median of three with a
/// literal.
fn lost_instructions() -> Outcome {
    let text = "BB0:
	v_med3_f32 v14, 0, 1.0, v12                                 ; d557000e 0431e480
(invalid instruction)                                        ; f4281a0c
	exp mrt0 off, off, off, off                                 ; fa000000 d5578031
	v_dot2c_f32_f16_e32 v98, 0x3d4ccccd, v242                   ; 04c5e4ff 3d4ccccd
	v_rcp_f32_e32 v49, v49                                      ; 7e625531
	s_endpgm                                                    ; bf810000
";
    let wanted = [
        (Unit::Vector, 2, 2),
        (Unit::Cycles, 6, 6),
        (Unit::ScalarMemory, 1, 1),
        (Unit::Export, 0, 0),
    ];
    expect("lost", text, counting(&[]), &wanted)?;
    // A load, a move, a wait, another load, and then a product as it should be.
    let longer = "BB0:
	s_mov_b32 s35, 0x3f5bab86                                   ; bea303ff 3f5bab86
	s_waitcnt vmcnt(0)                                          ; bf8c3f70
(invalid instruction)                                        ; f4081a00
	exp mrt0 off, off, off, off                                 ; fa000130 be93032b
	s_waitcnt lgkmcnt(0)                                        ; bf8cc07f
	s_buffer_load_dwordx4 s[40:43], s[104:107], null            ; f4280a34 fa000000
	v_fma_f32 v49, v53, v49, 1.0                                ; d54b0031 03ca6335
	s_endpgm                                                    ; bf810000
";
    let wanted = [(Unit::Vector, 1, 1), (Unit::Scalar, 2, 2), (Unit::ScalarMemory, 2, 2)];
    expect("longer", longer, counting(&[]), &wanted)?;
    let unknown = text.replace("d557000e", "d54b000e");
    match count_machine(&unknown, counting(&[])) {
        Err(MachineError::Unreadable(words)) if words == "d5578031" => Ok(()),
        found => Err(format!("expected an error about `d5578031`, found {found:?}").into()),
    }
}

/// What is not understood is an error that names it, and never counts as nothing.
fn refused_texts() -> Outcome {
    let unknown = "BB0:\n\tv_frobnicate_f32 v0\n\ts_hum 1\n\tv_add_u64_e32 v0\n\ts_endpgm\n";
    let names = ["s_hum", "v_add_u64", "v_frobnicate_f32"].map(str::to_owned).to_vec();
    let cases = [
        ("", MachineError::NoText),
        (unknown, MachineError::UnknownInstructions(names)),
        ("BB0:\n\ts_branch BB7\n", MachineError::UnknownTarget("BB7".to_owned())),
        ("BB0:\n\ts_cbranch_scc0 65498\n", MachineError::UnknownTarget("65498".to_owned())),
        ("BB0:\n\ts_nop 0\n\ts_branch BB0\n", MachineError::NoEnd),
        (
            "BB0:\n\ts_cbranch_scc0 BB2\nBB1:\n\ts_nop 0\nBB2:\n\ts_cbranch_scc0 BB1\n\ts_endpgm\n",
            MachineError::Irreducible("BB2".to_owned()),
        ),
    ];
    for (text, wanted) in cases {
        let found = count_machine(text, counting(&[]));
        if found.as_ref() != Err(&wanted) {
            return Err(format!("{text}: expected {wanted:?}, found {found:?}").into());
        }
    }
    Ok(())
}

/// How often a loop runs: by its counter, which begins, steps and is compared in several ways.
fn limits_of_loops() -> Outcome {
    let text = |first: &str, limit: &str, test: &str, step: &str| {
        format!(
            "BB0:\n\ts_mov_b32 s0, {first}\n\t{limit}\nBB1:\n\t{test}\n\ts_cbranch_scc1 BB3\n\
             BB2:\n\tv_mov_b32_e32 v0, 0\n\t{step}\n\ts_branch BB1\nBB3:\n\ts_endpgm\n"
        )
    };
    let cases = [
        ("0", "s_nop 0", "s_cmp_ge_u32 s0, 7", "s_add_u32 s0, s0, 1", (7, 7, 0)),
        ("1", "s_nop 0", "s_cmp_gt_i32 s0, 7", "s_addk_i32 s0, 0x2", (4, 4, 0)),
        ("7", "s_nop 0", "s_cmp_lt_i32 s0, 0", "s_sub_u32 s0, s0, 1", (8, 8, 0)),
        ("0", "s_nop 0", "s_cmp_eq_u32 s0, 5", "s_add_u32 s0, 1, s0", (5, 5, 0)),
        ("0", "s_min_u32 s1, s9, 4", "s_cmp_le_u32 s1, s0", "s_add_u32 s0, s0, 1", (0, 4, 0)),
        ("2", "s_min_u32 s1, s9, 1", "s_cmp_ge_u32 s0, s1", "s_add_u32 s0, s0, 1", (0, 0, 0)),
        ("0", "s_mov_b32 s1, 3", "s_cmp_ge_u32 s0, s1", "s_add_u32 s0, s0, 1", (3, 3, 0)),
        // Constants of 16 bits have a sign, and a counter has 32 bits.
        ("4", "s_nop 0", "s_cmpk_lt_i32 s0, 0xffff", "s_addk_i32 s0, 0xffff", (6, 6, 0)),
        ("0x7ffffffe", "s_nop 0", "s_cmp_lt_i32 s0, 0", "s_add_u32 s0, s0, 1", (2, 2, 0)),
        // At most 4 as a signed number may be a large one without a sign.
        ("0", "s_min_i32 s1, s9, 4", "s_cmp_ge_u32 s0, s1", "s_add_u32 s0, s0, 1", (1, 1, 1)),
        ("0", "s_min_i32 s1, s9, 4", "s_cmp_ge_i32 s0, s1", "s_add_u32 s0, s0, 1", (0, 4, 0)),
        ("0", "s_min_u32 s1, s9, 4", "s_cmp_ge_i32 s0, s1", "s_add_u32 s0, s0, 1", (0, 4, 0)),
        ("0", "s_min_u32 s1, s9, -1", "s_cmp_ge_i32 s0, s1", "s_add_u32 s0, s0, 1", (1, 1, 1)),
        (
            "0",
            "s_max_i32 s1, s9, 0\n\ts_min_i32 s1, s1, 4",
            "s_cmp_ge_u32 s0, s1",
            "s_add_u32 s0, s0, 1",
            (0, 4, 0),
        ),
        // The limit is not known, or a lower one might be stepped over.
        ("0", "s_max_u32 s1, s9, 4", "s_cmp_ge_u32 s0, s1", "s_add_u32 s0, s0, 1", (1, 1, 1)),
        ("0", "s_min_u32 s1, s9, 4", "s_cmp_eq_u32 s0, s1", "s_add_u32 s0, s0, 2", (1, 1, 1)),
        ("s7", "s_nop 0", "s_cmp_ge_u32 s0, 7", "s_add_u32 s0, s0, 1", (1, 1, 1)),
        ("0", "s_nop 0", "s_cmp_ge_u32 s0, 7", "s_add_u32 s0, s0, s3", (1, 1, 1)),
        ("0", "s_nop 0", "s_cmp_ge_u32 s0, 7", "s_load_dwordx2 s[0:1], s[2:3], 0x0", (1, 1, 1)),
        ("0", "s_nop 0", "s_cmp_ge_u32 s0, 7", "s_nop 0", (1, 1, 1)),
    ];
    for (first, limit, test, step, (least, most, open)) in cases {
        let text = text(first, limit, test, step);
        expect(&text, &text, counting(&[]), &[(Unit::Vector, least, most)])?;
        let found = count_machine(&text, counting(&[]))?.open_loops();
        if found != open {
            return Err(format!("{text}: {found} loops of unknown length, expected {open}").into());
        }
    }
    Ok(())
}

/// A loop over a counter in a vector register, as the compiler writes it. `first` and `step` set and
/// change it.
fn threads_text(first: &str, step: &str) -> String {
    format!(
        "BB0:
	{first}
	s_mov_b64 s[0:1], exec
BB1:
	s_mov_b64 s[2:3], exec
	v_cmpx_le_u32_e32 8, v1
BB2:
	s_andn2_b64 s[2:3], s[2:3], exec
	s_cbranch_scc0 BB16
BB9:
	s_mov_b64 exec, s[2:3]
	v_rcp_f32_e32 v0, v0
	{step}
	s_branch BB1
BB16:
	s_mov_b64 exec, s[0:1]
	exp mrt0 v0, v0, v0, v0 done vm
	s_endpgm
"
    )
}

/// A counter that each thread has for itself: what only some threads write says nothing of the others.
fn limits_of_threads() -> Outcome {
    let (set, step) = ("v_mov_b32_e32 v1, 0", "v_add_nc_u32_e32 v1, 1, v1");
    let guarded = |lines: &str, end: &str| {
        format!("s_mov_b64 s[8:9], exec\n\tv_cmpx_lt_f32_e32 0.5, v0\n\t{lines}\n\t{end}")
    };
    let restored = "s_mov_b64 exec, s[8:9]";
    let swapped = format!("s_andn2_b64 exec, s[8:9], exec\n\t{set}\n\t{restored}");
    let cases = [
        (set.to_owned(), step.to_owned(), (8, 0)),
        // Some threads are switched off before, and stay so, or a whole wave is on.
        (format!("v_cmpx_lt_f32_e32 0.5, v0\n\t{set}"), step.to_owned(), (8, 0)),
        (format!("{set}\n\tv_cmpx_lt_f32_e32 0.5, v0"), step.to_owned(), (8, 0)),
        (format!("s_mov_b64 exec, -1\n\t{set}\n\ts_mov_b64 exec, s[6:7]"), step.to_owned(), (8, 0)),
        (format!("{set}\n\ts_mov_b64 exec, s[6:7]"), step.to_owned(), (1, 1)),
        // Only some threads begin at 0.
        (guarded(set, restored), step.to_owned(), (1, 1)),
        (guarded("v_mov_b32_e32 v1, 7", &swapped), step.to_owned(), (1, 1)),
        // Only some threads step on, or all that stay do.
        (set.to_owned(), guarded(step, restored), (1, 1)),
        (set.to_owned(), guarded("s_nop 0", step), (8, 0)),
        // The second half of a dual instruction changes the counter.
        (
            set.to_owned(),
            format!("{step}\n\tv_dual_mov_b32 v5, v6 :: v_dual_mov_b32 v1, v7"),
            (1, 1),
        ),
    ];
    for (first, step, (times, open)) in cases {
        let text = threads_text(&first, &step);
        let found = count_machine(&text, counting(&[]))?;
        let (roots, unknown) = (found.most.of(Unit::Transcendental), found.open_loops());
        if (roots, unknown) != (4 * times, open) {
            let what = format!("{roots} cycles, {unknown} loops of unknown length");
            return Err(format!("{text}: {what}, expected {} and {open}", 4 * times).into());
        }
    }
    // Some threads begin at 7 and some at 0: 3 + (8 + 6 x) + 1 + (1 + 3 + 2 x) + 1.
    let wanted = [(Unit::Vector, 9, 17), (Unit::Transcendental, 8, 32)];
    expect("start", &recorded("divergent_start.navi21.txt")?, counting(&[]), &wanted)?;
    // A thread steps on only where it takes the second side.
    let found = count_machine(&recorded("divergent_step.navi21.txt")?, counting(&[]))?;
    let bounds = count_machine(&recorded("divergent_limit.polaris10.txt")?, counting(&[]))?;
    match (found.open_loops(), bounds.open_loops()) {
        (1, 1) => Ok(()),
        open => Err(format!("{open:?} loops of unknown length, expected 1 in both").into()),
    }
}

/// Where the test is behind the work, a loop of N iterations does the work N times: a sine, another,
/// and a root.
fn tested_at_the_end() -> Outcome {
    let text = recorded("tested_at_the_end.navi21.txt")?;
    for (iterations, times) in [(&[][..], 1), (&[1], 1), (&[2], 2), (&[16], 16)] {
        // 2 + N * (3 + 3 x).
        let (vector, transcendental) = (2 + 3 * times, 12 * times);
        let wanted = [
            (Unit::Vector, vector, vector),
            (Unit::Transcendental, transcendental, transcendental),
        ];
        expect("at the end", &text, counting(iterations), &wanted)?;
    }
    Ok(())
}
