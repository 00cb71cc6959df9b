//! Where cracks meet: every crack gets a vertex there, and an end there is no tip.

use super::path::{CrackPath, End, EndKind};
use crate::geometry::aabb::Aabb;
use crate::geometry::predicates::{closest_on_segment, segments_cross};
use crate::geometry::tree::BoxTree;
use crate::math::{Vector2, cross};

/// Meetings nearer to each other than this many tolerances are one.
const SAME_MEETING: f64 = 4.0;

/// A place at which cracks meet.
#[derive(Clone, Debug, PartialEq)]
pub struct Meeting {
    /// The place; a vertex of all of them.
    pub place: Vector2,
    /// The cracks by index, ascending.
    pub cracks: Vec<usize>,
}

/// Two cracks that run along each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Overlap {
    /// The cracks by index.
    pub cracks: [usize; 2],
}

/// Joins cracks that cross, touch or end at one another: T, Y and X junctions, and stars.
///
/// - `tolerance`: cracks this close to each other touch [length]
/// - returns all meetings
///
/// # Errors
/// [`Overlap`] if two cracks have more than single points in common.
pub fn join(cracks: &mut [CrackPath], tolerance: f64) -> Result<Vec<Meeting>, Overlap> {
    let meetings = find(cracks, tolerance)?;
    for meeting in &meetings {
        for &crack in &meeting.cracks {
            attach(&mut cracks[crack], meeting.place, SAME_MEETING * tolerance);
        }
    }
    Ok(meetings)
}

/// Vertices that several cracks have in common.
pub fn shared_vertices(cracks: &[CrackPath]) -> Vec<Meeting> {
    let mut all: Vec<(Vector2, usize)> =
        cracks.iter().enumerate().flat_map(|(k, c)| c.vertices.iter().map(move |v| (*v, k))).collect();
    all.sort_by(|(p, i), (q, j)| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)).then(i.cmp(j)));
    let groups = all.chunk_by(|a, b| a.0 == b.0);
    let meeting = |group: &[(Vector2, usize)]| {
        let mut cracks: Vec<usize> = group.iter().map(|g| g.1).collect();
        cracks.dedup();
        (cracks.len() > 1).then(|| Meeting { place: group[0].0, cracks })
    };
    groups.filter_map(meeting).collect()
}

fn find(cracks: &[CrackPath], tolerance: f64) -> Result<Vec<Meeting>, Overlap> {
    let segments: Vec<(usize, [Vector2; 2])> =
        cracks.iter().enumerate().flat_map(|(k, c)| c.segments().map(move |(a, b)| (k, [a, b]))).collect();
    let boxes: Vec<_> = segments.iter().map(|s| Aabb::of_points(s.1)).collect();
    let tree = BoxTree::new(&boxes);
    let mut meetings: Vec<Meeting> = vec![];
    let mut near = vec![];
    for (i, (crack, s)) in segments.iter().enumerate() {
        let margin = Vector2::repeat(tolerance);
        near.clear();
        tree.visit(&Aabb { lower: boxes[i].lower - margin, upper: boxes[i].upper + margin }, |j| near.push(j));
        near.sort_unstable();
        for (other, t) in near.iter().filter(|j| **j as usize > i).map(|j| &segments[*j as usize]) {
            if other == crack {
                continue;
            }
            let overlap = Overlap { cracks: [*crack, *other] };
            if let Some(place) = meeting_of(*s, *t, tolerance).map_err(|()| overlap)? {
                add(&mut meetings, place, [*crack, *other], SAME_MEETING * tolerance);
            }
        }
    }
    for meeting in &mut meetings {
        meeting.cracks.sort_unstable();
        meeting.cracks.dedup();
        // Mouths lie exactly on the boundary, so all others come there.
        let mouths = meeting.cracks.iter().flat_map(|c| cracks[*c].mouths());
        let near = |p: &Vector2| (p - meeting.place).norm() <= SAME_MEETING * tolerance;
        if let Some(mouth) = mouths.into_iter().find(near) {
            meeting.place = mouth;
        }
    }
    Ok(meetings)
}

fn add(meetings: &mut Vec<Meeting>, place: Vector2, cracks: [usize; 2], same: f64) {
    match meetings.iter_mut().find(|m| (m.place - place).norm() <= same) {
        Some(meeting) => meeting.cracks.extend(cracks),
        None => meetings.push(Meeting { place, cracks: cracks.to_vec() }),
    }
}

/// Where two segments meet, if they do; an error if they have a stretch in common.
fn meeting_of(s: [Vector2; 2], t: [Vector2; 2], tolerance: f64) -> Result<Option<Vector2>, ()> {
    let feet = [(s[0], t), (s[1], t), (t[0], s), (t[1], s)].map(|(p, on)| (p, on, closest_on_segment(p, on[0], on[1])));
    let contacts: Vec<_> = feet.into_iter().filter(|(p, _, foot)| (p - foot).norm() <= tolerance).collect();
    let Some((p, on, foot)) = contacts.first() else {
        let (d, e) = (s[1] - s[0], t[1] - t[0]);
        let crossing = || s[0] + d * (cross(t[0] - s[0], e) / cross(d, e));
        return Ok(segments_cross(s[0], s[1], t[0], t[1]).then(crossing));
    };
    if contacts.iter().any(|c| (c.0 - p).norm() > 10.0 * tolerance) {
        return Err(());
    }
    // A vertex stays, unless it comes to a straight stretch, which stays straight.
    let at_vertex = on.iter().any(|q| (q - p).norm() <= 2.0 * tolerance);
    Ok(Some(if at_vertex { *p } else { *foot }))
}

/// Makes a place a vertex of a crack: a vertex within `reach` moves there.
fn attach(crack: &mut CrackPath, place: Vector2, reach: f64) {
    let away = |p: &Vector2| (p - place).norm();
    let nearest =
        (0..crack.vertices.len()).min_by(|a, b| away(&crack.vertices[*a]).total_cmp(&away(&crack.vertices[*b])));
    match nearest.filter(|k| away(&crack.vertices[*k]) <= reach) {
        Some(k) => {
            crack.vertices[k] = place;
            let last = crack.vertices.len() - 1;
            let ends = [End::Start, End::End].into_iter().filter(|e| k == [0, last][e.index()]);
            for end in ends.filter(|e| crack.end_kind(*e) == EndKind::Tip).collect::<Vec<_>>() {
                crack.ends[end.index()] = EndKind::Junction;
            }
        }
        None => crack.join_at(place),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use EndKind::{Junction, Mouth, Tip};

    fn crack(vertices: &[[f64; 2]], ends: [EndKind; 2]) -> CrackPath {
        CrackPath { name: "c".into(), vertices: vertices.iter().map(|v| Vector2::from(*v)).collect(), ends }
    }

    fn check(mut cracks: Vec<CrackPath>, ends: &[[EndKind; 2]], n_vertices: &[usize], cracks_met: &[usize]) {
        let meetings = join(&mut cracks, 1e-6).expect("single points");
        assert_eq!(cracks.iter().map(|c| c.ends).collect::<Vec<_>>(), ends, "{cracks:?}");
        assert_eq!(cracks.iter().map(|c| c.vertices.len()).collect::<Vec<_>>(), n_vertices, "{cracks:?}");
        assert_eq!(meetings.len(), 1, "{meetings:?}");
        assert_eq!(meetings[0].cracks, cracks_met);
        assert_eq!(shared_vertices(&cracks), meetings);
    }

    #[test]
    fn crossing_cracks_keep_their_tips() {
        let two = vec![crack(&[[-1.0, 0.0], [1.0, 0.0]], [Tip; 2]), crack(&[[0.1, -1.0], [0.3, 1.0]], [Tip; 2])];
        check(two, &[[Tip; 2], [Tip; 2]], &[3, 3], &[0, 1]);
    }

    #[test]
    fn an_end_on_a_crack_is_no_tip() {
        let two =
            vec![crack(&[[-1.0, 0.0], [1.0, 0.1]], [Mouth, Tip]), crack(&[[0.0, 0.05 + 5e-7], [0.3, 1.0]], [Tip; 2])];
        check(two, &[[Mouth, Tip], [Junction, Tip]], &[3, 2], &[0, 1]);
    }

    #[test]
    fn arms_of_a_star_meet_in_one_place() {
        let arm = |k: usize| {
            let d = crate::math::direction(k as f64 * 1.3);
            crack(&[[1e-7 * k as f64, 0.0], [d.x, d.y]], [Tip; 2])
        };
        check((0..4).map(arm).collect(), &[[Junction, Tip]; 4], &[2; 4], &[0, 1, 2, 3]);
    }

    #[test]
    fn cracks_from_one_mouth_share_it() {
        let two = vec![crack(&[[0.0, 1e-7], [1.0, 0.0]], [Tip; 2]), crack(&[[0.0, 0.0], [1.0, 1.0]], [Mouth, Tip])];
        check(two, &[[Junction, Tip], [Mouth, Tip]], &[2, 2], &[0, 1]);
    }

    #[test]
    fn cracks_that_run_along_each_other_are_refused() {
        let first = crack(&[[-1.0, 0.0], [1.0, 0.0]], [Tip; 2]);
        for second in [[[0.0, 0.0], [2.0, 0.0]], [[0.9, 0.0], [-0.9, 1e-7]], [[-1.0, 0.0], [1.0, 0.0]]] {
            let found = join(&mut [first.clone(), crack(&second, [Tip; 2])], 1e-6);
            assert_eq!(found, Err(Overlap { cracks: [0, 1] }), "{second:?}");
        }
        // End to end in line they only touch.
        assert!(join(&mut [first, crack(&[[1.0, 0.0], [2.0, 0.0]], [Tip; 2])], 1e-6).is_ok());
    }
}
