#include <fmt/format.h>

#include <algorithm>

#include "option_groups.h"
#include "option_values.h"

namespace galactic::bake {
namespace {

/// 12 numbers (three rows) or 16 (four rows, the last one 0,0,0,1).
Result<Affine> parseTransform(const std::string& text) {
  auto numbers = parseNumbers(text, "--transform");
  if (!numbers) return tl::unexpected(numbers.error());
  const bool has_last_row = numbers->size() == 16 && (*numbers)[12] == 0 && (*numbers)[13] == 0 &&
                            (*numbers)[14] == 0 && (*numbers)[15] == 1;
  if (numbers->size() != 12 && !has_last_row) {
    return fail(ErrorCode::kInvalidInput, "--transform",
                fmt::format("has {} numbers, 12 (three rows of four) are wanted, or 16 whose last "
                            "row is 0,0,0,1",
                            numbers->size()));
  }
  Affine transform{};
  std::copy_n(numbers->begin(), transform.size(), transform.begin());
  return transform;
}

}  // namespace

void ImportOptions::addTo(CLI::App& app) {
  app.add_option("--up", up_, "Up axis of the input: x, y, z, -x, -y, -z (default: the file's)")
      ->type_name("AXIS");
  app.add_option("--scale", scale_, "Metres per unit of the input (default: the file's)")
      ->type_name("METRES");
  app.add_option("--transform", transform_,
                 "Applied last, Y up and metres: 12 or 16 numbers, row by row")
      ->type_name("N,N,...");
}

Result<void> ImportOptions::understand(BakeCommand& command) const {
  if (!up_.empty()) {
    const auto up = parseUp(up_, "--up");
    if (!up) return tl::unexpected(up.error());
    command.import.up = *up;
  }
  if (!scale_.empty()) {
    const auto scale = parseExactly(scale_, "--scale", 1);
    if (!scale) return tl::unexpected(scale.error());
    if (!((*scale)[0] > 0)) {
      return fail(ErrorCode::kInvalidInput, "--scale",
                  fmt::format("is {}, metres per unit have to be positive", scale_));
    }
    command.import.scale = (*scale)[0];
  }
  if (!transform_.empty()) {
    const auto transform = parseTransform(transform_);
    if (!transform) return tl::unexpected(transform.error());
    command.import.transform = *transform;
  }
  return {};
}

void ImportOptions::remember(BakeCommand& command) const {
  command.remember("up", up_);
  command.remember("scale", scale_);
  command.remember("transform", transform_);
}

}  // namespace galactic::bake
