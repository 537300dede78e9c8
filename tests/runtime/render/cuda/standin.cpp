// A library that stands in for libcuda.so.1 where there is no device: memory of the device is
// memory of the processor, and launches run the very kernels, compiled for the processor. Buffers
// of OpenGL are copied there while they are mapped. It has the functions that the renderer calls,
// nothing else.
#include "standin.h"

#include <dlfcn.h>

#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "render/cuda/kernels/kernels.inl"

// Its names are those of libcuda.so.1, its addresses numbers, and its state the process's.
// NOLINTBEGIN(readability-identifier-naming,performance-no-int-to-ptr,readability-function-size)
// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables,google-build-using-namespace)
#define STANDIN extern "C" __attribute__((visibility("default")))

namespace galactic::test {
namespace {

using render::cuda::Block;
using render::cuda::Kernel;
using render::cuda::PassParameters;

Standin standin;
std::map<void*, std::size_t> memories;
/// Programs draw from several threads; the device does one thing after the other.
std::mutex device_mutex;
/// A device is its number, and a context the place of that here.
constexpr std::size_t kMostDevices = 8;
char device_contexts[kMostDevices];
int loaded_module = 0;
/// By threads. No thread_local: leak checkers stumble over those of libraries that were opened
/// late.
std::map<std::thread::id, std::vector<void*>> contexts_pushed;
/// The devices by the numbers that programs see.
std::vector<int> visible;

/// A buffer of OpenGL that is shared.
struct SharedBuffer {
  unsigned name = 0;
  void* copy = nullptr;
  std::size_t bytes = 0;
};

/// 0, or the error that was asked for.
int outcome(const char* function) {
  return standin.failing != nullptr && std::string_view(standin.failing) == function ? standin.error
                                                                                     : 0;
}

std::string uuidOf(int device) {
  std::string text = "GPU-";
  for (int n = 0; n < 16; ++n) {
    constexpr const char* kDigits = "0123456789abcdef";
    if (n == 4 || n == 6 || n == 8 || n == 10) text += '-';
    text += kDigits[device];
    text += kDigits[n];
  }
  return text;
}

/// What CUDA_VISIBLE_DEVICES leaves: numbers, or beginnings of UUIDs, up to the first that is none.
std::vector<int> visibleDevices() {
  std::vector<int> devices;
  const char* names = std::getenv("CUDA_VISIBLE_DEVICES");
  std::istringstream list(names == nullptr ? "" : names);
  if (names == nullptr) {
    for (int n = 0; n < standin.devices; ++n) devices.push_back(n);
  }
  for (std::string name; std::getline(list, name, ',');) {
    int found = -1;
    for (int n = 0; n < standin.devices; ++n) {
      const bool is_uuid = name.starts_with("GPU-") && uuidOf(n).starts_with(name);
      if (is_uuid || name == std::to_string(n)) found = n;
    }
    if (found < 0) break;
    devices.push_back(found);
  }
  return devices;
}

/// A function of the OpenGL that is current.
template <class Function>
Function openGl(const char* name) {
  using Get = void* (*)(const char*);
  static void* const library = dlopen("libEGL.so.1", RTLD_NOW);
  static const auto get = reinterpret_cast<Get>(dlsym(library, "eglGetProcAddress"));
  return reinterpret_cast<Function>(get(name));
}

void note(void* stream) {
  const std::scoped_lock lock(device_mutex);
  ++standin.under_way;
  ++(reinterpret_cast<std::uintptr_t>(stream) == standin.stream ? standin.on_stream
                                                                : standin.on_others);
}

void* allocate(std::size_t bytes) {
  // As on a device, nothing is promised about what is there.
  void* memory = std::aligned_alloc(256, (bytes + 255) / 256 * 256);
  std::memset(memory, 0xCD, bytes);
  const std::scoped_lock lock(device_mutex);
  memories[memory] = bytes;
  ++standin.allocations;
  standin.allocated_bytes += bytes;
  return memory;
}

void release(void* memory) {
  const std::scoped_lock lock(device_mutex);
  standin.allocated_bytes -= memories.at(memory);
  --standin.allocations;
  memories.erase(memory);
  std::free(memory);
}

void runBlock(Kernel kernel, const Block& block, const PassParameters& parameters) {
  using namespace render::cuda;
  const ViewSlice& slice = parameters.slice;
  switch (kernel) {
    case Kernel::kPlace:
      return placeInstances(block, slice);
    case Kernel::kCull: {
      static CullShared shared;
      std::memset(static_cast<void*>(&shared), 0xCD, sizeof(shared));
      return cullPane(block, shared, slice);
    }
    case Kernel::kDraw: {
      static DrawShared shared;
      std::memset(static_cast<void*>(&shared), 0xCD, sizeof(shared));
      return drawClusters(block, shared, slice, parameters.pass);
    }
    case Kernel::kTiles:
      return measureTiles(block, slice);
    case Kernel::kResolve: {
      static ResolveShared shared;
      std::memset(static_cast<void*>(&shared), 0xCD, sizeof(shared));
      return resolvePane(block, shared, slice,
                         block.count / (slice.view_count * slice.panes_of_view));
    }
  }
}

}  // namespace

STANDIN Standin* galactic_standin() { return &standin; }

STANDIN int cuInit(unsigned) {
  constexpr int kNoDevice = 100;
  const int error = outcome("cuInit");
  if (error != 0) return error;
  visible = visibleDevices();
  return visible.empty() ? kNoDevice : 0;
}
STANDIN int cuGetErrorName(int error, const char** name) {
  *name = error == 2 ? "CUDA_ERROR_OUT_OF_MEMORY" : "CUDA_ERROR_UNKNOWN";
  return 0;
}
STANDIN int cuDeviceGetCount(int* count) {
  *count = static_cast<int>(visible.size());
  return outcome("cuDeviceGetCount");
}
STANDIN int cuDeviceGet(int* device, int number) {
  static_cast<void>(visible.at(static_cast<std::size_t>(number)));
  *device = number;
  return 0;
}
STANDIN int cuDeviceGetName(char* name, int length, int device) {
  const bool is_first = visible.at(static_cast<std::size_t>(device)) == 0;
  std::strncpy(name, is_first ? "Stand-in A" : "Stand-in B", static_cast<std::size_t>(length));
  return 0;
}
STANDIN int cuDeviceGetUuid(unsigned char* uuid, int device) {
  const int seen = visible.at(static_cast<std::size_t>(device));
  for (int n = 0; n < 16; ++n) uuid[n] = static_cast<unsigned char>(16 * seen + n);
  return 0;
}
STANDIN int cuDeviceGetAttribute(int* value, int attribute, int) {
  constexpr int kMultiprocessors = 16;
  constexpr int kMajor = 75;
  if (attribute == kMultiprocessors) {
    *value = 1;
  } else {
    *value = attribute == kMajor ? standin.major : standin.minor;
  }
  return 0;
}
STANDIN int cuDevicePrimaryCtxRetain(void** context, int device) {
  *context = device_contexts + device;
  ++standin.contexts;
  return outcome("cuDevicePrimaryCtxRetain");
}
STANDIN int cuDevicePrimaryCtxRelease_v2(int) {
  --standin.contexts;
  return 0;
}
STANDIN int cuCtxPushCurrent_v2(void* context) {
  const std::scoped_lock lock(device_mutex);
  const auto* place = static_cast<const char*>(context);
  if (place < device_contexts || place >= device_contexts + kMostDevices) return 1;
  const int error = outcome("cuCtxPushCurrent");
  if (error != 0) return error;
  contexts_pushed[std::this_thread::get_id()].push_back(context);
  ++standin.pushed_contexts;
  return 0;
}
STANDIN int cuCtxPopCurrent_v2(void** context) {
  const std::scoped_lock lock(device_mutex);
  std::vector<void*>& pushed = contexts_pushed[std::this_thread::get_id()];
  if (pushed.empty()) return 201;  // CUDA_ERROR_INVALID_CONTEXT
  *context = pushed.back();
  pushed.pop_back();
  --standin.pushed_contexts;
  return 0;
}
STANDIN int cuCtxGetCurrent(void** context) {
  const std::scoped_lock lock(device_mutex);
  const std::vector<void*>& pushed = contexts_pushed[std::this_thread::get_id()];
  *context = pushed.empty() ? nullptr : pushed.back();
  return 0;
}
STANDIN int cuCtxGetDevice(int* device) {
  constexpr int kInvalidContext = 201;
  const std::scoped_lock lock(device_mutex);
  const std::vector<void*>& pushed = contexts_pushed[std::this_thread::get_id()];
  if (pushed.empty()) return kInvalidContext;
  *device = static_cast<int>(static_cast<char*>(pushed.back()) - device_contexts);
  return 0;
}
STANDIN int cuModuleLoadDataEx(void** module, const void* image, unsigned, int*, void** values) {
  const int error = outcome("cuModuleLoadDataEx");
  if (error != 0) {
    std::strncpy(static_cast<char*>(values[0]), "ptxas says no", 64);
    return error;
  }
  const std::string_view text(static_cast<const char*>(image));
  for (const char* name : render::cuda::kKernelNames) {
    if (text.find(name) == std::string_view::npos) return 1;
  }
  *module = &loaded_module;
  ++standin.modules;
  return 0;
}
STANDIN int cuModuleUnload(void*) {
  --standin.modules;
  return 0;
}
STANDIN int cuModuleGetFunction(void** function, void*, const char* name) {
  for (std::size_t n = 0; n < render::cuda::kKernels; ++n) {
    if (std::string_view(render::cuda::kKernelNames[n]) != name) continue;
    *function = standin.launches + n;
    return 0;
  }
  return 1;
}
STANDIN int cuMemAlloc_v2(std::uint64_t* address, std::size_t bytes) {
  const int error = outcome("cuMemAlloc");
  if (error == 0) *address = reinterpret_cast<std::uint64_t>(allocate(bytes));
  return error;
}
STANDIN int cuMemFree_v2(std::uint64_t address) {
  release(reinterpret_cast<void*>(address));
  return 0;
}
STANDIN int cuMemHostAlloc(void** address, std::size_t bytes, unsigned) {
  *address = allocate(bytes);
  return 0;
}
STANDIN int cuMemFreeHost(void* address) {
  release(address);
  return 0;
}
STANDIN int cuMemcpyHtoDAsync_v2(std::uint64_t to, const void* from, std::size_t bytes,
                                 void* stream) {
  note(stream);
  std::memcpy(reinterpret_cast<void*>(to), from, bytes);
  return 0;
}
STANDIN int cuMemcpyDtoHAsync_v2(void* to, std::uint64_t from, std::size_t bytes, void* stream) {
  note(stream);
  std::memcpy(to, reinterpret_cast<const void*>(from), bytes);
  if (standin.spoils) static_cast<unsigned char*>(to)[bytes / 2] ^= 1U;
  return 0;
}
STANDIN int cuMemsetD32Async(std::uint64_t to, unsigned value, std::size_t words, void* stream) {
  note(stream);
  auto* first = reinterpret_cast<unsigned*>(to);
  for (std::size_t n = 0; n < words; ++n) first[n] = value;
  return 0;
}
STANDIN int cuLaunchKernel(void* function, unsigned grid, unsigned, unsigned, unsigned, unsigned,
                           unsigned, unsigned, void* stream, void** parameters, void**) {
  note(stream);
  const int error = outcome("cuLaunchKernel");
  if (error != 0) return error;
  // For measurements of the processor's side.
  static const bool is_idle = std::getenv("GALACTIC_STANDIN_IDLE") != nullptr;
  if (is_idle) return 0;
  const std::scoped_lock lock(device_mutex);
  auto* launches = static_cast<std::uint64_t*>(function);
  ++*launches;
  PassParameters copy;
  std::memcpy(&copy, parameters[0], sizeof(copy));
  for (unsigned n = 0; n < grid; ++n) {
    const Block block{standin.backwards ? grid - 1 - n : n, grid, standin.threads, standin.stride,
                      standin.first};
    runBlock(static_cast<Kernel>(launches - standin.launches), block, copy);
  }
  return 0;
}
STANDIN int cuStreamSynchronize(void* stream) {
  note(stream);
  standin.under_way = 0;
  return outcome("cuStreamSynchronize");
}
STANDIN int cuGraphicsGLRegisterBuffer(SharedBuffer** resource, unsigned name, unsigned) {
  const int error = outcome("cuGraphicsGLRegisterBuffer");
  if (error != 0) return error;
  *resource = new SharedBuffer{.name = name};
  ++standin.shared_buffers;
  return 0;
}
STANDIN int cuGraphicsUnregisterResource(SharedBuffer* resource) {
  --standin.shared_buffers;
  delete resource;
  return 0;
}
STANDIN int cuGraphicsMapResources(unsigned, SharedBuffer** resources, void* stream) {
  note(stream);
  const int error = outcome("cuGraphicsMapResources");
  if (error != 0) return error;
  SharedBuffer& buffer = *resources[0];
  constexpr unsigned kBufferSize = 0x8764;
  std::int64_t bytes = 0;
  openGl<void (*)(unsigned, unsigned, std::int64_t*)>("glGetNamedBufferParameteri64v")(
      buffer.name, kBufferSize, &bytes);
  buffer.bytes = static_cast<std::size_t>(bytes);
  buffer.copy = allocate(buffer.bytes);
  openGl<void (*)(unsigned)>("glMemoryBarrier")(~0U);
  openGl<void (*)(unsigned, std::ptrdiff_t, std::ptrdiff_t, void*)>("glGetNamedBufferSubData")(
      buffer.name, 0, bytes, buffer.copy);
  ++standin.mapped_buffers;
  return 0;
}
STANDIN int cuGraphicsUnmapResources(unsigned, SharedBuffer** resources, void* stream) {
  note(stream);
  release(resources[0]->copy);
  --standin.mapped_buffers;
  return 0;
}
STANDIN int cuGraphicsResourceGetMappedPointer_v2(std::uint64_t* address, std::size_t* bytes,
                                                  SharedBuffer* resource) {
  *address = reinterpret_cast<std::uint64_t>(resource->copy);
  *bytes = resource->bytes;
  return 0;
}

// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables,google-build-using-namespace)
// NOLINTEND(readability-identifier-naming,performance-no-int-to-ptr,readability-function-size)

}  // namespace galactic::test
