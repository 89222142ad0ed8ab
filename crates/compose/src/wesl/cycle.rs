//! Finds declarations that depend on themselves.

use super::reached::{Dependency, Reached, Thing, name_of};
use crate::resolve::wesl::Graph;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_syntax::wesl::ItemKind;

/// Reports cycles among constants, overrides, aliases, structs and variables: one error for each.
pub fn check_cycles(graph: &Graph, reached: &Reached, errors: &mut Diagnostics) {
    let mut edges: Vec<Dependency> = reached
        .dependencies
        .iter()
        .filter(|edge| !is_function(graph, edge.used))
        .copied()
        .collect();
    edges.sort_by_key(|edge| (edge.user, edge.span));
    let mut done = vec![false; reached.len()];
    for start in 0..edges.len() {
        if !done[reached.index(edges[start].user)] {
            search_cycle(graph, reached, &edges, start, &mut done, errors);
        }
    }
}

fn is_function(graph: &Graph, thing: Thing) -> bool {
    match thing {
        Thing::Item { node, item } => {
            graph.nodes[node as usize].module.items[item as usize].kind == ItemKind::Function
        }
        Thing::Constant(_) => true,
    }
}

/// A depth-first search from the user of the edge `start`, without recursion.
fn search_cycle(
    graph: &Graph,
    reached: &Reached,
    edges: &[Dependency],
    start: usize,
    done: &mut [bool],
    errors: &mut Diagnostics,
) {
    let first = |thing: Thing| edges.partition_point(|edge| edge.user < thing);
    // The path so far: each thing, with the next of its edges to follow.
    let mut path: Vec<(Thing, usize)> = vec![(edges[start].user, first(edges[start].user))];
    let mut on_path = vec![false; done.len()];
    on_path[reached.index(edges[start].user)] = true;
    while let Some((thing, next)) = path.last_mut() {
        let (thing, at) = (*thing, *next);
        *next += 1;
        let Some(edge) = edges.get(at).filter(|edge| edge.user == thing) else {
            on_path[reached.index(thing)] = false;
            done[reached.index(thing)] = true;
            path.pop();
            continue;
        };
        let used = reached.index(edge.used);
        if on_path[used] {
            let from = path.iter().position(|(thing, _)| *thing == edge.used).unwrap_or(0);
            errors.push(report_cycle(graph, edges, &path[from..]));
        } else if !done[used] {
            on_path[used] = true;
            path.push((edge.used, first(edge.used)));
        }
    }
}

/// The most steps of a cycle that a message lists.
const MOST_LISTED: usize = 12;

fn report_cycle(graph: &Graph, edges: &[Dependency], circle: &[(Thing, usize)]) -> Diagnostic {
    let text = |thing: Thing| graph.names.text(name_of(graph, thing));
    let first = text(circle[0].0);
    let mut chain: Vec<String> =
        circle.iter().take(MOST_LISTED).map(|(thing, _)| format!("`{}`", text(*thing))).collect();
    if circle.len() > MOST_LISTED {
        chain.push(format!("{} more", circle.len() - MOST_LISTED));
    }
    let chain = chain.join(" -> ");
    let message = format!("`{first}` depends on itself: {chain} -> `{first}`");
    let mut error = Diagnostic::error(codes::CYCLIC_CONSTANT, message);
    for (thing, next) in circle.iter().take(MOST_LISTED) {
        let edge = &edges[next - 1];
        error = error.at(edge.span, format!("`{}` uses `{}`", text(*thing), text(edge.used)));
    }
    error.note(match circle.len() {
        1 => {
            "help: a structure cannot hold itself, and a constant is not made of itself: an index \
             (`u32`) into an array stands for another element"
        }
        _ => "help: break the circle: write one of the values out",
    })
}
