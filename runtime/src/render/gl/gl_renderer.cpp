#include "render/gl/gl_renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>

#include "render/device_wish.h"
#include "render/gl/library_textures.h"
#include "support/threads/stopwatch.h"
#include "support/try.h"

namespace galactic::render::gl {
namespace {

/// As glMultiDrawElementsIndirect() reads it.
struct DrawCommand {
  std::uint32_t count;
  std::uint32_t instance_count;
  std::uint32_t first_index;
  std::int32_t base_vertex;
  std::uint32_t base_instance;
};
/// What culling finds out about a chunk.
struct ChunkResult {
  std::uint32_t seen;
  std::uint32_t triangles;
  std::uint32_t first_draw;
};
/// Bindings and locations of the shaders.
enum Binding : GLuint { kInstances = 0, kBounds = 2, kChunks = 3, kResults = 4, kDraws = 5 };
/// An attribute of a vertex or of an instance.
struct Attribute {
  GLuint location;
  GLint count;
  GLenum type;
  std::size_t offset;
};
constexpr std::array<Attribute, 4> kVertexAttributes{
    {{0, 3, GL_FLOAT, offsetof(GpuVertex, x)},
     {1, 2, GL_FLOAT, offsetof(GpuVertex, u)},
     {3, 2, GL_UNSIGNED_INT, offsetof(GpuVertex, texture)},
     {4, 1, GL_FLOAT, offsetof(GpuVertex, alpha_cutoff)}}};
constexpr GLuint kColorLocation = 2;
constexpr std::array<Attribute, 6> kInstanceAttributes{
    {{5, 4, GL_FLOAT, offsetof(GpuInstance, rows)},
     {6, 4, GL_FLOAT, offsetof(GpuInstance, rows) + 4 * sizeof(float)},
     {7, 4, GL_FLOAT, offsetof(GpuInstance, rows) + 8 * sizeof(float)},
     {8, 2, GL_FLOAT, offsetof(GpuInstance, scale_x)},
     {9, 1, GL_UNSIGNED_INT, offsetof(GpuInstance, layer)},
     {10, 1, GL_UNSIGNED_INT, offsetof(GpuInstance, semantic)}}};
/// Bindings of the vertex array.
constexpr GLuint kPerVertex = 0;
constexpr GLuint kPerInstance = 1;

void describe(GLuint array, const Attribute& attribute, GLuint binding) {
  const auto offset = static_cast<GLuint>(attribute.offset);
  glEnableVertexArrayAttrib(array, attribute.location);
  if (attribute.type == GL_FLOAT) {
    glVertexArrayAttribFormat(array, attribute.location, attribute.count, GL_FLOAT, GL_FALSE,
                              offset);
  } else {
    glVertexArrayAttribIFormat(array, attribute.location, attribute.count, attribute.type, offset);
  }
  glVertexArrayAttribBinding(array, attribute.location, binding);
}

constexpr std::size_t kTotalsBytes = kDrawClasses * sizeof(DrawTotals);

/// Size of the images that a slice reads back, bytes.
std::size_t readBytes(const ViewSlice& slice) { return slice.stays ? 0 : slice.layout.bytes; }

GLint limitOf(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

void bind(Binding binding, const Buffer& buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.get());
}

/// Starts the current compute shader with at least `threads` threads, in rows of work groups no
/// longer than every driver must support.
void dispatch(std::size_t threads) {
  constexpr std::size_t kLongestRow = 65535;
  const std::size_t groups = (threads + kGroupSize - 1) / kGroupSize;
  if (groups == 0) return;
  const std::size_t rows = (groups + kLongestRow - 1) / kLongestRow;
  const std::size_t row = (groups + rows - 1) / rows;
  glDispatchCompute(static_cast<GLuint>(row), static_cast<GLuint>(rows), 1);
}

void copyBuffer(const Buffer& from, std::size_t from_offset, const Buffer& to,
                std::size_t to_offset, std::size_t bytes) {
  if (bytes == 0) return;
  glCopyNamedBufferSubData(from.get(), to.get(), static_cast<GLintptr>(from_offset),
                           static_cast<GLintptr>(to_offset), static_cast<GLsizeiptr>(bytes));
}

std::array<std::uint32_t, kDrawClasses> firstOf(
    const std::array<std::uint32_t, kDrawClasses>& counts) {
  std::array<std::uint32_t, kDrawClasses> first{};
  std::exclusive_scan(counts.begin(), counts.end(), first.begin(), 0U);
  return first;
}

void stamp(Query& query) {
  if (query.get() == 0) {
    GLuint name = 0;
    glCreateQueries(GL_TIMESTAMP, 1, &name);
    query = Query(name);
  }
  glQueryCounter(query.get(), GL_TIMESTAMP);
}

double secondsBetween(const Query& begin, const Query& end) {
  GLuint64 first = 0;
  GLuint64 last = 0;
  glGetQueryObjectui64v(begin.get(), GL_QUERY_RESULT, &first);
  glGetQueryObjectui64v(end.get(), GL_QUERY_RESULT, &last);
  return static_cast<double>(last - first) * 1e-9;
}

}  // namespace

Result<std::unique_ptr<GlRenderer>> GlRenderer::make(const RenderLibrary& library,
                                                     const RenderOptions& options,
                                                     const GlTuning& tuning) {
  std::unique_ptr<GlRenderer> renderer(new GlRenderer(options));
  if (const Result<void> loaded = renderer->load(library, tuning); !loaded) {
    return tl::unexpected<Error>(loaded.error());
  }
  return renderer;
}

Result<void> GlRenderer::load(const RenderLibrary& library, const GlTuning& tuning) {
  const auto has = [&](const char* extension) {
    return !tuning.core_only && epoxy_has_gl_extension(extension);
  };
  ASSIGN_OR_RETURN(
      const TexturePlan plan,
      planTextures(
          library,
          {.arrays = std::min<std::size_t>(
               static_cast<std::size_t>(limitOf(GL_MAX_TEXTURE_IMAGE_UNITS)), Targets::kFirstUnit),
           .layers = static_cast<std::size_t>(limitOf(GL_MAX_ARRAY_TEXTURE_LAYERS)),
           .bc1 = has("GL_EXT_texture_compression_s3tc")}));
  indirect_count_ = has("GL_ARB_indirect_parameters");
  measures_ = tuning.measure;
  LibraryGeometry geometry = gatherGeometry(library, plan.slots);
  ASSIGN_OR_RETURN(Programs programs,
                   makePrograms({.layer_in_vertex = has("GL_ARB_shader_viewport_layer_array"),
                                 .vertex_colors = geometry.vertex_colors,
                                 .color = options_.color != ColorFormat::kNone,
                                 .color_bytes = static_cast<unsigned>(options_.color),
                                 .depth = options_.depth,
                                 .semantics = options_.semantics,
                                 .texture_arrays = plan.arrays.size()}));
  programs_ = std::move(programs);
  textures_ = uploadTextures(plan);
  vertices_.fill(geometry.vertices.data(), geometry.vertices.size() * sizeof(GpuVertex));
  indices_.fill(geometry.indices.data(), geometry.indices.size() * sizeof(std::uint32_t));
  bounds_.fill(geometry.bounds.data(), geometry.bounds.size() * sizeof(GpuBounds));
  totals_.reserve(kTotalsBytes);
  models_ = std::move(geometry.models);
  makeVertexArray(geometry.vertex_colors);
  chooseSlices(tuning);
  if (const GLenum error = glGetError(); error != GL_NO_ERROR) {
    return fail(ErrorCode::kUnsupported, "render backend gl",
                fmt::format("the driver cannot load the library (OpenGL error 0x{:04x}{}): use a "
                            "smaller library, or the soft backend",
                            error, error == GL_OUT_OF_MEMORY ? ", out of memory" : ""));
  }
  return {};
}

void GlRenderer::makeVertexArray(bool vertex_colors) {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  vertex_array_ = VertexArray(name);
  glVertexArrayElementBuffer(name, indices_.get());
  glVertexArrayVertexBuffer(name, kPerVertex, vertices_.get(), 0, sizeof(GpuVertex));
  glVertexArrayBindingDivisor(name, kPerInstance, 1);
  for (const Attribute& attribute : kVertexAttributes) describe(name, attribute, kPerVertex);
  for (const Attribute& attribute : kInstanceAttributes) describe(name, attribute, kPerInstance);
  constexpr auto kColor = static_cast<GLuint>(offsetof(GpuVertex, color));
  glEnableVertexArrayAttrib(name, kColorLocation);
  glVertexArrayAttribBinding(name, kColorLocation, kPerVertex);
  if (vertex_colors) {
    glVertexArrayAttribFormat(name, kColorLocation, 4, GL_UNSIGNED_BYTE, GL_TRUE, kColor);
  } else {
    glVertexArrayAttribIFormat(name, kColorLocation, 1, GL_UNSIGNED_INT, kColor);
  }
}

void GlRenderer::chooseSlices(const GlTuning& tuning) {
  // Larger slices draw no faster, and smaller ones can be copied while the next one is drawn. With
  // a software driver the targets of a slice should fit into the processor's cache.
  constexpr std::size_t kGoodViews = 256;
  constexpr std::size_t kGoodSoftwareViews = 8;
  constexpr std::size_t kTargetBytes = std::size_t{1} << 30U;
  const std::size_t pixels = std::size_t{options_.width} * options_.height;
  GLint64 block = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block);
  const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const bool software = name != nullptr && isSoftwareRenderer(name);
  const std::size_t good = software ? kGoodSoftwareViews : kGoodViews;
  const std::size_t wanted = tuning.most_views > 0 ? tuning.most_views : good;
  largest_block_ = static_cast<std::size_t>(block);
  most_views_ = std::min({wanted, kTargetBytes / (pixels * kTargetBytesPerPixel),
                          largest_block_ / (pixels * sizeof(float)),
                          static_cast<std::size_t>(limitOf(GL_MAX_FRAMEBUFFER_LAYERS)),
                          static_cast<std::size_t>(limitOf(GL_MAX_ARRAY_TEXTURE_LAYERS))});
  most_views_ = std::max<std::size_t>(most_views_, 1);
}

void GlRenderer::submit(std::span<const RenderView> views, ViewSlice& slice) {
  const detail::Stopwatch watch(timings_.setup);
  slice.layout = imageLayout(options_, views.size());
  slice.stays = false;
  images_.reserve(slice.layout.bytes);
  start(views, slice);
}

Result<ImageLayout> GlRenderer::reserveDeviceImages(std::size_t views) {
  const ImageLayout layout = imageLayout(options_, views);
  const std::size_t largest =
      std::max({layout.depth, layout.semantics - layout.depth, layout.bytes - layout.semantics});
  if (largest > largest_block_) {
    return fail(ErrorCode::kUnsupported, "device images",
                fmt::format("the images of {} views take {} bytes in one block; the driver has "
                            "blocks of {}: draw fewer views at a time",
                            views, largest, largest_block_));
  }
  device_images_.reserve(layout.bytes);
  return layout;
}

void GlRenderer::submitToDevice(std::span<const RenderView> views, const ImageLayout& layout,
                                ViewSlice& slice) {
  const detail::Stopwatch watch(timings_.setup);
  slice.layout = layout;
  slice.stays = true;
  start(views, slice);
}

void GlRenderer::start(std::span<const RenderView> views, ViewSlice& slice) {
  slice.views = views.size();
  slice.counts = countSlice(views, models_);
  targets_.reserve(views.size());
  // Reserved before anything is drawn, because reserve() would take the error of an earlier call
  // for its own.
  slice.readback.reserve(readBytes(slice) + kTotalsBytes);
  if (measures_) stamp(slice.times[0]);
  upload(views, slice);
  cull(slice.counts);
  draw(slice.counts);
  if (measures_) stamp(slice.times[1]);
  resolve(slice);
  readBack(slice);
  if (measures_) stamp(slice.times[2]);
  if (const GLenum error = glGetError(); error != GL_NO_ERROR) throw notDrawn(slice, error);
  slice.fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  if (slice.fence == nullptr) throw notDrawn(slice, glGetError());
  glFlush();
}

ErrorException GlRenderer::notDrawn(const ViewSlice& slice, GLenum error) const {
  return ErrorException({ErrorCode::kUnsupported, "render device",
                         fmt::format("the driver does not draw {} images of {} x {} pixels (OpenGL "
                                     "error 0x{:04x}); draw fewer at once or smaller ones, or use "
                                     "the soft backend",
                                     slice.views, options_.width, options_.height, error)});
}

void GlRenderer::upload(std::span<const RenderView> views, ViewSlice& slice) {
  const std::size_t instances = slice.counts.instances;
  const std::size_t chunks = slice.counts.allChunks();
  const std::size_t draws = slice.counts.allDraws();
  const std::size_t instance_bytes = instances * sizeof(GpuInstance);
  const std::size_t chunk_bytes = chunks * sizeof(GpuChunk);
  slice.upload.reserve(instance_bytes + chunk_bytes);
  instances_.reserve(instance_bytes);
  chunks_.reserve(chunk_bytes);
  results_.reserve(chunks * sizeof(ChunkResult));
  draws_.reserve(draws * sizeof(DrawCommand));
  auto* first_instance = reinterpret_cast<GpuInstance*>(slice.upload.data());
  auto* first_chunk = reinterpret_cast<GpuChunk*>(slice.upload.data() + instance_bytes);
  const float aspect = static_cast<float>(options_.width) / static_cast<float>(options_.height);
  listSlice(views, models_, aspect,
            {slice.counts, {first_instance, instances}, {first_chunk, chunks}});
  copyBuffer(slice.upload, 0, instances_, 0, instance_bytes);
  copyBuffer(slice.upload, instance_bytes, chunks_, 0, chunk_bytes);
}

void GlRenderer::cull(const SliceCounts& counts) {
  const std::uint32_t chunks = counts.allChunks();
  const auto first_draw = firstOf(counts.draws);
  std::array<std::uint32_t, kDrawClasses + 1> first_chunk{};
  std::inclusive_scan(counts.chunks.begin(), counts.chunks.end(), first_chunk.begin() + 1);
  bind(kInstances, instances_);
  bind(kBounds, bounds_);
  bind(kChunks, chunks_);
  bind(kResults, results_);
  glUseProgram(programs_.test.get());
  glUniform1f(0, options_.near);
  glUniform1ui(1, chunks);
  glUniform1ui(2, options_.culling ? 1 : 0);
  dispatch(chunks);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  bind(kDraws, totals_);
  glUseProgram(programs_.scan.get());
  glUniform1uiv(0, static_cast<GLsizei>(first_chunk.size()), first_chunk.data());
  glUniform1uiv(5, static_cast<GLsizei>(first_draw.size()), first_draw.data());
  glDispatchCompute(kDrawClasses, 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  if (!indirect_count_) {
    // Commands that no shader writes stay zero and draw nothing.
    glClearNamedBufferData(draws_.get(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
  }
  bind(kDraws, draws_);
  glUseProgram(programs_.emit.get());
  glUniform1ui(0, chunks);
  dispatch(chunks);
  glMemoryBarrier(GL_COMMAND_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT |
                  GL_BUFFER_UPDATE_BARRIER_BIT);
}

void GlRenderer::draw(const SliceCounts& counts) {
  targets_.beginDrawing();
  // Row 0 is the top one, and depth is 1 at the near plane and 0 far away.
  glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  for (std::size_t i = 0; i < textures_.size(); ++i) {
    glBindTextureUnit(static_cast<GLuint>(i), textures_[i].get());
  }
  glVertexArrayVertexBuffer(vertex_array_.get(), kPerInstance, instances_.get(), 0,
                            sizeof(GpuInstance));
  glBindVertexArray(vertex_array_.get());
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, draws_.get());
  if (indirect_count_) glBindBuffer(GL_PARAMETER_BUFFER_ARB, totals_.get());
  const auto first_draw = firstOf(counts.draws);
  for (std::size_t kind = 0; kind < kDrawClasses; ++kind) {
    if (counts.draws[kind] == 0) continue;
    const auto is = [&](DrawClass other) { return kind == static_cast<std::size_t>(other); };
    const bool masked = is(DrawClass::kMaskedOneSided) || is(DrawClass::kMaskedTwoSided);
    const bool two_sided = is(DrawClass::kTwoSided) || is(DrawClass::kMaskedTwoSided);
    glUseProgram(masked ? programs_.masked.get() : programs_.opaque.get());
    glUniform1f(0, options_.near);
    two_sided ? glDisable(GL_CULL_FACE) : glEnable(GL_CULL_FACE);
    const auto most = static_cast<GLsizei>(counts.draws[kind]);
    const std::uintptr_t offset = first_draw[kind] * sizeof(DrawCommand);
    const auto* indirect = std::bit_cast<const void*>(offset);
    if (indirect_count_) {
      glMultiDrawElementsIndirectCountARB(GL_TRIANGLES, GL_UNSIGNED_INT, indirect,
                                          static_cast<GLintptr>(kind * sizeof(DrawTotals)), most,
                                          sizeof(DrawCommand));
    } else {
      glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, indirect, most,
                                  sizeof(DrawCommand));
    }
  }
}

void GlRenderer::resolve(const ViewSlice& slice) {
  const Buffer& images = slice.stays ? device_images_ : images_;
  const ImageLayout& layout = slice.layout;
  const std::size_t pixels = slice.views * options_.width * options_.height;
  const auto bind_part = [&](GLuint binding, std::size_t begin, std::size_t end) {
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, binding, images.get(), static_cast<GLintptr>(begin),
                      static_cast<GLsizeiptr>(end - begin));
  };
  bind_part(0, layout.color, layout.depth);
  bind_part(1, layout.depth, layout.semantics);
  bind_part(2, layout.semantics, layout.bytes);
  // OpenGL requires no barrier here, but without one Mesa's software driver lets the compute shader
  // read before drawing is finished.
  glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
  targets_.bindForReading();
  glUseProgram(programs_.resolve.get());
  glUniform1f(0, options_.near);
  glUniform1ui(1, options_.width);
  glUniform1ui(2, options_.height);
  glUniform1ui(3, static_cast<GLuint>(pixels));
  const std::size_t first_view = slice.stays ? slice.first_view : 0;
  glUniform1ui(4, static_cast<GLuint>(first_view * options_.width * options_.height));
  dispatch((pixels + 3) / 4);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
}

void GlRenderer::readBack(const ViewSlice& slice) const {
  const std::size_t bytes = readBytes(slice);
  copyBuffer(images_, 0, slice.readback, 0, bytes);
  copyBuffer(totals_, 0, slice.readback, bytes, kTotalsBytes);
}

void GlRenderer::finish(ViewSlice& slice) {
  constexpr GLuint64 kNanoseconds = 1'000'000'000;
  GLenum waited = GL_TIMEOUT_EXPIRED;
  while (waited == GL_TIMEOUT_EXPIRED) {
    waited = glClientWaitSync(slice.fence, GL_SYNC_FLUSH_COMMANDS_BIT, kNanoseconds);
  }
  glDeleteSync(slice.fence);
  slice.fence = nullptr;
  if (waited == GL_WAIT_FAILED) throw notDrawn(slice, glGetError());
  std::array<DrawTotals, kDrawClasses> totals{};
  std::memcpy(totals.data(), slice.readback.data() + readBytes(slice), kTotalsBytes);
  statistics_.instances += slice.counts.instances;
  statistics_.clusters += slice.counts.clusters;
  for (const DrawTotals& total : totals) {
    statistics_.clusters_drawn += total.clusters;
    statistics_.triangles_drawn += total.triangles;
  }
  if (measures_) {
    timings_.draw += secondsBetween(slice.times[0], slice.times[1]);
    timings_.readback += secondsBetween(slice.times[1], slice.times[2]);
  }
}

void GlRenderer::collect(ViewSlice& slice, const RenderTargets& targets) {
  finish(slice);
  const detail::Stopwatch watch(timings_.copy);
  const ImageLayout& layout = slice.layout;
  const auto copy_to = [&](auto* target, std::size_t begin, std::size_t bytes_of_view) {
    if (bytes_of_view == 0) return;
    std::memcpy(reinterpret_cast<std::byte*>(target) + slice.first_view * bytes_of_view,
                slice.readback.data() + begin, slice.views * bytes_of_view);
  };
  copy_to(targets.color.data(), layout.color, layout.color_of_view);
  copy_to(targets.depth.data(), layout.depth, layout.depth_of_view);
  copy_to(targets.semantics.data(), layout.semantics, layout.semantics_of_view);
}

}  // namespace galactic::render::gl
