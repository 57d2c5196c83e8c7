//! The few functions of Embree 3.13 that are needed, as `embree3/rtcore.h` declares them for x86-64.

use std::ffi::{c_char, c_void};

macro_rules! handle {
    ($name:ident) => {
        #[repr(C)]
        pub(crate) struct $name {
            _opaque: [u8; 0],
        }
    };
}
handle!(RtcDevice);
handle!(RtcScene);
handle!(RtcGeometry);

#[repr(C, align(16))]
#[derive(Clone, Copy)]
pub(crate) struct RtcRay {
    pub(crate) origin: [f32; 3],
    pub(crate) t_near: f32,
    pub(crate) direction: [f32; 3],
    pub(crate) time: f32,
    pub(crate) t_far: f32,
    pub(crate) mask: u32,
    pub(crate) id: u32,
    pub(crate) flags: u32,
}

#[repr(C, align(16))]
#[derive(Clone, Copy)]
pub(crate) struct RtcHit {
    pub(crate) normal: [f32; 3],
    pub(crate) uv: [f32; 2],
    pub(crate) primitive: u32,
    pub(crate) geometry: u32,
    pub(crate) instance: u32,
}

#[repr(C)]
#[derive(Clone, Copy)]
pub(crate) struct RtcRayHit {
    pub(crate) ray: RtcRay,
    pub(crate) hit: RtcHit,
}

#[repr(C)]
pub(crate) struct RtcIntersectContext {
    pub(crate) flags: u32,
    pub(crate) filter: *const c_void,
    pub(crate) instance: u32,
    /// Room that some builds of the library use.
    pub(crate) min_width: f32,
}

pub(crate) const INVALID_ID: u32 = u32::MAX;
pub(crate) const FORMAT_UINT3: u32 = 0x5003;
pub(crate) const FORMAT_FLOAT3: u32 = 0x9003;
pub(crate) const FORMAT_FLOAT3X4_ROW_MAJOR: u32 = 0x9134;
pub(crate) const BUFFER_INDEX: u32 = 0;
pub(crate) const BUFFER_VERTEX: u32 = 1;
pub(crate) const GEOMETRY_TRIANGLE: u32 = 0;
pub(crate) const GEOMETRY_INSTANCE: u32 = 121;
pub(crate) const QUALITY_HIGH: u32 = 2;
pub(crate) const SCENE_ROBUST: u32 = 4;

pub(crate) type MemoryMonitor = extern "C" fn(*mut c_void, isize, bool) -> bool;

unsafe extern "C" {
    pub(crate) fn rtcNewDevice(config: *const c_char) -> *mut RtcDevice;
    pub(crate) fn rtcReleaseDevice(device: *mut RtcDevice);
    pub(crate) fn rtcGetDeviceError(device: *mut RtcDevice) -> u32;
    pub(crate) fn rtcSetDeviceMemoryMonitorFunction(
        device: *mut RtcDevice,
        monitor: Option<MemoryMonitor>,
        user: *mut c_void,
    );
    pub(crate) fn rtcNewScene(device: *mut RtcDevice) -> *mut RtcScene;
    pub(crate) fn rtcReleaseScene(scene: *mut RtcScene);
    pub(crate) fn rtcSetSceneBuildQuality(scene: *mut RtcScene, quality: u32);
    pub(crate) fn rtcSetSceneFlags(scene: *mut RtcScene, flags: u32);
    pub(crate) fn rtcCommitScene(scene: *mut RtcScene);
    pub(crate) fn rtcNewGeometry(device: *mut RtcDevice, kind: u32) -> *mut RtcGeometry;
    pub(crate) fn rtcReleaseGeometry(geometry: *mut RtcGeometry);
    pub(crate) fn rtcSetSharedGeometryBuffer(
        geometry: *mut RtcGeometry,
        kind: u32,
        slot: u32,
        format: u32,
        data: *const c_void,
        byte_offset: usize,
        byte_stride: usize,
        count: usize,
    );
    pub(crate) fn rtcSetGeometryBuildQuality(geometry: *mut RtcGeometry, quality: u32);
    pub(crate) fn rtcSetGeometryInstancedScene(geometry: *mut RtcGeometry, scene: *mut RtcScene);
    pub(crate) fn rtcSetGeometryTransform(
        geometry: *mut RtcGeometry,
        time_step: u32,
        format: u32,
        transform: *const c_void,
    );
    pub(crate) fn rtcCommitGeometry(geometry: *mut RtcGeometry);
    pub(crate) fn rtcAttachGeometry(scene: *mut RtcScene, geometry: *mut RtcGeometry) -> u32;
    pub(crate) fn rtcIntersect1(
        scene: *mut RtcScene,
        context: *mut RtcIntersectContext,
        ray_hit: *mut RtcRayHit,
    );
    pub(crate) fn rtcOccluded1(scene: *mut RtcScene, context: *mut RtcIntersectContext, ray: *mut RtcRay);
}
