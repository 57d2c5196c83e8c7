//! A model in Embree.

use std::ffi::{CString, c_void};
use std::ptr;
use std::sync::atomic::{AtomicIsize, Ordering};

use etendue_geometry::TriangleMesh;
use etendue_lab::speed::{Model, RayKind, RaySet};
use etendue_math::{Ray, Transform};

use crate::ffi;

/// Bytes that the library holds, by its own account.
static BYTES: AtomicIsize = AtomicIsize::new(0);

extern "C" fn count_bytes(_: *mut c_void, bytes: isize, _: bool) -> bool {
    BYTES.fetch_add(bytes, Ordering::Relaxed);
    true
}

/// The library.
pub(crate) struct Device {
    device: *mut ffi::RtcDevice,
}

impl Device {
    /// Starts the library with so many threads for building, and more settings separated by commas.
    pub(crate) fn new(n_threads: usize, settings: &str) -> Self {
        let config = CString::new(format!("threads={n_threads},{settings}")).expect("there is no zero byte");
        // SAFETY: the string lives during the call, and the monitor is a plain function without user data.
        let device = unsafe {
            let device = ffi::rtcNewDevice(config.as_ptr());
            assert!(!device.is_null(), "Embree starts");
            ffi::rtcSetDeviceMemoryMonitorFunction(device, Some(count_bytes), ptr::null_mut());
            device
        };
        Self { device }
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: this is the one reference, and scenes borrow the device.
        unsafe { ffi::rtcReleaseDevice(self.device) }
    }
}

/// A model as the library reads it.
pub(crate) struct Buffers {
    meshes: Vec<Mesh>,
    copies: Vec<Transform>,
}

struct Mesh {
    /// With one more at the end, since 16 bytes from each vertex on must be there.
    positions: Vec<[f32; 3]>,
    indices: Vec<[u32; 3]>,
}

impl Buffers {
    /// Copies a model.
    pub(crate) fn new(model: &Model) -> Self {
        let mesh = |mesh: &TriangleMesh| {
            let mut positions: Vec<[f32; 3]> = mesh.positions.iter().map(|p| [p.x, p.y, p.z]).collect();
            positions.push([0.0; 3]);
            Mesh { positions, indices: mesh.indices.clone() }
        };
        Self { meshes: model.meshes.iter().map(mesh).collect(), copies: model.copies.clone() }
    }
}

/// A built scene.
pub(crate) struct Scene<'a> {
    scene: *mut ffi::RtcScene,
    /// The scene that instances refer to.
    object: *mut ffi::RtcScene,
    /// What the hierarchies hold, in bytes.
    pub(crate) n_bytes: usize,
    _buffers: &'a Buffers,
    _device: &'a Device,
}

impl<'a> Scene<'a> {
    /// Builds at high quality, with or without the flag `ROBUST`.
    pub(crate) fn build(device: &'a Device, buffers: &'a Buffers, is_robust: bool) -> Self {
        let before = BYTES.load(Ordering::Relaxed);
        let triangles = new_scene(device, is_robust);
        for mesh in &buffers.meshes {
            attach_triangles(device, triangles, mesh);
        }
        // SAFETY: the scene is alive.
        unsafe { ffi::rtcCommitScene(triangles) };
        let (scene, object) = if buffers.copies.is_empty() {
            (triangles, ptr::null_mut())
        } else {
            let world = new_scene(device, is_robust);
            for place in &buffers.copies {
                attach_copy(device, world, triangles, place);
            }
            // SAFETY: the scene is alive.
            unsafe { ffi::rtcCommitScene(world) };
            (world, triangles)
        };
        // SAFETY: the device is alive.
        assert_eq!(unsafe { ffi::rtcGetDeviceError(device.device) }, 0, "Embree builds");
        let n_bytes = BYTES.load(Ordering::Relaxed) - before;
        Self { scene, object, n_bytes: n_bytes.unsigned_abs(), _buffers: buffers, _device: device }
    }

    /// Traces the rays; writes t of the nearest hit, or 0 where a shadow ray is stopped, else infinity.
    pub(crate) fn trace(&self, set: &RaySet, t: &mut [f32]) {
        let mut context = ffi::RtcIntersectContext {
            flags: 0,
            filter: ptr::null(),
            instance: ffi::INVALID_ID,
            min_width: 0.0,
        };
        if set.kind == RayKind::Shadow {
            for (ray, t) in set.rays.iter().zip(t) {
                let mut ray = rtc_ray(ray, set.t_max);
                // SAFETY: scene, context and ray are alive and aligned.
                unsafe { ffi::rtcOccluded1(self.scene, &raw mut context, &raw mut ray) };
                *t = if ray.t_far < 0.0 { 0.0 } else { f32::INFINITY };
            }
            return;
        }
        let hit = ffi::RtcHit {
            normal: [0.0; 3],
            uv: [0.0; 2],
            primitive: ffi::INVALID_ID,
            geometry: ffi::INVALID_ID,
            instance: ffi::INVALID_ID,
        };
        for (ray, t) in set.rays.iter().zip(t) {
            let mut ray_hit = ffi::RtcRayHit { ray: rtc_ray(ray, set.t_max), hit };
            // SAFETY: scene, context and ray are alive and aligned.
            unsafe { ffi::rtcIntersect1(self.scene, &raw mut context, &raw mut ray_hit) };
            *t = if ray_hit.hit.geometry == ffi::INVALID_ID { f32::INFINITY } else { ray_hit.ray.t_far };
        }
    }
}

impl Drop for Scene<'_> {
    fn drop(&mut self) {
        // SAFETY: these are the only references that this program holds.
        unsafe {
            ffi::rtcReleaseScene(self.scene);
            if !self.object.is_null() {
                ffi::rtcReleaseScene(self.object);
            }
        }
    }
}

const fn rtc_ray(ray: &Ray, t_max: f32) -> ffi::RtcRay {
    ffi::RtcRay {
        origin: [ray.origin.x, ray.origin.y, ray.origin.z],
        t_near: 0.0,
        direction: [ray.direction.x, ray.direction.y, ray.direction.z],
        time: 0.0,
        t_far: t_max,
        mask: u32::MAX,
        id: 0,
        flags: 0,
    }
}

fn new_scene(device: &Device, is_robust: bool) -> *mut ffi::RtcScene {
    // SAFETY: the device is alive.
    unsafe {
        let scene = ffi::rtcNewScene(device.device);
        ffi::rtcSetSceneBuildQuality(scene, ffi::QUALITY_HIGH);
        ffi::rtcSetSceneFlags(scene, if is_robust { ffi::SCENE_ROBUST } else { 0 });
        scene
    }
}

fn attach_triangles(device: &Device, scene: *mut ffi::RtcScene, mesh: &Mesh) {
    let Mesh { positions, indices } = mesh;
    // SAFETY: device and scene are alive; the buffers outlive the scene, which borrows them, and a vertex of padding
    // follows the last one that counts.
    unsafe {
        let geometry = ffi::rtcNewGeometry(device.device, ffi::GEOMETRY_TRIANGLE);
        let buffer = |kind, format, data: *const c_void, count| {
            ffi::rtcSetSharedGeometryBuffer(geometry, kind, 0, format, data, 0, 12, count);
        };
        buffer(ffi::BUFFER_VERTEX, ffi::FORMAT_FLOAT3, positions.as_ptr().cast(), positions.len() - 1);
        buffer(ffi::BUFFER_INDEX, ffi::FORMAT_UINT3, indices.as_ptr().cast(), indices.len());
        ffi::rtcSetGeometryBuildQuality(geometry, ffi::QUALITY_HIGH);
        ffi::rtcCommitGeometry(geometry);
        ffi::rtcAttachGeometry(scene, geometry);
        ffi::rtcReleaseGeometry(geometry);
    }
}

fn attach_copy(device: &Device, world: *mut ffi::RtcScene, object: *mut ffi::RtcScene, place: &Transform) {
    // The first three rows.
    let rows = place.rows();
    // SAFETY: device and scenes are alive; the transform is copied.
    unsafe {
        let geometry = ffi::rtcNewGeometry(device.device, ffi::GEOMETRY_INSTANCE);
        ffi::rtcSetGeometryInstancedScene(geometry, object);
        let transform = rows.as_ptr().cast();
        ffi::rtcSetGeometryTransform(geometry, 0, ffi::FORMAT_FLOAT3X4_ROW_MAJOR, transform);
        ffi::rtcCommitGeometry(geometry);
        ffi::rtcAttachGeometry(world, geometry);
        ffi::rtcReleaseGeometry(geometry);
    }
}
