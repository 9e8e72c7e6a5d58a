//! The columns and rows of a diagram: what drives stands left of what it drives.
//!
//! Parts are visited from the commands on, along signals and connections; each stands in the column behind all that lead to
//! it. Of what hangs at one joint that goes straight on which leads furthest, and the others stand below.

use super::Diagram;
use std::collections::VecDeque;

/// Where each node stands: the parts, then the joints of more than two.
pub(super) struct Layers {
    pub(super) columns: Vec<usize>,
    pub(super) rows: Vec<usize>,
    /// The node of each joint; none where two parts are connected directly.
    pub(super) joints: Vec<Option<usize>>,
    /// How many bars of other joints stand left of that of a joint in the same column.
    pub(super) bars: Vec<usize>,
}

pub(super) fn layers(diagram: &Diagram) -> Layers {
    let n_parts = diagram.parts.len();
    let mut nodes = n_parts;
    let joints: Vec<Option<usize>> = diagram
        .joints
        .iter()
        .map(|joint| {
            (joint.len() > 2).then(|| {
                nodes += 1;
                nodes - 1
            })
        })
        .collect();
    // Ways on from each node: along signals, and both ways along connections.
    let mut ways: Vec<Vec<usize>> = vec![Vec::new(); nodes];
    let mut read = vec![false; nodes];
    for &(from, to) in &diagram.signals {
        ways[from].push(to);
        read[to] = true;
    }
    let mut links = vec![0_usize; nodes];
    for (joint, node) in diagram.joints.iter().zip(&joints) {
        match node {
            Some(node) => {
                for &part in joint {
                    ways[part].push(*node);
                    ways[*node].push(part);
                }
            }
            None => {
                for pair in joint.windows(2) {
                    ways[pair[0]].push(pair[1]);
                    ways[pair[1]].push(pair[0]);
                }
            }
        }
        joint.iter().for_each(|&part| links[part] += 1);
    }
    let order = visited(diagram, &ways, &read, &links);
    let columns = columns(diagram, &ways, &order);
    let rows = rows(&ways, &order, &columns);
    let bars = bars(diagram, &joints, &columns, &rows);
    Layers {
        columns,
        rows,
        joints,
        bars,
    }
}

/// Bars of joints in one column stand side by side where both are at some height.
fn bars(
    diagram: &Diagram,
    joints: &[Option<usize>],
    columns: &[usize],
    rows: &[usize],
) -> Vec<usize> {
    let mut bars = vec![0_usize; columns.len()];
    // Of each bar its column, its place, and the rows from the first to the last.
    let mut known: Vec<(usize, usize, (usize, usize))> = Vec::new();
    for (joint, node) in diagram.joints.iter().zip(joints) {
        let Some(node) = *node else { continue };
        let beside = joint.iter().copied();
        let beside = beside.filter(|&part| columns[part].abs_diff(columns[node]) == 1);
        let reach = beside.map(|part| rows[part]).chain([rows[node]]);
        let (first, last) = reach.fold((usize::MAX, 0), |(first, last), row| {
            (first.min(row), last.max(row))
        });
        let stands = |bar: usize| {
            let mut own = known.iter();
            own.any(|&(column, other, (top, end))| {
                column == columns[node] && other == bar && first <= end && top <= last
            })
        };
        let bar = (0..).find(|&bar| !stands(bar)).unwrap_or(0);
        bars[node] = bar;
        known.push((columns[node], bar, (first, last)));
    }
    bars
}

/// The nodes in the order of a search in breadth: from inputs, else from what reads nothing, else from an end of a chain.
fn visited(diagram: &Diagram, ways: &[Vec<usize>], read: &[bool], links: &[usize]) -> Vec<usize> {
    let parts = || 0..diagram.parts.len();
    let is_input = |part: usize| diagram.parts[part].class.is_empty();
    let mut starts: Vec<usize> = parts().filter(|&part| is_input(part)).collect();
    starts
        .extend(parts().filter(|&part| !read[part] && !ways[part].is_empty() && links[part] == 0));
    starts.extend(parts().filter(|&part| !read[part] && links[part] == 1));
    starts.extend(parts());
    let mut order: Vec<usize> = Vec::new();
    let mut known = vec![false; ways.len()];
    let inputs = starts.iter().take_while(|&&part| is_input(part)).count();
    // Inputs begin together; any other start only where nothing leads to it.
    let mut queue: VecDeque<usize> = starts[..inputs].iter().copied().collect();
    for &part in &queue {
        known[part] = true;
    }
    let mut rest = starts[inputs..].iter().copied();
    loop {
        while let Some(node) = queue.pop_front() {
            order.push(node);
            for &next in &ways[node] {
                if !std::mem::replace(&mut known[next], true) {
                    queue.push_back(next);
                }
            }
        }
        match rest.find(|&part| !known[part]) {
            Some(part) => {
                known[part] = true;
                queue.push_back(part);
            }
            None => return order,
        }
    }
}

/// Behind the last of those that lead to a node and were visited before; an input stands right before what reads it. Parts
/// have the even columns, and joints the odd ones between them.
fn columns(diagram: &Diagram, ways: &[Vec<usize>], order: &[usize]) -> Vec<usize> {
    let mut columns = vec![0_usize; ways.len()];
    let mut place = vec![0_usize; ways.len()];
    for (at, &node) in order.iter().enumerate() {
        place[node] = at;
    }
    let is_part = |node: usize| node < diagram.parts.len();
    for &node in order {
        for &next in &ways[node] {
            if place[next] > place[node] {
                let further = if is_part(node) && is_part(next) { 2 } else { 1 };
                columns[next] = columns[next].max(columns[node] + further);
            }
        }
    }
    for (part, known) in diagram.parts.iter().enumerate() {
        if known.class.is_empty() {
            let readers = ways[part].iter().map(|&reader| columns[reader]).min();
            columns[part] = readers.unwrap_or(2).saturating_sub(2);
        }
    }
    columns
}

/// Rows from the top: each node as near as it can to what leads to it.
fn rows(ways: &[Vec<usize>], order: &[usize], columns: &[usize]) -> Vec<usize> {
    let mut reach = vec![1_usize; ways.len()];
    for &node in order.iter().rev() {
        let next = ways[node]
            .iter()
            .filter(|&&next| columns[next] > columns[node]);
        reach[node] += next.map(|&next| reach[next]).sum::<usize>();
    }
    let mut rows = vec![0_usize; ways.len()];
    let last = columns.iter().copied().max().unwrap_or(0);
    for column in 0..=last {
        let mut own: Vec<(usize, usize)> = (0..ways.len())
            .filter(|&node| columns[node] == column)
            .map(|node| {
                let before = (0..ways.len())
                    .filter(|&from| columns[from] < column && ways[from].contains(&node));
                (before.map(|from| rows[from]).min().unwrap_or(0), node)
            })
            .collect();
        own.sort_by_key(|&(row, node)| (row, std::cmp::Reverse(reach[node]), node));
        let mut free = 0;
        for (row, node) in own {
            rows[node] = row.max(free);
            free = rows[node] + 1;
        }
    }
    rows
}
