#include "render/gl/egl_context.h"

#include <dlfcn.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <array>
#include <span>
#include <string>
#include <utility>

#include "support/try.h"

namespace galactic::render::gl {
namespace {

constexpr std::size_t kMostDevices = 64;

/// Attributes of displays. If EGL can count the users of a display, it stays open for us when
/// another part of the program closes it.
std::array<EGLint, 3> displayAttributes() {
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_KHR_display_reference")) return {EGL_NONE};
  return {EGL_TRACK_REFERENCES_KHR, EGL_TRUE, EGL_NONE};
}

tl::unexpected<Error> missing(const char* message) {
  return fail(ErrorCode::kUnsupported, "render backend gl", message);
}

std::vector<EGLDeviceEXT> deviceHandles() {
  // NVIDIA's driver names only the older extension, which has both functions too.
  const bool lists = epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") ||
                     epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_base");
  if (!lists || !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device")) return {};
  std::array<EGLDeviceEXT, kMostDevices> handles{};
  EGLint count = 0;
  if (!eglQueryDevicesEXT(static_cast<EGLint>(handles.size()), handles.data(), &count)) return {};
  // Parentheses, because braces would make a list of the two iterators, which are pointers
  // themselves.
  return std::vector<EGLDeviceEXT>(handles.begin(), handles.begin() + count);
}

DeviceFacts factsOf(EGLDeviceEXT device, std::size_t number) {
  DeviceFacts facts;
  facts.name = fmt::format("EGL device {}", number);
  // This query comes first: if a device is hidden from the process, some drivers crash in the later
  // ones.
  const char* extensions = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
  if (extensions == nullptr) return facts;
  facts.software = epoxy_extension_in_string(extensions, "EGL_MESA_device_software");
  if (facts.software) facts.name = "Mesa's software driver";
  EGLAttrib cuda = 0;
  if (epoxy_extension_in_string(extensions, "EGL_NV_device_cuda") &&
      eglQueryDeviceAttribEXT(device, EGL_CUDA_DEVICE_NV, &cuda)) {
    facts.cuda = cuda;
  }
  if (!facts.software && epoxy_extension_in_string(extensions, "EGL_EXT_device_drm")) {
    const char* node = eglQueryDeviceStringEXT(device, EGL_DRM_DEVICE_FILE_EXT);
    if (node != nullptr) facts.name = node;
  }
  return facts;
}

ContextFacts factsOfCurrent() {
  ContextFacts facts;
  const int version = epoxy_gl_version();
  facts.major = version / 10;
  facts.minor = version % 10;
  const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  facts.renderer = renderer == nullptr ? "unknown" : renderer;
  if (epoxy_has_gl_extension("GL_EXT_memory_object")) {
    GLint devices = 0;
    glGetIntegerv(GL_NUM_DEVICE_UUIDS_EXT, &devices);
    DeviceUuid uuid{};
    if (devices > 0) {
      glGetUnsignedBytei_vEXT(GL_DEVICE_UUID_EXT, 0, uuid.data());
      facts.uuid = uuid;
    }
  }
  return facts;
}

/// A core context of OpenGL 4.5, or else of whatever version there is, so that the error can name
/// it.
EGLContext newContext(EGLDisplay display) {
  constexpr std::array<std::array<EGLint, 2>, 2> kVersions{{{4, 5}, {3, 2}}};
  for (const auto& [major, minor] : kVersions) {
    const std::array<EGLint, 7> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                           major,
                                           EGL_CONTEXT_MINOR_VERSION,
                                           minor,
                                           EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                           EGL_NONE};
    const EGLContext context =
        eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
    if (context != EGL_NO_CONTEXT) return context;
  }
  return EGL_NO_CONTEXT;
}

tl::unexpected<Error> refused(const std::string& name, const char* what,
                              EGLint error = eglGetError()) {
  return fail(
      ErrorCode::kUnsupported, "render device",
      fmt::format("{}: {} (EGL error 0x{:04x}); expected OpenGL 4.5 without a display: check "
                  "the driver, or use the soft backend",
                  name, what, error));
}

Result<EglContext> openOn(EGLDisplay display, const std::string& name) {
  if (display == EGL_NO_DISPLAY) return refused(name, "EGL gives no display for it");
  if (!eglInitialize(display, nullptr, nullptr)) return refused(name, "EGL cannot start on it");
  const EGLenum api = eglQueryAPI();
  eglBindAPI(EGL_OPENGL_API);
  const EGLContext handle = newContext(display);
  eglBindAPI(api);
  if (handle == EGL_NO_CONTEXT) return refused(name, "EGL gives no OpenGL context on it");
  EglContext opened(display, handle);
  const CurrentContext current(opened);
  if (!current.holds()) {
    return refused(name, "EGL cannot use a context without a surface", current.error());
  }
  opened.setFacts(factsOfCurrent());
  return opened;
}

Result<EglContext> openSurfaceless() {
  const std::string name = "Mesa's surfaceless platform";
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
    return fail(ErrorCode::kUnsupported, "render device",
                "EGL lists no device and has no surfaceless platform; install the graphics "
                "processor's driver, libgl1-mesa-dri for the software driver, or use the soft "
                "backend");
  }
  return openOn(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY,
                                         displayAttributes().data()),
                name);
}

/// Opens the first device that meets the wish; if none does, the error has the reason for each.
Result<EglContext> openFirst(const DeviceWish& wish, std::span<const EGLDeviceEXT> handles,
                             std::span<const DeviceFacts> devices,
                             std::span<const std::size_t> numbers) {
  std::string reasons;
  for (const std::size_t number : numbers) {
    const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, handles[number],
                                                        displayAttributes().data());
    Result<EglContext> opened = openOn(display, devices[number].name);
    const Result<void> judged =
        opened ? judgeContext(wish, opened->facts()) : tl::unexpected<Error>(opened.error());
    if (judged) return opened;
    if (numbers.size() == 1) return tl::unexpected<Error>(judged.error());
    reasons +=
        fmt::format("{}device {}: {}", reasons.empty() ? "" : "; ", number, judged.error().message);
  }
  return fail(ErrorCode::kUnsupported, "render device",
              reasons.empty() ? "EGL lists no device" : "no device would do. " + reasons);
}

/// The renderer string of the first software driver that opens.
Result<std::string> softwareName(std::span<const EGLDeviceEXT> handles,
                                 std::span<const DeviceFacts> devices) {
  const DeviceWish software{.kind = DeviceWish::Kind::kSoftware};
  ASSIGN_OR_RETURN(const auto numbers, devicesFor(software, devices));
  ASSIGN_OR_RETURN(const EglContext opened, openFirst(software, handles, devices, numbers));
  return opened.facts().renderer;
}

bool isNamed(const DeviceWish& wish) {
  return wish.kind != DeviceWish::Kind::kFirstGpu && wish.kind != DeviceWish::Kind::kSoftware;
}

}  // namespace

bool loadsLibrary(const char* name) {
  // Never closed, because many drivers cannot be unloaded safely.
  return dlopen(name, RTLD_LAZY | RTLD_LOCAL) != nullptr;
}

Result<void> checkLibraries(const LibraryLoads& loads) {
  if (!loads("libEGL.so.1")) {
    return missing(
        "found no libEGL.so.1; install libegl1 (and libgl1-mesa-dri for the software driver), or "
        "use the soft backend");
  }
  if (!loads("libOpenGL.so.0") && !loads("libGL.so.1")) {
    return missing(
        "found neither libOpenGL.so.0 nor libGL.so.1; install libopengl0, or use the soft "
        "backend");
  }
  return {};
}

EglContext::~EglContext() {
  if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
}

EglContext::EglContext(EglContext&& other) noexcept
    : display_(other.display_),
      context_(std::exchange(other.context_, EGL_NO_CONTEXT)),
      facts_(std::move(other.facts_)) {}

EglContext& EglContext::operator=(EglContext&& other) noexcept {
  std::swap(display_, other.display_);
  std::swap(context_, other.context_);
  std::swap(facts_, other.facts_);
  return *this;
}

CurrentContext::CurrentContext(const EglContext& context)
    : own_display_(context.display()), api_(eglQueryAPI()) {
  eglBindAPI(EGL_OPENGL_API);
  previous_ = eglGetCurrentContext();
  display_ = eglGetCurrentDisplay();
  draw_ = eglGetCurrentSurface(EGL_DRAW);
  read_ = eglGetCurrentSurface(EGL_READ);
  holds_ =
      eglMakeCurrent(own_display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context.handle()) == EGL_TRUE;
  if (holds_) return;
  error_ = eglGetError();
  if (previous_ != EGL_NO_CONTEXT) {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
}

CurrentContext::~CurrentContext() {
  if (previous_ == EGL_NO_CONTEXT) {
    eglMakeCurrent(own_display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  } else {
    eglMakeCurrent(display_, draw_, read_, previous_);
  }
  eglBindAPI(api_);
}

Result<EglContext> openContext(const DeviceWish& wish, bool explain) {
  const std::vector<EGLDeviceEXT> handles = deviceHandles();
  std::vector<DeviceFacts> devices;
  devices.reserve(handles.size());
  for (const EGLDeviceEXT handle : handles) devices.push_back(factsOf(handle, devices.size()));
  const auto numbers = devicesFor(wish, devices);
  if (!numbers) {
    if (explain && wish.kind == DeviceWish::Kind::kFirstGpu) {
      const Result<std::string> name = softwareName(handles, devices);
      if (name) return tl::unexpected<Error>(onlySoftware(*name));
    }
    return tl::unexpected<Error>(numbers.error());
  }
  Result<EglContext> opened = openFirst(wish, handles, devices, *numbers);
  if (opened || isNamed(wish)) return opened;
  Result<EglContext> surfaceless = openSurfaceless();
  if (!surfaceless) return numbers->empty() ? std::move(surfaceless) : std::move(opened);
  if (const Result<void> judged = judgeContext(wish, surfaceless->facts()); !judged) {
    return tl::unexpected<Error>(numbers->empty() ? judged.error() : opened.error());
  }
  return surfaceless;
}

}  // namespace galactic::render::gl
