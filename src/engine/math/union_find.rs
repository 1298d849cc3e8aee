//! Union-find: a forest in which each element points to an earlier one of its set, and the first to
//! itself. Floor 0.

/// The first element of an element's set.
#[inline]
pub fn first_of(parent: &mut [u32], mut i: u32) -> u32 {
    while parent[i as usize] != i {
        // Halving the path keeps it short.
        parent[i as usize] = parent[parent[i as usize] as usize];
        i = parent[i as usize];
    }
    i
}

/// Makes one set of two elements': the first element of both, and the other set's first, if there
/// were two sets.
#[inline]
pub fn join(parent: &mut [u32], a: u32, b: u32) -> (u32, Option<u32>) {
    let (a, b) = (first_of(parent, a), first_of(parent, b));
    let (first, later) = (a.min(b), a.max(b));
    parent[later as usize] = first;
    (first, (a != b).then_some(later))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joined_elements_have_the_first_of_them_in_common() {
        let mut parent: Vec<u32> = (0..8).collect();
        assert_eq!(join(&mut parent, 5, 3), (3, Some(5)));
        assert_eq!(join(&mut parent, 7, 5), (3, Some(7)));
        assert_eq!(join(&mut parent, 3, 7), (3, None));
        assert_eq!(join(&mut parent, 1, 7), (1, Some(3)));
        let firsts: Vec<u32> = (0..8).map(|i| first_of(&mut parent, i)).collect();
        assert_eq!(firsts, [0, 1, 2, 1, 4, 1, 6, 1]);
    }
}
