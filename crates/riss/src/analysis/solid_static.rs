//! Static analysis of a cracked solid by point collocation [C3D].

use super::record::{Observer, Stage};
use super::solid_boundary::boundary_fields;
use super::solid_error_bars::{crack_length, widen_front_bars};
use super::solid_front_discs::free_disc;
use super::solid_guard_rails::inspect;
use super::solid_record::{FrontPointRecord, FrontRecord, SolidResult};
use super::warnings::Warnings;
use crate::approximation::{CrackSides, EnrichedFront, FitBuffer, FrontEnds, FrontFrame, FrontLine, ShapeFunctions};
use crate::crack::{CrackFront, CrackSurface, FrontPoint};
use crate::error::Result;
use crate::fracture::{DiscCut, FrontFactors, front_integrals};
use crate::geometry::obstacles::{Opaque, OpaqueTriangles};
use crate::material::Elasticity;
use crate::math::{Matrix, Vector3};
use crate::model::SolidModel;
use crate::nodes::cloud::Cloud;
use crate::nodes::solid::{FacePair, NodesOnFronts, SolidCloud, SolidSpacing, generate_solid, solid_obstacles};
use crate::system::{Collocation, CollocationSettings, CollocationSolution};
use rayon::prelude::*;
use std::sync::Arc;

/// Radii of the discs around a front point, over the largest.
const DISCS: [f64; 3] = [0.5, 0.75, 1.0];
/// Reach of the functions of a front over its least radius of curvature, and the least over the spacing there.
const BEND: f64 = 0.6;
const LEAST_REACH: f64 = 8.0;

/// Length to each side over which the bend of a front out of its crack is taken, over the spacing.
const ALONG: f64 = 2.0;

/// Numerical choices for a solid.
#[derive(Clone, Debug)]
pub struct SolidSettings {
    /// Distance of nodes.
    pub spacing: SolidSpacing,
    /// Whether nodes stand on fronts.
    pub nodes_on_fronts: NodesOnFronts,
    /// Shape functions, corners and solver.
    pub collocation: CollocationSettings,
    /// Number of points at which each front is evaluated.
    pub points_on_front: usize,
}

/// Places the nodes of a solid.
///
/// # Errors
/// [`crate::Error::NodeGeneration`] if there would be too many.
pub fn solid_nodes(model: &SolidModel, settings: &SolidSettings) -> Result<SolidCloud> {
    generate_solid(&model.body, &model.cracks, &settings.spacing, settings.nodes_on_fronts)
}

/// The equations of a solid on its nodes, ready to be assembled; `obstacles` hide nodes from one another.
pub fn solid_collocation(
    model: &SolidModel,
    nodes: &SolidCloud,
    obstacles: Arc<OpaqueTriangles>,
    settings: &SolidSettings,
) -> Collocation<3> {
    let cracks = model.cracks.iter().enumerate().filter(|(c, _)| model.cohesive_crack(*c).is_none());
    let fronts = cracks.flat_map(|(_, c)| enriched(c, settings)).collect();
    let obstacles = obstacles as Arc<dyn Opaque<3> + Send>;
    Collocation::new(model.solid.clone(), &nodes.cloud, obstacles, fronts, settings.collocation)
}

/// Solves a cracked solid.
///
/// # Errors
/// Those of node generation, shape functions and solver.
pub fn solid_static(model: &SolidModel, settings: &SolidSettings, observer: &mut dyn Observer) -> Result<SolidResult> {
    Solved::of(model, settings, observer)?.result(model, settings, observer)
}

/// A solid with its nodes, ready to be assembled.
pub(super) struct Placed {
    obstacles: Arc<OpaqueTriangles>,
    /// The equations.
    pub collocation: Collocation<3>,
    /// Pairs of nodes, by their numbers in the equations.
    pub pairs: Vec<FacePair>,
}

impl Placed {
    /// Places the nodes of a solid.
    pub fn of(model: &SolidModel, settings: &SolidSettings, observer: &mut dyn Observer) -> Result<Self> {
        observer.stage(Stage::Nodes);
        let nodes = solid_nodes(model, settings)?;
        let obstacles = Arc::new(solid_obstacles(&model.body, &model.cracks));
        observer.stage(Stage::Discretization);
        let collocation = solid_collocation(model, &nodes, obstacles.clone(), settings);
        let pairs = renumbered(&nodes.pairs, &collocation.origins, nodes.cloud.len());
        Ok(Self { obstacles, collocation, pairs })
    }
}

/// A solution with what it takes to evaluate it anywhere.
pub(super) struct Solved {
    placed: Placed,
    solution: CollocationSolution<3>,
}

impl Solved {
    /// Solves a cracked solid.
    pub fn of(model: &SolidModel, settings: &SolidSettings, observer: &mut dyn Observer) -> Result<Self> {
        let placed = Placed::of(model, settings, observer)?;
        observer.stage(Stage::Assembly);
        let system = placed.collocation.assemble()?;
        observer.stage(Stage::Solve);
        let solution = placed.collocation.solve(&system)?;
        Ok(Self { placed, solution })
    }

    /// A solution that is known.
    pub fn new(placed: Placed, solution: CollocationSolution<3>) -> Self {
        Self { placed, solution }
    }

    /// Whether nothing hides two points from each other.
    pub fn visible(&self, p: Vector3, q: Vector3) -> bool {
        self.placed.obstacles.visible(p, q)
    }

    /// Stresses at points in the body that are on no surface [stress].
    pub fn stresses_at(&self, points: &[Vector3]) -> Result<Vec<Matrix<3>>> {
        let one =
            |(fit, shape): &mut (FitBuffer<3>, ShapeFunctions<3>), p: &Vector3| Ok(self.at(*p, *p, fit, shape)?.1);
        points.par_iter().map_init(Default::default, one).collect()
    }

    /// Displacement [length] and stress [stress] at a point that is seen from `sight`.
    pub fn at(
        &self,
        point: Vector3,
        sight: Vector3,
        fit: &mut FitBuffer<3>,
        shape: &mut ShapeFunctions<3>,
    ) -> Result<(Vector3, Matrix<3>)> {
        let Collocation { approximation, solid, .. } = &self.placed.collocation;
        approximation.at_point(point, sight, fit, shape)?;
        let (mut value, mut gradient) = (Vector3::zeros(), Matrix::<3>::zeros());
        for (k, i) in shape.neighbors.iter().enumerate() {
            let u = self.solution.displacements[*i as usize];
            value += u * shape.values[k];
            gradient += u * shape.gradients[k].transpose();
        }
        Ok((value, stress(&solid.material, &gradient)))
    }

    /// Evaluates the fronts.
    fn fronts(&self, model: &SolidModel, settings: &SolidSettings) -> Result<Vec<FrontRecord>> {
        let mut records = vec![];
        let cracks = model.cracks.iter().enumerate().filter(|(c, _)| model.cohesive_crack(*c).is_none());
        for (crack, surface) in cracks {
            let sides: Option<&dyn CrackSides<3>> =
                if surface.surface.is_plane() { None } else { Some(&surface.surface) };
            for front in &surface.fronts {
                let evaluate = |p: &FrontPoint| {
                    let h = settings.spacing.at(p.position);
                    let frame = frame(p);
                    let cut = DiscCut { frame: &frame, sides };
                    let largest = free_disc(model, &self.placed.obstacles, crack, &cut, h);
                    let factors = match largest {
                        None => None,
                        Some(r) => {
                            let radii = DISCS.map(|share| share * r);
                            let displacements = &self.solution.displacements;
                            let discs = front_integrals(&self.placed.collocation, displacements, &cut, crack, &radii)?;
                            let mut factors = FrontFactors::of(&discs);
                            let open = if front.is_closed { 0.0 } else { h / crack_length(surface, false) };
                            let bends = [p.curvature.abs(), front.largest_curvature()].map(|c| h * c);
                            widen_front_bars(&mut factors, &model.solid.material, bends, open, r);
                            Some(factors)
                        }
                    };
                    Ok(FrontPointRecord { point: *p, factors, radius: largest })
                };
                let points = stations(front, settings.points_on_front);
                let points = points.iter().map(evaluate).collect::<Result<Vec<_>>>()?;
                records.push(FrontRecord { crack, is_closed: front.is_closed, length: front.length, points });
            }
        }
        Ok(records)
    }

    /// Evaluates fronts and nodes.
    pub fn result(
        self,
        model: &SolidModel,
        settings: &SolidSettings,
        observer: &mut dyn Observer,
    ) -> Result<SolidResult> {
        Ok(self.result_and_place(model, settings, observer)?.0)
    }

    /// The same, and the nodes back.
    pub fn result_and_place(
        self,
        model: &SolidModel,
        settings: &SolidSettings,
        observer: &mut dyn Observer,
    ) -> Result<(SolidResult, Placed)> {
        observer.stage(Stage::Fracture);
        let fronts = self.fronts(model, settings)?;
        observer.stage(Stage::Fields);
        let boundary = boundary_fields(&self, model, &settings.spacing);
        let Self { placed, solution } = self;
        let gradients = placed.collocation.gradients(&solution.displacements)?;
        let cloud: Cloud<3> = placed.collocation.cloud().clone();
        let mut result = SolidResult {
            n_nodes: cloud.len(),
            stresses: gradients.iter().map(|g| stress(&model.solid.material, g)).collect(),
            displacements: solution.displacements,
            cloud,
            pairs: placed.pairs.clone(),
            opened_cracks: vec![],
            boundary,
            fronts,
            effort: solution.effort,
            warnings: vec![],
        };
        result.opened_cracks = (0..model.cracks.len()).map(|c| result.opened_crack(&model.cracks[c], c)).collect();
        let mut warnings = Warnings::new(observer);
        inspect(model, settings, &result, &mut warnings);
        result.warnings = warnings.list;
        Ok((result, placed))
    }
}

fn stress(material: &Elasticity, gradient: &Matrix<3>) -> Matrix<3> {
    (gradient + gradient.transpose()) * material.shear()
        + Matrix::from_diagonal_element(material.lame() * gradient.trace())
}

/// The fronts of a crack with their axes, for their functions near them.
fn enriched(crack: &CrackSurface, settings: &SolidSettings) -> Vec<EnrichedFront<3>> {
    let sides: Option<Arc<dyn CrackSides<3>>> =
        if crack.surface.is_plane() { None } else { Some(Arc::new(crack.surface.clone())) };
    let one = |front: &CrackFront| {
        let ends = if front.is_closed { FrontEnds::Closed } else { FrontEnds::Open };
        let least = front.points.iter().map(|p| settings.spacing.at(p.position)).fold(f64::INFINITY, f64::min);
        let bent = |p: &FrontPoint| {
            let normal_curvature = if sides.is_some() { front.normal_curvature(p, ALONG * least) } else { 0.0 };
            FrontFrame { normal_curvature, ..frame(p) }
        };
        let line = FrontLine::new(front.points.iter().map(bent).collect(), ends);
        let wanted = settings.collocation.front_reach * least;
        // The functions of an arc know nothing of its other side: a penny-shaped crack loses 0.5 % if they reach its middle.
        let bend = front.points.iter().map(|p| p.curvature.abs()).fold(f64::MIN_POSITIVE, f64::max);
        let reach = wanted.min((BEND / bend).max(LEAST_REACH * least));
        EnrichedFront { line, reach, crack: sides.clone() }
    };
    crack.fronts.iter().map(one).collect()
}

fn frame(p: &FrontPoint) -> FrontFrame<3> {
    let FrontPoint { position, ahead, normal, curvature, .. } = *p;
    FrontFrame { position, ahead, normal, curvature, normal_curvature: 0.0 }
}

/// Where a front is evaluated: evenly along it, half a step from its ends.
fn stations(front: &CrackFront, n: usize) -> Vec<FrontPoint> {
    let offset = if front.is_closed { 0.0 } else { 0.5 };
    (0..n).map(|k| front.at(front.length * (k as f64 + offset) / n as f64)).collect()
}

/// Pairs in the order of the unknowns.
fn renumbered(pairs: &[FacePair], origins: &[u32], n: usize) -> Vec<FacePair> {
    let mut place = vec![u32::MAX; n];
    origins.iter().enumerate().for_each(|(k, i)| place[*i as usize] = k as u32);
    pairs.iter().map(|p| FacePair { crack: p.crack, nodes: p.nodes.map(|i| place[i as usize]) }).collect()
}

#[cfg(test)]
mod tests {
    use super::super::record::Silent;
    use super::*;
    use crate::case::AnyCase;
    use crate::math::Vector3;
    use std::f64::consts::PI;

    fn solve(text: &str) -> (SolidModel, SolidResult) {
        let case = AnyCase::parse(text, "case.toml".as_ref(), &[]).map_err(|e| e.to_string()).unwrap();
        let AnyCase::Solid(case) = case else { panic!() };
        let result = solid_static(&case.model, &case.settings, &mut Silent).unwrap();
        (case.model, result)
    }

    /// A uniform stress is met at every node, whatever stands around it: nothing but linear displacement.
    fn check_uniform(body: &str, stress: Matrix<3>) {
        let s = |i: usize, j: usize| stress[(i, j)];
        let text = format!(
            "method = 'collocation'\nrigid_motion = 'mean-is-zero'\nmaterial = {{ young = 1000, poisson = 0.3 }}\n\
             remote_stress = {{ xx = {}, yy = {}, zz = {}, xy = {}, yz = {}, xz = {} }}\n{body}",
            s(0, 0),
            s(1, 1),
            s(2, 2),
            s(0, 1),
            s(1, 2),
            s(0, 2)
        );
        let (_, result) = solve(&text);
        for (found, place) in result.stresses.iter().zip(&result.cloud.positions) {
            assert!((found - stress).norm() < 1e-5 * stress.norm(), "{found} at {place}");
        }
        for opened in &result.opened_cracks {
            assert!(opened.openings.iter().all(|o| o.norm() < 1e-8) && !opened.triangles.is_empty());
        }
    }

    #[test]
    fn a_box_under_uniform_stress() {
        let stress = Matrix::<3>::new(1.0, 0.3, -0.2, 0.3, 2.0, 0.5, -0.2, 0.5, -1.0);
        check_uniform("geometry.box = { lower = [0, 0, 0], upper = [2, 1, 1] }\nnodes.spacing = 0.25", stress);
    }

    #[test]
    fn a_shaft_under_tension() {
        let shaft = "geometry.cylinder = { from = [0, 0, -1], to = [0, 0, 1], radius = 0.8 }\nnodes.spacing = 0.3";
        check_uniform(shaft, Matrix::<3>::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0));
    }

    /// Between planes of symmetry a slab is in plane strain, and nothing else holds it.
    #[test]
    fn a_slab_between_planes_of_symmetry() {
        let (_, result) = solve(
            "method = 'collocation'\nrigid_motion = 'mean-is-zero'\nmaterial = { young = 1000, poisson = 0.3 }\n\
             geometry.box = { lower = [0, 0, 0], upper = [1, 0.5, 2] }\nnodes.spacing = 0.25\n\
             support = [{ on = ['y-min', 'y-max'], normal = 0 }]\n\
             load = [{ on = 'z-max', traction = [0, 0, 1] }, { on = 'z-min', traction = [0, 0, -1] }]",
        );
        let expected = Matrix::from_diagonal(&Vector3::new(0.0, 0.3, 1.0));
        assert!(result.stresses.iter().all(|s| (s - expected).norm() < 1e-5));
        assert!(result.displacements.iter().sum::<Vector3>().norm() < 1e-6);
    }

    /// Cracks along the tension are not felt.
    #[test]
    fn cracks_along_the_tension() {
        let body = "geometry.box = { lower = [0, 0, 0], upper = [2, 1, 1] }\nnodes.spacing = 0.25\n";
        let tension = Matrix::<3>::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0);
        let through = "crack = [{ polygon = [[0, 0.5, 0], [1.05, 0.5, 0], [1.05, 0.5, 1], [0, 0.5, 1]] }]\nnodes.front_spacing = 0.2";
        check_uniform(&format!("{body}{through}"), tension);
        let inside = "crack = [{ disc = { center = [1, 0.5, 0.5], normal = [1, 0, 0], radius = 0.3 } }]\nnodes.front_spacing = 0.1";
        check_uniform(&format!("{body}{inside}"), tension);
        let half = "crack = [{ disc = { center = [1, 0, 0.5], normal = [1, 0, 0], radius = 0.4 } }]\nnodes.front_spacing = 0.12";
        check_uniform(&format!("{body}{half}"), tension);
    }

    /// K_I = 2 σ √(a/π) [Sneddon1946], all around; the box adds less than half a percent.
    #[test]
    fn a_penny_shaped_crack_opens() {
        let (model, result) = solve(
            "method = 'collocation'\nrigid_motion = 'mean-is-zero'\nmaterial = { young = 1000, poisson = 0.3 }\n\
             geometry.box = { lower = [-5, -5, -5], upper = [5, 5, 5] }\nremote_stress.zz = 1\n\
             nodes = { spacing = 1.2, front_spacing = 0.09, growth = 0.14 }\nfracture.points = 6\n\
             crack = [{ name = 'penny', disc = { center = [0, 0, 0], normal = [0, 0, 1], radius = 1 } }]",
        );
        assert_eq!((model.crack_names[0].as_str(), result.fronts.len()), ("penny", 1));
        let exact = 2.0 / PI.sqrt();
        for p in &result.fronts[0].points {
            let factors = p.factors.expect("a disc fits").factors;
            assert!((factors[0] / exact - 1.0).abs() < 0.02, "{factors:?}");
            assert!(factors[1].abs() < 0.02 * exact && factors[2].abs() < 0.02 * exact, "{factors:?}");
            // T = -(1/2 + ν) σ, see `theory/collocation` in the book.
            let t = p.factors.expect("a disc fits").t_stress;
            assert!((t + 0.8).abs() < 0.03, "{t}");
        }
        // Opening of the crack: 8 (1 - ν²) σ/(π E) √(a² - r²) [Sneddon1946].
        let opened = &result.opened_cracks[0];
        let largest = 8.0 * 0.91 / (PI * 1000.0);
        for (p, gap) in opened.positions.iter().zip(&opened.gaps) {
            let expected = largest * (1.0 - p.norm_squared()).max(0.0).sqrt();
            assert!((gap - expected).abs() < 0.03 * largest, "{gap} {expected} at {p}");
        }
    }

    /// Stress in the plane of a crack adds its part along x1 to T and leaves all else.
    #[test]
    fn stress_along_a_crack_shifts_t() {
        let penny = |along: f64| {
            let (_, result) = solve(&format!(
                "method = 'collocation'\nrigid_motion = 'mean-is-zero'\nmaterial = {{ young = 1000, poisson = 0.3 }}\n\
                 geometry.box = {{ lower = [-2, -2, -2], upper = [2, 2, 2] }}\n\
                 remote_stress = {{ zz = 1, xx = {along}, xy = {along} }}\n\
                 nodes = {{ spacing = 0.8, front_spacing = 0.15, growth = 0.3 }}\nfracture.points = 5\n\
                 crack = [{{ disc = {{ center = [0, 0, 0], normal = [0, 0, 1], radius = 1 }} }}]"
            ));
            result.fronts[0].points.clone()
        };
        let (without, with) = (penny(0.0), penny(3.0));
        for (a, b) in without.iter().zip(&with) {
            let ahead = a.point.ahead;
            let (a, b) = (a.factors.unwrap(), b.factors.unwrap());
            let expected = 3.0 * (ahead.x * ahead.x + 2.0 * ahead.x * ahead.y);
            assert!((b.t_stress - a.t_stress - expected).abs() < 1e-4, "{} {} {expected}", a.t_stress, b.t_stress);
            assert!((0..3).all(|m| (b.factors[m] - a.factors[m]).abs() < 1e-5), "{a:?} {b:?}");
        }
    }
}
