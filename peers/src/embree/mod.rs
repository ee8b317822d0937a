//! Embree 3 or 4, opened while the program runs: no header, no C compiler, and no failure to build where it is missing.
//!
//! Its scene is the default one: a BVH of medium quality, not robust (so not watertight), and for single rays the widest
//! instructions there are.
#![allow(unsafe_code)]

mod api;

use std::ffi::{c_char, c_int};
use std::ptr;

use libloading::Library;

use crate::{Mesh, Peer, Ray, Tracer};
use api::{
    BUFFER_TYPE_INDEX, BUFFER_TYPE_VERTEX, Context, FORMAT_FLOAT3, FORMAT_UINT3, Functions,
    GEOMETRY_TYPE_TRIANGLE, Handle, RayHit, Single, VERSION,
};

/// What the dynamic linker is asked for.
const NAMES: [&str; 2] = ["libembree4.so.4", "libembree3.so.3"];

/// Names a further library, e.g. the one in the PyPI package `embreex`.
const VARIABLE: &str = "EMBREE_LIBRARY";

/// What to say where there is none.
const HOW_TO_GET_IT: &str = "Embree was not found, so its columns are missing: `apt-get install libembree-dev` gives version 3; \
     for version 4 unpack the wheel that `pip download --no-deps embreex` fetches, and set EMBREE_LIBRARY to the path of \
     `embreex.libs/libembree4-*.so.4` in it";

/// Every Embree there is, each version once; what is missing goes to the notes.
pub fn found(notes: &mut Vec<String>) -> Vec<Embree> {
    let mut all: Vec<Embree> = Vec::new();
    if let Ok(named) = std::env::var(VARIABLE) {
        match Embree::open(&named) {
            Some(embree) => all.push(embree),
            None => notes.push(format!("{VARIABLE} names no library of Embree 3 or 4")),
        }
    }
    for embree in NAMES.iter().filter_map(|name| Embree::open(name)) {
        if all.iter().all(|e| e.name != embree.name) {
            all.push(embree);
        }
    }
    if all.is_empty() {
        notes.push(HOW_TO_GET_IT.into());
    }
    all
}

/// A library with a device of one thread.
pub struct Embree {
    name: String,
    functions: Functions,
    device: Handle,
}

impl Embree {
    /// Open the library of this file name or path; `None` if there is none, or it is no Embree 3 or 4.
    fn open(file: &str) -> Option<Self> {
        // SAFETY: the library is Embree by its name or by the user's word; its initialisers are those of a C++ library and
        // ask nothing of the caller.
        let library = unsafe { Library::new(file) }.ok()?;
        // Never closed: threads of its task scheduler would wake up in code that is gone.
        let library: &'static Library = Box::leak(Box::new(library));
        macro_rules! function {
            ($name:literal) => {
                // SAFETY: the type is the one that Embree's headers declare for this name; the library is
                // never closed.
                *unsafe { library.get($name) }.ok()?
            };
        }
        let new_device: unsafe extern "C" fn(*const c_char) -> Handle = function!(b"rtcNewDevice");
        let property: unsafe extern "C" fn(Handle, c_int) -> isize =
            function!(b"rtcGetDeviceProperty");
        let config = c"threads=1,set_affinity=0";
        // SAFETY: a string that ends in 0; null is the answer where there can be no device.
        let device = unsafe { new_device(config.as_ptr()) };
        if device.is_null() {
            return None;
        }
        let [major, minor, patch] = VERSION.map(|part| {
            // SAFETY: the device is live, the property is one that every version has.
            unsafe { property(device, part) }
        });
        let single = match major {
            3 => Single::Three {
                intersect: function!(b"rtcIntersect1"),
                occluded: function!(b"rtcOccluded1"),
            },
            4 => Single::Four {
                intersect: function!(b"rtcIntersect1"),
                occluded: function!(b"rtcOccluded1"),
            },
            _ => return None,
        };
        let functions = Functions {
            release_device: function!(b"rtcReleaseDevice"),
            new_scene: function!(b"rtcNewScene"),
            release_scene: function!(b"rtcReleaseScene"),
            commit_scene: function!(b"rtcCommitScene"),
            new_geometry: function!(b"rtcNewGeometry"),
            release_geometry: function!(b"rtcReleaseGeometry"),
            set_shared_buffer: function!(b"rtcSetSharedGeometryBuffer"),
            commit_geometry: function!(b"rtcCommitGeometry"),
            attach_geometry: function!(b"rtcAttachGeometry"),
            single,
        };
        Some(Self {
            name: format!("embree-{major}.{minor}.{patch}"),
            functions,
            device,
        })
    }

    fn scene<'a>(&'a self, mesh: &'a Mesh) -> Built<'a> {
        let f = &self.functions;
        let numbers: Vec<u32> = (0..3 * mesh.len() as u32).collect();
        // SAFETY: handles are live from their `new` to their `release`; both buffers outlive the scene
        // (one is the mesh's, the other moves into `Built` without moving its numbers), hold as many items of the told
        // stride, and the corners end in the 4 bytes that Embree may read past a vertex.
        let scene = unsafe {
            let scene = (f.new_scene)(self.device);
            let geometry = (f.new_geometry)(self.device, GEOMETRY_TYPE_TRIANGLE);
            (f.set_shared_buffer)(
                geometry,
                BUFFER_TYPE_VERTEX,
                0,
                FORMAT_FLOAT3,
                mesh.corners.as_ptr().cast(),
                0,
                12,
                3 * mesh.len(),
            );
            (f.set_shared_buffer)(
                geometry,
                BUFFER_TYPE_INDEX,
                0,
                FORMAT_UINT3,
                numbers.as_ptr().cast(),
                0,
                12,
                mesh.len(),
            );
            (f.commit_geometry)(geometry);
            (f.attach_geometry)(scene, geometry);
            (f.release_geometry)(geometry);
            (f.commit_scene)(scene);
            scene
        };
        Built {
            embree: self,
            scene,
            _mesh: mesh,
            _numbers: numbers,
        }
    }
}

impl Drop for Embree {
    fn drop(&mut self) {
        // SAFETY: the device is live and no scene of it is, as scenes borrow from here.
        unsafe { (self.functions.release_device)(self.device) }
    }
}

impl Peer for Embree {
    fn name(&self) -> &str {
        &self.name
    }

    fn build<'a>(&'a self, mesh: &'a Mesh) -> Box<dyn Tracer + 'a> {
        Box::new(self.scene(mesh))
    }
}

/// A committed scene.
struct Built<'a> {
    embree: &'a Embree,
    scene: Handle,
    // Both are read by the scene.
    _mesh: &'a Mesh,
    _numbers: Vec<u32>,
}

impl Drop for Built<'_> {
    fn drop(&mut self) {
        // SAFETY: the scene is live and released once.
        unsafe { (self.embree.functions.release_scene)(self.scene) }
    }
}

impl Tracer for Built<'_> {
    fn nearest(&mut self, rays: &[Ray], hits: &mut [f32]) {
        let mut context = Context::default();
        for (ray, hit) in rays.iter().zip(hits) {
            let mut query = RayHit::new(ray);
            // SAFETY: the scene is live and committed; ray and context are of Embree's layout, aligned, and outlive the
            // call; Embree 4 takes null for its default arguments.
            unsafe {
                match self.embree.functions.single {
                    Single::Three { intersect, .. } => {
                        intersect(self.scene, &mut context, &mut query)
                    }
                    Single::Four { intersect, .. } => {
                        intersect(self.scene, &mut query, ptr::null())
                    }
                }
            }
            // Without a hit `far` stays infinite.
            *hit = query.far;
        }
    }

    fn any(&mut self, rays: &[Ray], hits: &mut [bool]) {
        let mut context = Context::default();
        for (ray, hit) in rays.iter().zip(hits) {
            let mut query = RayHit::new(ray);
            // SAFETY: as in `nearest`; the part of `RayHit` before the hit is `RTCRay`.
            unsafe {
                match self.embree.functions.single {
                    Single::Three { occluded, .. } => {
                        occluded(self.scene, &mut context, &mut query)
                    }
                    Single::Four { occluded, .. } => occluded(self.scene, &mut query, ptr::null()),
                }
            }
            // A hit sets `far` to minus infinity.
            *hit = query.far < 0.0;
        }
    }
}
