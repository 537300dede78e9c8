#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <utility>

#include "import/checks/content_check.h"
#include "import/gltf_json.h"

namespace galactic::bake {
namespace {

using Json = nlohmann::json;

// Extensions that a reader may require only in order to draw surfaces as intended.
constexpr std::array<std::string_view, 5> kHarmlessPrefixes{
    "KHR_materials_", "KHR_texture_transform", "KHR_lights_", "KHR_xmp", "KHR_animation_"};

/// An extension for images in a format other than PNG and JPEG.
struct ImageExtension {
  std::string_view name;
  std::string_view format;
};
constexpr std::array kImageExtensions{ImageExtension{"KHR_texture_basisu", "KTX2"},
                                      ImageExtension{"EXT_texture_webp", "WebP"},
                                      ImageExtension{"MSFT_texture_dds", "DDS"}};

/// Readers, and writers of JSON, descend into nested values by recursion. No tool writes a glTF
/// file with even a hundred levels.
constexpr std::size_t kDeepest = 1000;

/// Readers are fine with this one, because readableGltf undoes it.
constexpr std::string_view kQuantization = "KHR_mesh_quantization";

/// A reader that ignores this one draws too few objects, and not just different ones.
constexpr std::string_view kInstancing = "EXT_mesh_gpu_instancing";

/// The image extension of this name; null for any other extension.
const ImageExtension* imageExtension(std::string_view name) {
  const auto* image = std::ranges::find(kImageExtensions, name, &ImageExtension::name);
  return image == kImageExtensions.end() ? nullptr : image;
}

bool isHarmless(std::string_view extension) {
  if (extension == kQuantization) return true;
  return std::any_of(kHarmlessPrefixes.begin(), kHarmlessPrefixes.end(),
                     [&](std::string_view prefix) { return extension.starts_with(prefix); });
}

/// Streams through the JSON and keeps only what matters; a document tree of a file with embedded
/// buffers would take several times the file's size.
class RequiredExtensions final : public Json::json_sax_t {
 public:
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t value) override { return weight(value != 0); }
  bool number_unsigned(number_unsigned_t value) override { return weight(value != 0); }
  bool number_float(number_float_t value, const string_t&) override { return weight(value != 0); }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return enter(); }
  bool end_object() override { return leave(); }
  bool start_array(std::size_t) override { return enter(); }
  bool end_array() override { return leave(); }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
    return false;
  }

  bool key(string_t& name) override {
    if (depth_ == kNodeDepth) in_weights_ = in_nodes_ && name == "weights";
    if (in_textures_) noteTextureKey(name);
    if (depth_ != 1) return true;
    in_nodes_ = name == "nodes";
    in_textures_ = name == "textures";
    in_required_ = name == "extensionsRequired";
    in_used_ = name == "extensionsUsed";
    if (name == "skins") {
      found_.warnings.emplace_back(
          "skeletons are not read: meshes with one stand where their nodes are, which may be "
          "elsewhere; export them in their pose");
    }
    return true;
  }

  bool string(string_t& value) override {
    if (depth_ == 2 && in_used_ && value == kInstancing) {
      found_.warnings.push_back(
          fmt::format("instances of {} are not read: such a mesh stands once; export each as a "
                      "node of its own",
                      kInstancing));
    }
    if (depth_ != 2 || !in_required_ || isHarmless(value)) return true;
    const ImageExtension* image = imageExtension(value);
    if (image == nullptr) {
      found_.unsupported = value;
      return false;
    }
    tellOf(*image);
    return true;
  }

  [[nodiscard]] GltfRequirements take() { return std::move(found_); }

 private:
  /// The relevant members of a texture and its extensions.
  struct Texture {
    bool has_source = false;
    bool in_extensions = false;
    const ImageExtension* other = nullptr;
  };

  bool enter() {
    ++depth_;
    found_.is_too_deep = depth_ > kDeepest;
    if (found_.is_too_deep) return false;
    if (in_textures_ && depth_ == kNodeDepth) texture_ = {};
    return true;
  }
  bool leave() {
    const bool ends_texture = in_textures_ && depth_ == kNodeDepth;
    if (ends_texture && !texture_.has_source && texture_.other != nullptr) tellOf(*texture_.other);
    --depth_;
    return true;
  }
  void noteTextureKey(const string_t& name) {
    if (depth_ == kNodeDepth) {
      texture_.has_source = texture_.has_source || name == "source";
      texture_.in_extensions = name == "extensions";
    } else if (depth_ == kNodeDepth + 1 && texture_.in_extensions) {
      if (const ImageExtension* image = imageExtension(name)) texture_.other = image;
    }
  }
  /// Warns, once for each extension, of images that the file requires, or that a texture has no
  /// alternative to.
  void tellOf(const ImageExtension& image) {
    if (!told_.insert(image.name).second) return;
    found_.warnings.push_back(
        fmt::format("textures in {} ({}) cannot be read: their surfaces keep their plain color; "
                    "export them as PNG or JPEG",
                    image.format, image.name));
  }
  /// Weights of a mesh are applied; those of a node would give the mesh another shape at that node.
  bool weight(bool counts) {
    if (!counts || !in_weights_ || depth_ != kNodeDepth + 1) return true;
    in_weights_ = false;
    if (std::exchange(has_node_weights_, true)) return true;
    found_.warnings.emplace_back(
        "weights of morph targets that nodes state are not read: their meshes have the shape of "
        "their own weights; export them in the shape that is meant");
    return true;
  }

  /// Depth inside an element of a list (of nodes or of textures) of the document.
  static constexpr std::size_t kNodeDepth = 3;

  std::size_t depth_ = 0;
  bool in_required_ = false;
  bool in_used_ = false;
  bool in_nodes_ = false;
  bool in_weights_ = false;
  bool in_textures_ = false;
  Texture texture_;
  std::set<std::string_view> told_;
  bool has_node_weights_ = false;
  GltfRequirements found_;
};

}  // namespace

GltfRequirements gltfRequirements(std::span<const std::byte> file) {
  const std::span<const std::byte> json = gltfJson(file);
  const auto* text = reinterpret_cast<const char*>(json.data());
  RequiredExtensions found;
  // The result only tells whether the parse was stopped; broken JSON is the mesh reader's to
  // report.
  static_cast<void>(Json::sax_parse(text, text + json.size(), &found));
  return found.take();
}

}  // namespace galactic::bake
