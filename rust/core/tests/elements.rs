//! Identities of the elements: symmetry, rigid motion, zero modes, patch test, mass.

mod common;

use bipenalty::element::{quad4, tri3};
use bipenalty::lane::Lane;
use bipenalty::material::{Material, Plane};
use bipenalty::model::Model;
use bipenalty::scene::Scene;
use common::{body, rectangle, steel};
use nalgebra::DMatrix;

const TRIANGLE: [[f64; 2]; 3] = [[0.1, 0.0], [1.3, 0.2], [0.4, 0.9]];
const QUAD: [[f64; 2]; 4] = [[0.0, 0.1], [1.2, 0.0], [1.0, 0.9], [0.1, 1.1]];

fn stiffnesses(material: &Material) -> Vec<DMatrix<f64>> {
    let c = material.elasticity();
    let (tri, _) = tri3::stiffness_and_mass(&TRIANGLE, &c, 0.7, 2.0);
    let (quad, _) = quad4::stiffness_and_mass(&QUAD, &c, 0.7, 2.0);
    vec![DMatrix::from_iterator(6, 6, tri.iter().copied()), DMatrix::from_iterator(8, 8, quad.iter().copied())]
}

#[test]
fn stiffness_is_symmetric_with_three_zero_modes() {
    for plane in [Plane::Strain, Plane::Stress] {
        for k in stiffnesses(&Material { plane, ..steel() }) {
            let size = k.amax();
            assert!((&k - k.transpose()).amax() < 1e-13 * size);
            let eigenvalues = k.symmetric_eigenvalues();
            let zero = eigenvalues.iter().filter(|e| e.abs() < 1e-12 * size).count();
            assert_eq!(zero, 3, "{eigenvalues}");
            assert!(eigenvalues.iter().all(|e| *e > -1e-12 * size));
        }
    }
}

#[test]
fn mass_is_density_times_area_times_thickness() {
    let c = steel().elasticity();
    let (_, tri) = tri3::stiffness_and_mass(&TRIANGLE, &c, 0.7, 2.0);
    let (_, quad) = quad4::stiffness_and_mass(&QUAD, &c, 0.7, 2.0);
    for (mass, points) in [(tri.as_slice(), TRIANGLE.as_slice()), (&quad, &QUAD)] {
        let area = bipenalty::element::signed_area(points);
        assert!((mass.iter().sum::<f64>() - 1.4 * area).abs() < 1e-14);
        assert!(mass.iter().all(|m| *m > 0.0));
    }
}

#[test]
fn uniaxial_stress_follows_from_both_plane_assumptions() {
    let material = Material { young: 200.0, poisson: 0.3, density: 1.0, plane: Plane::Stress };
    let compliance = material.elasticity().try_inverse().unwrap();
    assert!((compliance[(0, 0)] - 1.0 / 200.0).abs() < 1e-15);
    assert!((compliance[(0, 1)] + 0.3 / 200.0).abs() < 1e-15);
    let compliance = Material { plane: Plane::Strain, ..material }.elasticity().try_inverse().unwrap();
    assert!((compliance[(0, 0)] - (1.0 - 0.09) / 200.0).abs() < 1e-15);
}

/// Nodal forces of a displacement field on a distorted rectangle.
fn forces(quads: bool, field: impl Fn([f64; 2]) -> [f64; 2]) -> (Model, Vec<[f64; 2]>) {
    let mesh = rectangle([0.0; 2], [2.0, 1.0], [6, 4], 0.25, quads);
    let model = Model::new(Scene { bodies: vec![body("patch", mesh, steel())], ..Scene::default() }).unwrap();
    let u: Vec<f64> = model.points.iter().flat_map(|&p| field(p)).collect();
    let force =
        (0..model.points.len() as u32).map(|n| model.nodal_force(&model.bodies[0], n, Lane::new(&u, 1, 0))).collect();
    (model, force)
}

#[test]
fn rigid_translation_gives_no_force() {
    for quads in [true, false] {
        let (model, force) = forces(quads, |_| [0.3, -0.7]);
        let round_off = 1e-14 * model.stiffness.to_dense().amax();
        assert!(force.as_flattened().iter().all(|f| f.abs() < round_off), "{force:?}");
    }
}

#[test]
fn patch_test_linear_field_gives_no_force_inside() {
    for quads in [true, false] {
        let (model, force) = forces(quads, |[x, y]| [0.01 * x + 0.02 * y, -0.03 * x + 0.015 * y]);
        let inside = |p: [f64; 2]| p[0] > 1e-9 && p[0] < 2.0 - 1e-9 && p[1] > 1e-9 && p[1] < 1.0 - 1e-9;
        let largest = force.as_flattened().iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        let inner = model.points.iter().zip(&force).filter(|(p, _)| inside(**p)).flat_map(|(_, f)| *f);
        assert!(inner.clone().count() > 0 && largest > 0.1);
        assert!(inner.fold(0.0_f64, |m, f| m.max(f.abs())) < 1e-13 * largest.max(1.0));
    }
}
