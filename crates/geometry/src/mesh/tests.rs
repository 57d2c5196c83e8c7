use etendue_math::{Normal3, Point2, Point3};

use crate::{BilinearMesh, MeshError, TriangleMesh};

fn valid() -> TriangleMesh {
    TriangleMesh {
        positions: vec![Point3::ORIGIN, Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0)],
        indices: vec![[0, 1, 2]],
        ..TriangleMesh::default()
    }
}

/// Files may hold anything; each kind of nonsense is named.
#[test]
fn validation_names_what_is_wrong() {
    assert_eq!(valid().validate(), Ok(()));
    let index = TriangleMesh { indices: vec![[0, 1, 2], [0, 3, 1]], ..valid() };
    assert_eq!(index.validate(), Err(MeshError::IndexOutOfRange { face: 1, index: 3, n_vertices: 3 }));
    let mut nan = valid();
    nan.positions[1].y = f32::NAN;
    assert_eq!(nan.validate(), Err(MeshError::NotFinite { array: "positions", vertex: 1 }));
    let infinite = TriangleMesh { uvs: vec![Point2::new(0.0, f32::INFINITY); 3], ..valid() };
    assert_eq!(infinite.validate(), Err(MeshError::NotFinite { array: "uvs", vertex: 0 }));
    let short = TriangleMesh { normals: vec![Normal3::new(0.0, 0.0, 1.0); 2], ..valid() };
    let expected = MeshError::WrongLength { array: "normals", found: 2, expected: 3 };
    assert_eq!(short.validate(), Err(expected.clone()));
    assert_eq!(expected.to_string(), "normals: 2 entries instead of 3");
    let faces = TriangleMesh { face_indices: vec![1, 2], ..valid() };
    assert!(matches!(faces.validate(), Err(MeshError::WrongLength { array: "face_indices", .. })));
    let patch =
        BilinearMesh { positions: valid().positions, indices: vec![[0, 1, 2, 3]], ..BilinearMesh::default() };
    assert!(matches!(patch.validate(), Err(MeshError::IndexOutOfRange { index: 3, .. })));
}
