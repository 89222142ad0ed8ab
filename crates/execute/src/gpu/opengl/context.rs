//! Opens contexts of OpenGL and OpenGL ES in a chosen version, through EGL and without a window.
//!
//! wgpu opens one context, of the newest version that there is. But GLSL ES needs a context of
//! OpenGL ES, and GLSL 3.30 one of a core profile.

use std::ffi::{CStr, c_char, c_void};

use glow::HasContext as _;
use khronos_egl as egl;
use naga::back::glsl::Version;

/// An interface, and the lowest version that a context must have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OpenGlApi {
    /// OpenGL with the core profile.
    Core(i32, i32),
    /// OpenGL ES.
    Embedded(i32, i32),
}

impl OpenGlApi {
    /// The first version of OpenGL that has a version of GLSL. From 3.30 on the numbers are equal.
    pub fn of_glsl(version: Version) -> Self {
        match version {
            Version::Desktop(140) => Self::Core(3, 1),
            Version::Desktop(150) => Self::Core(3, 2),
            Version::Desktop(number) => {
                Self::Core((number / 100).into(), (number / 10 % 10).into())
            }
            Version::Embedded { version, .. } => {
                Self::Embedded((version / 100).into(), (version / 10 % 10).into())
            }
        }
    }
}

/// A context; it is current on a thread only while calls are made.
pub struct OpenGlContext {
    egl: Egl,
    display: egl::Display,
    context: egl::Context,
    gl: glow::Context,
    api: OpenGlApi,
    adapter: String,
}

// SAFETY: the pointers are EGL's handles, which any thread may use, and the context is not
// current on any thread between calls. There is no `Sync`: one thread at a time makes calls.
unsafe impl Send for OpenGlContext {}

type Egl = egl::DynamicInstance<egl::EGL1_5>;

/// `EGL_PLATFORM_DEVICE_EXT` of `EGL_EXT_platform_device`.
const PLATFORM_DEVICE: egl::Enum = 0x313f;
/// `EGL_PLATFORM_SURFACELESS_MESA` of `EGL_MESA_platform_surfaceless`.
const PLATFORM_SURFACELESS: egl::Enum = 0x31dd;
/// The extension of a device that renders on the CPU.
const SOFTWARE: &[u8] = b"EGL_MESA_device_software";
/// The most devices that are looked at.
const DEVICES: usize = 16;

type QueryDevices = extern "system" fn(egl::Int, *mut *mut c_void, *mut egl::Int) -> egl::Boolean;
type QueryDeviceString = extern "system" fn(*mut c_void, egl::Int) -> *const c_char;

impl OpenGlContext {
    /// Opens a context on the software device if there is one, since its numbers are the same on
    /// every machine. The error is a message.
    pub fn open(api: OpenGlApi) -> Result<Self, String> {
        // SAFETY: the library with that name is EGL.
        let egl = unsafe { Egl::load_required() }.map_err(|error| format!("EGL: {error}"))?;
        let display = open_display(&egl)?;
        let failed = |error: egl::Error| format!("EGL: {error}");
        egl.initialize(display).map_err(failed)?;
        egl.bind_api(api.bound()).map_err(failed)?;
        let wanted = [egl::SURFACE_TYPE, 0, egl::RENDERABLE_TYPE, api.renderable(), egl::NONE];
        let config = egl.choose_first_config(display, &wanted).map_err(failed)?;
        let config = config.ok_or_else(|| format!("EGL has no configuration for {api}"))?;
        let context = egl
            .create_context(display, config, None, &api.attributes())
            .map_err(|error| format!("EGL opens no context of {api}: {error}"))?;
        egl.make_current(display, None, None, Some(context)).map_err(failed)?;
        // SAFETY: the context is current, and the names are looked up in it.
        let gl = unsafe {
            glow::Context::from_loader_function(|name| {
                egl.get_proc_address(name).map_or(std::ptr::null(), |found| found as *const c_void)
            })
        };
        let adapter = describe_context(&gl);
        egl.make_current(display, None, None, None).map_err(failed)?;
        Ok(Self { egl, display, context, gl, api, adapter })
    }

    /// The interface of the context.
    pub fn api(&self) -> OpenGlApi {
        self.api
    }

    /// The renderer and the version that the context reports.
    pub fn adapter(&self) -> String {
        self.adapter.clone()
    }

    /// Runs calls while the context is current.
    pub fn with<T>(
        &self,
        calls: impl FnOnce(&glow::Context) -> Result<T, String>,
    ) -> Result<T, String> {
        let failed = |error: egl::Error| format!("EGL: {error}");
        // The bound interface is a property of the thread, and decides whose context is released
        // below.
        self.egl.bind_api(self.api.bound()).map_err(failed)?;
        self.egl.make_current(self.display, None, None, Some(self.context)).map_err(failed)?;
        let result = calls(&self.gl);
        self.egl.make_current(self.display, None, None, None).map_err(failed)?;
        result
    }
}

impl Drop for OpenGlContext {
    fn drop(&mut self) {
        // The display stays open: other contexts of the process share it.
        let _ = self.egl.destroy_context(self.display, self.context);
    }
}

impl OpenGlApi {
    fn bound(self) -> egl::Enum {
        match self {
            Self::Core(..) => egl::OPENGL_API,
            Self::Embedded(..) => egl::OPENGL_ES_API,
        }
    }

    fn renderable(self) -> egl::Int {
        match self {
            Self::Core(..) => egl::OPENGL_BIT,
            Self::Embedded(..) => egl::OPENGL_ES3_BIT,
        }
    }

    fn attributes(self) -> Vec<egl::Int> {
        let (Self::Core(major, minor) | Self::Embedded(major, minor)) = self;
        let version = [egl::CONTEXT_MAJOR_VERSION, major, egl::CONTEXT_MINOR_VERSION, minor];
        let profile = [egl::CONTEXT_OPENGL_PROFILE_MASK, egl::CONTEXT_OPENGL_CORE_PROFILE_BIT];
        let profile = if matches!(self, Self::Core(..)) { &profile[..] } else { &[] };
        [&version, profile, &[egl::NONE]].concat()
    }
}

impl std::fmt::Display for OpenGlApi {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Core(major, minor) => write!(f, "OpenGL {major}.{minor} core"),
            Self::Embedded(major, minor) => write!(f, "OpenGL ES {major}.{minor}"),
        }
    }
}

/// The display of the software device, or else one without a window system.
fn open_display(egl: &Egl) -> Result<egl::Display, String> {
    let (platform, native) = match software_device(egl) {
        Some(device) => (PLATFORM_DEVICE, device),
        None => (PLATFORM_SURFACELESS, std::ptr::null_mut()),
    };
    // SAFETY: the handle is a device of EGL's own, or what the surfaceless platform asks for.
    let found = unsafe { egl.get_platform_display(platform, native, &[egl::ATTRIB_NONE]) };
    found.map_err(|error| format!("EGL has no display without a window: {error}"))
}

/// The device that renders on the CPU, if EGL can list devices.
fn software_device(egl: &Egl) -> Option<egl::NativeDisplayType> {
    let query_devices = egl.get_proc_address("eglQueryDevicesEXT")?;
    let query_string = egl.get_proc_address("eglQueryDeviceStringEXT")?;
    // SAFETY: these are the signatures of `EGL_EXT_device_base`.
    let (query_devices, query_string) = unsafe {
        (
            std::mem::transmute::<extern "system" fn(), QueryDevices>(query_devices),
            std::mem::transmute::<extern "system" fn(), QueryDeviceString>(query_string),
        )
    };
    let (mut devices, mut count) = ([std::ptr::null_mut(); DEVICES], 0);
    if query_devices(DEVICES as egl::Int, devices.as_mut_ptr(), &mut count) != egl::TRUE {
        return None;
    }
    let is_software = |device: &&*mut c_void| {
        let names = query_string(**device, egl::EXTENSIONS);
        // SAFETY: EGL gives a text that ends with a zero, or null.
        let names = if names.is_null() { c"" } else { unsafe { CStr::from_ptr(names) } };
        names.to_bytes().split(|byte| *byte == b' ').any(|name| name == SOFTWARE)
    };
    devices.iter().take(count as usize).find(is_software).copied()
}

fn describe_context(gl: &glow::Context) -> String {
    // SAFETY: the context is current.
    let (renderer, version) = unsafe {
        (gl.get_parameter_string(glow::RENDERER), gl.get_parameter_string(glow::VERSION))
    };
    format!("{renderer}, {version}")
}
