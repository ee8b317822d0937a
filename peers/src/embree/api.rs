//! The part of Embree's interface that is used, after `rtcore_*.h` of 3.13 and 4.4.

use std::ffi::{c_int, c_uint, c_void};
use std::ptr;

use crate::Ray;

/// A device, scene or geometry.
pub type Handle = *mut c_void;

/// The properties of a device that tell its version: major, minor, patch.
pub const VERSION: [c_int; 3] = [1, 2, 3];
pub const GEOMETRY_TYPE_TRIANGLE: c_int = 0;
pub const BUFFER_TYPE_INDEX: c_int = 0;
pub const BUFFER_TYPE_VERTEX: c_int = 1;
pub const FORMAT_UINT3: c_int = 0x5003;
pub const FORMAT_FLOAT3: c_int = 0x9003;
const INVALID: c_uint = c_uint::MAX;

/// `RTCRayHit`: a ray and its hit. Embree 4 may keep one number more at the end; `rest` leaves room for it.
#[repr(C, align(16))]
pub struct RayHit {
    origin: [f32; 3],
    near: f32,
    direction: [f32; 3],
    time: f32,
    /// The hit's t; minus infinity where any hit was asked for.
    pub far: f32,
    mask: c_uint,
    id: c_uint,
    flags: c_uint,
    normal: [f32; 3],
    uv: [f32; 2],
    primitive: c_uint,
    geometry: c_uint,
    instance: c_uint,
    rest: [c_uint; 4],
}

impl RayHit {
    #[inline]
    pub fn new(ray: &Ray) -> Self {
        Self {
            origin: ray.origin,
            near: 0.0,
            direction: ray.direction,
            time: 0.0,
            far: f32::INFINITY,
            mask: INVALID,
            id: 0,
            flags: 0,
            normal: [0.0; 3],
            uv: [0.0; 2],
            primitive: INVALID,
            geometry: INVALID,
            instance: INVALID,
            rest: [INVALID; 4],
        }
    }
}

/// `RTCIntersectContext` of Embree 3, with room for fields that a build may add.
#[repr(C)]
pub struct Context {
    flags: c_int,
    filter: *const c_void,
    instance: c_uint,
    rest: [c_uint; 8],
}

impl Default for Context {
    /// As `rtcInitIntersectContext` sets it.
    fn default() -> Self {
        Self {
            flags: 0,
            filter: ptr::null(),
            instance: INVALID,
            rest: [0; 8],
        }
    }
}

/// The functions used, by their names in Embree.
pub struct Functions {
    pub release_device: unsafe extern "C" fn(Handle),
    pub new_scene: unsafe extern "C" fn(Handle) -> Handle,
    pub release_scene: unsafe extern "C" fn(Handle),
    pub commit_scene: unsafe extern "C" fn(Handle),
    pub new_geometry: unsafe extern "C" fn(Handle, c_int) -> Handle,
    pub release_geometry: unsafe extern "C" fn(Handle),
    pub set_shared_buffer:
        unsafe extern "C" fn(Handle, c_int, c_uint, c_int, *const c_void, usize, usize, usize),
    pub commit_geometry: unsafe extern "C" fn(Handle),
    pub attach_geometry: unsafe extern "C" fn(Handle, Handle) -> c_uint,
    pub single: Single,
}

/// The calls for single rays; their arguments differ between the versions.
#[derive(Clone, Copy)]
pub enum Single {
    Three {
        intersect: unsafe extern "C" fn(Handle, *mut Context, *mut RayHit),
        occluded: unsafe extern "C" fn(Handle, *mut Context, *mut RayHit),
    },
    Four {
        intersect: unsafe extern "C" fn(Handle, *mut RayHit, *const c_void),
        occluded: unsafe extern "C" fn(Handle, *mut RayHit, *const c_void),
    },
}
