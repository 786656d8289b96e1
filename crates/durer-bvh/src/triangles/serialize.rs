//! Saves trees as bytes, and loads them.
//!
//! All numbers are little-endian. The format consists of a header, the nodes (field by field), the
//! rows of the leaves, and a checksum of everything before it. The header contains an eight-byte
//! name, the version, the numbers of triangles, nodes, and items as `u64`, and the minimum volume.
//! All data is checked. If a tree is accepted, no ray reads out of bounds, runs into a cycle, or
//! overflows the stack.

use super::rows::TAG;
use super::tree::TriangleBvh;
use crate::LoadError;
use crate::lanes::{ROWS, ROWS_LEN, WIDTH};
use crate::node::{self, IS_LEAF, LEAF, MAX_DEPTH, UNITS, WideNode};

const NAME: &[u8; 8] = b"durerbvh";
const VERSION: u32 = 1;
const HEAD: usize = 8 + 4 + 3 * 8 + 8;
/// Size of a node in bytes: planes, child codes, orders, first offset, and tags.
const NODE: usize = 4 * (6 * WIDTH + WIDTH + 2 + 1) + WIDTH;
const CHECKSUM: usize = 8;

impl TriangleBvh {
    /// Serialises the tree. The bytes are the same on every machine, and
    /// [`TriangleBvh::from_bytes`] reads them. The SIMD level is not stored.
    ///
    /// ```
    /// use durer_bvh::math::{Ray, Vec3};
    /// use durer_bvh::{BuildQuality, TriangleBvh};
    ///
    /// let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
    /// let built = TriangleBvh::build(&corners, &[[0, 1, 2]], BuildQuality::Best);
    /// let loaded = TriangleBvh::from_bytes(&built.to_bytes()).unwrap();
    /// let ray = Ray::new(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z);
    /// assert_eq!(loaded.closest(&ray), built.closest(&ray));
    /// ```
    pub fn to_bytes(&self) -> Vec<u8> {
        if self.heights.is_some() {
            return self.expanded().to_bytes();
        }
        let items = self.items();
        let mut to = Vec::with_capacity(HEAD + NODE * self.nodes.len() + 4 * ROWS * items + CHECKSUM);
        to.extend(NAME);
        to.extend(VERSION.to_le_bytes());
        for count in [self.count, self.nodes.len(), items] {
            to.extend((count as u64).to_le_bytes());
        }
        to.extend(self.min_volume.to_le_bytes());
        for WideNode { planes, children, reversed_octants, first, child_tags } in &self.nodes {
            planes.as_flattened().as_flattened().iter().for_each(|x| to.extend(x.to_le_bytes()));
            children.iter().chain(reversed_octants).chain([first]).for_each(|x| to.extend(x.to_le_bytes()));
            to.extend(child_tags);
        }
        self.leaves[..ROWS * items].iter().for_each(|x| to.extend(x.to_bits().to_le_bytes()));
        to.extend(checksum(&to).to_le_bytes());
        to
    }

    /// Deserialises a tree that [`TriangleBvh::to_bytes`] wrote.
    ///
    /// It is safe to load untrusted bytes. Forged bytes are either rejected or result in a tree
    /// that gives wrong results, but queries do not panic or run forever.
    ///
    /// # Errors
    ///
    /// Returns an error if the data is not a saved tree, has an unsupported version or a wrong
    /// length, or is damaged.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, LoadError> {
        let Some((head, rest)) = bytes.split_at_checked(HEAD).filter(|(head, _)| head.starts_with(NAME)) else {
            return Err(LoadError::NotATree);
        };
        let mut head = Reader(&head[NAME.len()..]);
        let version = head.u32();
        if version != VERSION {
            return Err(LoadError::UnsupportedVersion(version));
        }
        let [count, nodes, items] = [(); 3].map(|()| head.u64());
        let min_volume = f64::from_bits(head.u64());
        if count > node::MAX_ITEMS as u64 || items > node::MAX_ITEMS as u64 || nodes > node::MAX_NODES as u64 {
            return Err(LoadError::Invalid("it is too large"));
        }
        // The length is computed in 64 bits because the largest counts overflow a 32-bit `usize`.
        let expected = (HEAD + CHECKSUM) as u64 + NODE as u64 * nodes + (4 * ROWS) as u64 * items;
        let [count, nodes, items] = [count, nodes, items].map(|count| count as usize);
        if expected != bytes.len() as u64 {
            return Err(LoadError::WrongLength { expected, actual: bytes.len() });
        }
        let (all, sum) = bytes.split_at(bytes.len() - CHECKSUM);
        if Reader(sum).u64() != checksum(all) {
            return Err(LoadError::Damaged);
        }
        if !(0.0..f64::INFINITY).contains(&min_volume) {
            return Err(LoadError::Invalid("its least volume is out of range"));
        }
        let mut from = Reader(rest);
        let nodes: Vec<WideNode> = (0..nodes).map(|_| from.node()).collect();
        let mut leaves: Vec<f32> = (0..ROWS * items).map(|_| f32::from_bits(from.u32())).collect();
        leaves.resize(ROWS * items + ROWS_LEN, 0.0);
        check(&nodes, &leaves, items, count).map_err(LoadError::Invalid)?;
        let bounds = node::bounds(&nodes);
        Ok(TriangleBvh::of(nodes, leaves, bounds, count).min_volume(min_volume))
    }
}

/// Reads little-endian numbers from the bytes of a saved tree, which must be long enough.
struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> [u8; N] {
        let (taken, rest) = self.0.split_first_chunk().expect("the length was compared");
        self.0 = rest;
        *taken
    }

    fn u32(&mut self) -> u32 {
        u32::from_le_bytes(self.take())
    }

    fn u64(&mut self) -> u64 {
        u64::from_le_bytes(self.take())
    }

    fn node(&mut self) -> WideNode {
        WideNode {
            planes: [(); 3].map(|()| [(); 2].map(|()| [(); WIDTH].map(|()| f32::from_bits(self.u32())))),
            children: [(); WIDTH].map(|()| self.u32()),
            reversed_octants: [(); 2].map(|()| self.u32()),
            first: self.u32(),
            child_tags: self.take(),
        }
    }
}

/// Checks that the nodes form a tree whose leaves hold every item exactly once, and that the items
/// are triangles.
fn check(nodes: &[WideNode], leaves: &[f32], items: usize, count: usize) -> Result<(), &'static str> {
    if nodes.is_empty() != (items == 0) {
        return Err("nodes and leaves do not match");
    }
    // Depth of each node, which is set when its parent is visited. The root has depth 0.
    let mut depths = vec![None; nodes.len()];
    depths.iter_mut().take(1).for_each(|depth| *depth = Some(0));
    let mut is_taken = vec![false; items];
    for (i, node) in nodes.iter().enumerate() {
        let depth: usize = depths[i].ok_or("a node precedes its parent")?;
        if depth >= MAX_DEPTH {
            return Err("it is too deep");
        }
        for place in 0..WIDTH {
            let (bounds, child, tag) = (node.bounds(place), node.children[place], node.child_tags[place]);
            if bounds == crate::math::Aabb::EMPTY {
                continue;
            }
            if !(bounds.min.is_finite() && bounds.max.is_finite()) || bounds.is_empty() {
                return Err("a box is invalid");
            }
            let rest = if child & LEAF == 0 { child.wrapping_sub(node.first) } else { IS_LEAF };
            if rest != IS_LEAF && rest & !node::OFFSET_BITS != 0 || u32::from(tag) != place as u32 | rest {
                return Err("the child tags of a node are wrong");
            }
            if child & LEAF == 0 {
                let number = node::node_index(child);
                if !(child as usize).is_multiple_of(UNITS) || number <= i || number >= nodes.len() {
                    return Err("a child does not follow its parent");
                }
                if depths[number].replace(depth + 1).is_some() {
                    return Err("a node has two parents");
                }
            } else {
                let (first, size) = node::items(child);
                let places = is_taken.get_mut(first..first + size).ok_or("a leaf is out of range")?;
                if places.iter_mut().any(|is_taken| std::mem::replace(is_taken, true)) {
                    return Err("two leaves have the same triangles");
                }
                check_leaf(&leaves[ROWS * first..ROWS * (first + size)], size, count)?;
            }
        }
    }
    if is_taken.contains(&false) { Err("some triangles are in no leaf") } else { Ok(()) }
}

/// Checks that the rows of a leaf hold triangles with numbers below `count`.
fn check_leaf(rows: &[f32], size: usize, count: usize) -> Result<(), &'static str> {
    let (corners, numbers) = rows.split_at((ROWS - 1) * size);
    if corners.iter().any(|x| x.is_infinite()) {
        return Err("a vertex is infinite");
    }
    match numbers.iter().all(|number| ((number.to_bits() ^ TAG) as usize) < count) {
        true => Ok(()),
        false => Err("a leaf has an invalid triangle number"),
    }
}

/// Computes a checksum that detects damage but not forgery. It is FNV-1a by Fowler, Noll, and Vo,
/// modified to use eight-byte words, a rotation in each step, and the length at the end.
fn checksum(bytes: &[u8]) -> u64 {
    let step = |sum: u64, word: u64| (sum ^ word).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(23);
    let (words, rest) = bytes.as_chunks::<8>();
    let sum = words.iter().fold(0xcbf2_9ce4_8422_2325, |sum, word| step(sum, u64::from_le_bytes(*word)));
    step(rest.iter().fold(sum, |sum, byte| step(sum, (*byte).into())), bytes.len() as u64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::BuildQuality;
    use crate::math::random::{Random, rounds};
    use crate::math::{Ray, Vec3};
    use crate::triangles::tests::{Mesh, bars, bits, ray, soup, torus};

    fn meshes(random: &mut Random) -> Vec<Mesh> {
        let mut holes = soup(random, 40, 0.3);
        holes.0[7] = Vec3::NAN;
        vec![torus(20, 10), bars(random, 60, 10), soup(random, 3, 0.5), holes, Default::default()]
    }

    #[test]
    fn stored_trees_load_again() {
        let mut random = Random(41);
        for mesh in meshes(&mut random) {
            for (_, quality) in BuildQuality::NAMES {
                let mut built = TriangleBvh::build(&mesh.0, &mesh.1, quality);
                let bytes = built.to_bytes();
                let mut loaded = TriangleBvh::from_bytes(&bytes).unwrap();
                assert_eq!(loaded.to_bytes(), bytes);
                let same = |built: &TriangleBvh, loaded: &TriangleBvh, random: &mut Random| {
                    for _ in 0..50 {
                        let ray = ray(&mesh, random, 1.0, Vec3::ZERO);
                        let hits = [built, loaded].map(|bvh| bvh.all_hits(&ray).iter().map(bits).collect::<Vec<_>>());
                        assert_eq!(hits[0], hits[1]);
                        assert_eq!(built.closest(&ray).as_ref().map(bits), loaded.closest(&ray).as_ref().map(bits));
                    }
                };
                same(&built, &loaded, &mut random);
                let moved: Vec<Vec3> = mesh.0.iter().map(|v| *v + 0.1 * random.point()).collect();
                built.refit(&moved, &mesh.1);
                loaded.refit(&moved, &mesh.1);
                same(&built, &loaded, &mut random);
            }
        }
    }

    /// Replaces the checksum with a valid one.
    fn summed(mut bytes: Vec<u8>) -> Vec<u8> {
        let end = bytes.len() - CHECKSUM;
        let sum = checksum(&bytes[..end]);
        bytes[end..].copy_from_slice(&sum.to_le_bytes());
        bytes
    }

    #[test]
    fn hostile_bytes_are_refused_or_make_a_tree_that_answers() {
        let mut random = Random(42);
        let (mut refused, mut made) = (0, 0);
        for mesh in meshes(&mut random) {
            let bytes = TriangleBvh::build(&mesh.0, &mesh.1, BuildQuality::Best).to_bytes();
            for _ in 0..rounds(1_500) {
                let mut bytes = bytes.clone();
                for _ in 0..1 + random.below(3) {
                    // Changes bits, replaces words, and copies words from elsewhere, mostly in the
                    // header and the nodes.
                    let end = [HEAD, HEAD + NODE, bytes.len() - CHECKSUM][random.below(3)].min(bytes.len() - CHECKSUM);
                    let at = random.below(end / 4) * 4;
                    let from = random.below((bytes.len() - CHECKSUM) / 4) * 4;
                    match random.below(4) {
                        0 => bytes[at + random.below(4)] ^= 1 << random.below(8),
                        1 => bytes[at..at + 4].copy_from_slice(&(random.bits() as u32).to_le_bytes()),
                        2 => bytes.copy_within(from..from + 4, at),
                        _ => bytes[at..at + 4]
                            .copy_from_slice(&[f32::NAN, -0.0, 1e38, 1e-42][random.below(4)].to_le_bytes()),
                    }
                }
                match TriangleBvh::from_bytes(&summed(bytes)) {
                    Err(_) => refused += 1,
                    Ok(mut bvh) => {
                        made += 1;
                        let rays: Vec<Ray> = (0..20).map(|_| ray(&mesh, &mut random, 1.0, Vec3::ZERO)).collect();
                        let (mut hits, mut occluded) = (vec![None; 20], vec![false; 20]);
                        bvh.closest_batch(&rays, &mut hits);
                        bvh.occluded_batch(&rays, &mut occluded);
                        for ray in &rays {
                            let hit = bvh.closest(ray);
                            assert!(hit.is_none_or(|hit| (hit.triangle as usize) < bvh.triangle_count()));
                            _ = (bvh.occluded(ray), bvh.all_hits(ray), hit.map(|hit| bvh.normal(&hit)));
                            _ = bvh.nearest_point(ray.origin, f64::INFINITY);
                        }
                        _ = bvh.try_refit(&mesh.0, &mesh.1);
                    }
                }
            }
        }
        assert!(refused > 1_000 && made > 500, "{refused} {made}");
    }

    #[test]
    fn stored_errors_name_the_fault() {
        let bvh = TriangleBvh::build(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]], BuildQuality::Fast);
        let bytes = bvh.to_bytes();
        let with = |at: usize, byte: u8| {
            let mut bytes = bytes.clone();
            bytes[at] = byte;
            bytes
        };
        let error = |bytes: &[u8]| TriangleBvh::from_bytes(bytes).unwrap_err();
        assert_eq!(error(b""), LoadError::NotATree);
        assert_eq!(error(&with(0, b'D')), LoadError::NotATree);
        assert_eq!(error(&with(8, 9)), LoadError::UnsupportedVersion(9));
        assert_eq!(error(&with(HEAD + 3, 0x55)), LoadError::Damaged);
        let expected = bytes.len() as u64;
        for len in HEAD..bytes.len() {
            assert_eq!(error(&bytes[..len]), LoadError::WrongLength { expected, actual: len });
        }
        assert!(matches!(error(&summed(with(12 + 7, 1))), LoadError::Invalid(_)));
        // Numbers of nodes and items whose total size is too large by a multiple of 2^32.
        let (nodes, items) = (1 + 10 * 4_400_582, (1 << 29) + 1 - 61 * 4_400_582);
        assert_eq!((NODE as u64 * (nodes - 1) + (4 * ROWS) as u64 * (items - 1)) % (1 << 32), 0);
        let mut wraps = bytes.clone();
        wraps[20..28].copy_from_slice(&nodes.to_le_bytes());
        wraps[28..36].copy_from_slice(&items.to_le_bytes());
        assert!(matches!(error(&summed(wraps)), LoadError::WrongLength { .. }));
        assert!((0..bytes.len()).all(|at| TriangleBvh::from_bytes(&with(at, !bytes[at])).is_err()));
    }
}
