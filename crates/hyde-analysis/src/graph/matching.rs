//! Maximum bipartite matching by augmenting paths, and the parts of the graph that stay unmatched.

/// A bipartite graph: for each left node its right neighbours in order of preference.
#[derive(Clone, Debug, Default)]
pub struct Bipartite {
    /// Right neighbours of each left node.
    pub edges: Vec<Vec<usize>>,
    /// Number of right nodes.
    pub n_right: usize,
}

/// A maximum matching.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Matching {
    /// The partner of each left node.
    pub of_left: Vec<Option<usize>>,
    /// The partner of each right node.
    pub of_right: Vec<Option<usize>>,
}

impl Bipartite {
    /// A maximum matching. Left nodes are served in order and take the first free neighbour of their preference;
    /// augmenting paths (Berge 1957) mend what greed spoils.
    #[must_use]
    pub fn maximum_matching(&self) -> Matching {
        let mut matching = Matching {
            of_left: vec![None; self.edges.len()],
            of_right: vec![None; self.n_right],
        };
        for (left, neighbours) in self.edges.iter().enumerate() {
            if let Some(&right) = neighbours
                .iter()
                .find(|&&right| matching.of_right[right].is_none())
            {
                matching.of_left[left] = Some(right);
                matching.of_right[right] = Some(left);
            }
        }
        let mut visited = vec![usize::MAX; self.n_right];
        for left in 0..self.edges.len() {
            if matching.of_left[left].is_none() {
                self.augment(left, &mut matching, &mut visited);
            }
        }
        matching
    }

    /// Left and right nodes on alternating paths from an unmatched left node: the over-determined part it is in
    /// (Dulmage and Mendelsohn 1958).
    #[must_use]
    pub fn over_determined(&self, matching: &Matching, left: usize) -> (Vec<usize>, Vec<usize>) {
        let (mut lefts, mut rights) = (vec![left], Vec::new());
        let mut at = 0;
        while let Some(&node) = lefts.get(at) {
            at += 1;
            for &right in &self.edges[node] {
                if !rights.contains(&right) {
                    rights.push(right);
                    lefts.extend(matching.of_right[right].filter(|next| !lefts.contains(next)));
                }
            }
        }
        lefts.sort_unstable();
        rights.sort_unstable();
        (lefts, rights)
    }

    /// Left and right nodes on alternating paths from an unmatched right node: the under-determined part it is in.
    #[must_use]
    pub fn under_determined(&self, matching: &Matching, right: usize) -> (Vec<usize>, Vec<usize>) {
        let (mut lefts, mut rights) = (Vec::new(), vec![right]);
        let mut at = 0;
        while let Some(&node) = rights.get(at) {
            at += 1;
            for (left, neighbours) in self.edges.iter().enumerate() {
                if neighbours.contains(&node) && !lefts.contains(&left) {
                    lefts.push(left);
                    rights.extend(matching.of_left[left].filter(|next| !rights.contains(next)));
                }
            }
        }
        lefts.sort_unstable();
        rights.sort_unstable();
        (lefts, rights)
    }

    /// Depth-first search for an augmenting path from an unmatched left node, with an explicit stack.
    fn augment(&self, root: usize, matching: &mut Matching, visited: &mut [usize]) {
        let mut path: Vec<(usize, usize)> = vec![(root, 0)];
        while let Some(&(left, next)) = path.last() {
            let Some(&right) = self.edges[left].get(next) else {
                path.pop();
                continue;
            };
            if let Some(last) = path.last_mut() {
                last.1 += 1;
            }
            if visited[right] == root {
                continue;
            }
            visited[right] = root;
            match matching.of_right[right] {
                Some(other) => path.push((other, 0)),
                None => {
                    for &(left, next) in path.iter().rev() {
                        let right = self.edges[left][next - 1];
                        matching.of_left[left] = Some(right);
                        matching.of_right[right] = Some(left);
                    }
                    return;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn augmenting_paths_mend_the_greedy_choice() {
        let graph = Bipartite {
            edges: vec![vec![0, 1], vec![0], vec![1, 2]],
            n_right: 3,
        };
        let matching = graph.maximum_matching();
        assert_eq!(matching.of_left, vec![Some(1), Some(0), Some(2)]);
    }

    #[test]
    fn unmatched_nodes_name_their_part() {
        // Lefts 0 and 1 both know right 0 only; right 2 is known to left 2 alone with right 1.
        let graph = Bipartite {
            edges: vec![vec![0], vec![0], vec![1, 2]],
            n_right: 3,
        };
        let matching = graph.maximum_matching();
        let left = (0..3)
            .find(|&left| matching.of_left[left].is_none())
            .unwrap();
        assert_eq!(
            graph.over_determined(&matching, left),
            (vec![0, 1], vec![0])
        );
        let right = (0..3)
            .find(|&right| matching.of_right[right].is_none())
            .unwrap();
        assert_eq!(
            graph.under_determined(&matching, right),
            (vec![2], vec![1, 2])
        );
    }
}
