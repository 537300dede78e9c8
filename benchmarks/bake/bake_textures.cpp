// What the texture bake makes of mesh files: bytes for each largest size and format, with times.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <string>
#include <vector>

#include "galactic/bake/mesh_import.h"
#include "galactic/bake/render_textures.h"

namespace {

namespace bake = galactic::bake;

struct Input {
  std::filesystem::path path;
  bake::SourceAsset asset;
};

class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::vector<Input> importAll(const std::vector<std::string>& files) {
  std::vector<Input> inputs;
  bake::MeshImportOptions options;
  options.smallest_size = 0;
  for (const std::string& file : files) {
    auto asset = bake::importMesh(file, options);
    if (asset) {
      inputs.push_back({file, std::move(*asset)});
    } else {
      fmt::print("{}: {}\n", asset.error().where, asset.error().message);
    }
  }
  return inputs;
}

void bakeAll(const std::vector<Input>& inputs, const bake::TextureBakeOptions& options,
             unsigned threads, bool print_warnings) {
  std::uint64_t source_bytes = 0;
  std::uint64_t bytes = 0;
  std::size_t textures = 0;
  const Stopwatch watch;
  for (const Input& input : inputs) {
    const auto baked = bake::bakeMaterials(
        input.asset.materials, {input.asset.textures, input.path.parent_path()}, options, threads);
    if (!baked) {
      fmt::print("{}: {}\n", baked.error().where, baked.error().message);
      continue;
    }
    source_bytes += baked->source_bytes;
    bytes += baked->texels.size();
    textures += baked->textures.size();
    if (!print_warnings) continue;
    for (const std::string& warning : baked->warnings) {
      fmt::print("{}: {}\n", input.path.filename().string(), warning);
    }
  }
  fmt::print("{:>8} {:>6} {:>9} {:>11.1f} {:>10.2f} {:>8.2f}\n", options.largest,
             options.format == galactic::TexelFormat::kBc1 ? "bc1" : "rgba8", textures,
             static_cast<double>(source_bytes) / 1e6, static_cast<double>(bytes) / 1e6,
             watch.seconds());
}

}  // namespace

int main(int count, char** arguments) {
  CLI::App app("What the texture bake makes of mesh files");
  std::vector<std::string> files;
  unsigned threads = 1;
  app.add_option("FILE", files, "Mesh files")->required();
  app.add_option("--threads", threads, "Threads")->capture_default_str();
  CLI11_PARSE(app, count, arguments);
  const std::vector<Input> inputs = importAll(files);
  fmt::print("{:>8} {:>6} {:>9} {:>11} {:>10} {:>8}\n", "largest", "format", "textures",
             "source MB", "texels MB", "seconds");
  for (const auto format : {galactic::TexelFormat::kRgba8, galactic::TexelFormat::kBc1}) {
    for (const std::uint32_t largest : {256U, 512U, 1024U}) {
      bakeAll(inputs, {.largest = largest, .format = format}, threads,
              largest == 256 && format == galactic::TexelFormat::kRgba8);
    }
  }
  return 0;
}
