#include "pack_tool/option_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

namespace galactic::pack_tool {

void parseNumbers(const std::string& option, const std::string& text, std::span<double> numbers) {
  const char* from = text.data();
  const char* const end = from + text.size();
  bool good = true;
  for (std::size_t n = 0; n < numbers.size() && good; ++n) {
    if (n > 0) good = from != end && *from++ == ',';
    const auto parsed = std::from_chars(from, end, numbers[n]);
    good = good && parsed.ec == std::errc() && std::isfinite(numbers[n]);
    from = parsed.ptr;
  }
  if (!good || from != end) {
    throw CLI::ValidationError(
        option, fmt::format("\"{}\" is not {} numbers separated by commas", text, numbers.size()));
  }
}

std::vector<JointValue> parseJoints(const std::string& text) {
  std::vector<JointValue> joints;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    const std::string entry = text.substr(from, comma - from);
    const std::size_t equals = entry.rfind('=');
    JointValue joint{entry.substr(0, equals), 0};
    const char* const end = entry.data() + entry.size();
    const char* const number = equals == std::string::npos ? end : entry.data() + equals + 1;
    const auto parsed = std::from_chars(number, end, joint.value);
    if (joint.name.empty() || parsed.ec != std::errc() || parsed.ptr != end ||
        !std::isfinite(joint.value)) {
      throw CLI::ValidationError(
          "--joints", fmt::format("\"{}\" is not joint=value, for example elbow=1.57", entry));
    }
    joints.push_back(std::move(joint));
    from = comma + 1;
  }
  return joints;
}

LayerSet parseLayers(const std::string& text) {
  const std::map<std::string, FigureLayer> names{{"mesh", FigureLayer::kMesh},
                                                 {"spheres", FigureLayer::kSpheres},
                                                 {"boxes", FigureLayer::kBoxes}};
  LayerSet layers = LayerSet::none();
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    const std::string name = text.substr(from, comma - from);
    const auto found = names.find(name);
    if (found == names.end()) {
      throw CLI::ValidationError("--what",
                                 fmt::format("\"{}\" is not mesh, spheres or boxes", name));
    }
    layers.add(found->second);
    from = comma + 1;
  }
  return layers;
}

}  // namespace galactic::pack_tool
