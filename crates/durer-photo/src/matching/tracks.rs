//! Tracks, which are features matched across photographs that ideally show the same scene point.

/// Feature, identified by the index of its photograph and its index in that photograph.
pub type FeatureId = (usize, usize);

/// Returns the connected components of the graph of matched features, each sorted by photograph. A
/// component with two features in the same photograph cannot be a single point, and is dropped.
pub fn build_tracks(counts: &[usize], matches: impl Iterator<Item = (FeatureId, FeatureId)>) -> Vec<Vec<FeatureId>> {
    let mut starts = vec![0];
    counts.iter().for_each(|count| starts.push(starts[starts.len() - 1] + count));
    let mut parents: Vec<usize> = (0..starts[counts.len()]).collect();
    fn root(parents: &mut [usize], mut i: usize) -> usize {
        while parents[i] != i {
            parents[i] = parents[parents[i]];
            i = parents[i];
        }
        i
    }
    for (a, b) in matches {
        let (a, b) = (root(&mut parents, starts[a.0] + a.1), root(&mut parents, starts[b.0] + b.1));
        // The smaller index becomes the root, so the result does not depend on the order of
        // matches.
        parents[a.max(b)] = a.min(b);
    }
    let mut lists: Vec<Vec<FeatureId>> = vec![Vec::new(); parents.len()];
    for (photo, count) in counts.iter().enumerate() {
        for feature in 0..*count {
            lists[root(&mut parents, starts[photo] + feature)].push((photo, feature));
        }
    }
    lists.retain(|list| list.len() > 1 && list.windows(2).all(|pair| pair[0].0 != pair[1].0));
    lists
}
